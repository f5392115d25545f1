"""Planning on arrays: grid search, inflation, frontiers, steering, path following, and paths for whole teams."""

from lidarena.planning.team.plan import plan_team
from lidarena.planning.team.team_plan import TeamPlan
from lidarena.planning.team.validation import validate_plan

__all__ = ["TeamPlan", "plan_team", "validate_plan"]
