"""Frontier exploration and its relatives as policies of the exploration family."""

from lidarena.baselines.exploration import ealc, frontier, rules  # they register themselves

__all__ = ["ealc", "frontier", "rules"]
