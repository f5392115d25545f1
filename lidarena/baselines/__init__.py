"""The classical methods as policies on the same interface as the learned agents."""

from lidarena.baselines import random as _random  # registers itself
from lidarena.baselines.policy import Policy
from lidarena.baselines.registry import make, names, register

__all__ = ["Policy", "make", "names", "register"]

del _random
