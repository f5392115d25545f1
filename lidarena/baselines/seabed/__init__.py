"""The steps of Bobkov et al. as policies of the seabed family."""

from lidarena.baselines.seabed import adaptive_step, fixed_step  # they register themselves

__all__ = ["adaptive_step", "fixed_step"]
