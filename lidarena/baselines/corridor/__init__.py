"""Planners of teams as policies of the corridor family."""

from lidarena.baselines.corridor import lifelong, team_planners, team_search  # they register themselves

__all__ = ["lifelong", "team_planners", "team_search"]
