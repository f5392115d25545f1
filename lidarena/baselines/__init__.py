"""The classical methods as policies on the same interface as the learned agents."""

from lidarena.baselines import ealc as _ealc  # registers itself
from lidarena.baselines import frontier as _frontier  # registers itself
from lidarena.baselines import random as _random  # registers itself
from lidarena.baselines import team_planners as _team_planners  # register themselves
from lidarena.baselines import team_search as _team_search  # registers itself
from lidarena.baselines.policy import Policy
from lidarena.baselines.registry import make, names, register

__all__ = ["Policy", "make", "names", "register"]

del _ealc, _frontier, _random, _team_planners, _team_search
