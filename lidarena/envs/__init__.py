"""The environment families as Gymnasium environments, and their registry."""

from lidarena.envs.arena import ArenaEnv, BatchedArena
from lidarena.envs.corridor import BatchedCorridor, CorridorCentralEnv
from lidarena.envs.exploration import BatchedExploration, ExplorationEnv
from lidarena.envs.registration import Family, Registration, register_all, register_family
from lidarena.envs.seabed import BatchedSeabed, SeabedEnv
from lidarena.envs.worker_threads import set_num_threads
from lidarena.envs.workshop import BatchedWorkshop, WorkshopEnv

__all__ = [
    "ArenaEnv",
    "BatchedArena",
    "BatchedCorridor",
    "BatchedExploration",
    "BatchedSeabed",
    "BatchedWorkshop",
    "CorridorCentralEnv",
    "ExplorationEnv",
    "Family",
    "Registration",
    "SeabedEnv",
    "WorkshopEnv",
    "register_all",
    "register_family",
    "set_num_threads",
]
