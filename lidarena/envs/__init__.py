"""The environment families as Gymnasium environments, and their registry."""

from lidarena.envs.exploration import BatchedExploration, ExplorationEnv
from lidarena.envs.registration import register_all

__all__ = ["BatchedExploration", "ExplorationEnv", "register_all"]
