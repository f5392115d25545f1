"""Goal reaching among obstacles: the arena family."""

from typing import TYPE_CHECKING

from lidarena.base.lazy_names import lazy_names
from lidarena.envs.registration import Family, Registration

if TYPE_CHECKING:
    from lidarena.envs.arena.env import ArenaEnv, BatchedArena

__all__ = ["FAMILY", "ArenaEnv", "BatchedArena"]

EPISODE_STEPS = 500
"""Five times what it takes to cross an arena."""

FAMILY = Family(
    "arena",
    ids={
        "lidarena/Arena-v0": Registration(
            "lidarena.envs.arena.env:make_single", "lidarena.envs.arena.env:BatchedArena", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.arena:MEASURES",
    baselines="lidarena.baselines.arena",
    agent_options=("observation", "action", "guard", "lidar.beams", "lidar.field_of_view"),
    keywords_of_0_1="lidarena.envs.arena.options:modern_keywords",
)

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "ArenaEnv": "lidarena.envs.arena.env",
        "BatchedArena": "lidarena.envs.arena.env",
    },
)
