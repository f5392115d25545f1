"""Planners of teams as policies of the corridor family."""

from lidarena.baselines.corridor import team_planners, team_search  # they register themselves

__all__ = ["team_planners", "team_search"]
