"""The classical methods as policies on the same interface as the learned agents."""

from lidarena.baselines import random as _random  # registers itself
from lidarena.baselines.arena import apf as _apf  # registers itself
from lidarena.baselines.arena import apf_global as _apf_global  # registers itself
from lidarena.baselines.arena import apf_improved as _apf_improved  # registers itself
from lidarena.baselines.arena import apf_improved_lidar as _apf_improved_lidar  # registers itself
from lidarena.baselines.arena import apf_lidar as _apf_lidar  # registers itself
from lidarena.baselines.arena import astar as _astar  # registers itself
from lidarena.baselines.corridor import team_planners as _team_planners  # register themselves
from lidarena.baselines.corridor import team_search as _team_search  # registers itself
from lidarena.baselines.exploration import ealc as _ealc  # registers itself
from lidarena.baselines.exploration import frontier as _frontier  # registers itself
from lidarena.baselines.policy import Policy
from lidarena.baselines.registry import make, names, register

__all__ = ["Policy", "make", "names", "register"]

del _apf, _apf_global, _apf_improved, _apf_improved_lidar, _apf_lidar, _astar, _ealc, _frontier, _random
del _team_planners, _team_search
