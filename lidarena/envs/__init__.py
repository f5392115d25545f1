"""The environment families as Gymnasium environments, and their registry."""

from lidarena.envs.arena import ArenaEnv, BatchedArena
from lidarena.envs.corridor_central import BatchedCorridor, CorridorCentralEnv
from lidarena.envs.exploration import BatchedExploration, ExplorationEnv
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
