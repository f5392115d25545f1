"""Schedulers as policies of the workshop family."""

from lidarena.baselines.workshop import chaski, greedy, stnu, tercio, turn_taking  # they register themselves

__all__ = ["chaski", "greedy", "stnu", "tercio", "turn_taking"]
