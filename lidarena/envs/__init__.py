"""The environment families as Gymnasium environments, and their registry."""

from lidarena.envs.arena.env import ArenaEnv, BatchedArena
from lidarena.envs.corridor.central_env import BatchedCorridor, CorridorCentralEnv
from lidarena.envs.exploration.env import BatchedExploration, ExplorationEnv
from lidarena.envs.registration import register_all
from lidarena.envs.worker_threads import set_num_threads

__all__ = [
    "ArenaEnv",
    "BatchedArena",
    "BatchedCorridor",
    "BatchedExploration",
    "CorridorCentralEnv",
    "ExplorationEnv",
    "register_all",
    "set_num_threads",
]
