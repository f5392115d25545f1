"""The environment families as Gymnasium environments, and their registry.

A family is imported when one of its environments is made or one of its names is used for the first time.
"""

from typing import TYPE_CHECKING

from lidarena.base.lazy_names import lazy_names
from lidarena.envs.registration import Family, Registration, register_all, register_family

if TYPE_CHECKING:
    from lidarena.envs.arena import ArenaEnv, BatchedArena
    from lidarena.envs.corridor import BatchedCorridor, CorridorCentralEnv
    from lidarena.envs.exploration import BatchedExploration, ExplorationEnv
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

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "ArenaEnv": "lidarena.envs.arena.env",
        "BatchedArena": "lidarena.envs.arena.env",
        "BatchedCorridor": "lidarena.envs.corridor.central_env",
        "BatchedExploration": "lidarena.envs.exploration.env",
        "BatchedSeabed": "lidarena.envs.seabed.env",
        "BatchedWorkshop": "lidarena.envs.workshop.env",
        "CorridorCentralEnv": "lidarena.envs.corridor.central_env",
        "ExplorationEnv": "lidarena.envs.exploration.env",
        "SeabedEnv": "lidarena.envs.seabed.env",
        "WorkshopEnv": "lidarena.envs.workshop.env",
        "set_num_threads": "lidarena.envs.worker_threads",
    },
)
