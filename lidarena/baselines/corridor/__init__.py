"""Planners of teams as policies of the corridor family."""
