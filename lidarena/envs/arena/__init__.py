"""Goal reaching among obstacles: the arena family."""

from lidarena.envs.arena.env import ArenaEnv, BatchedArena
from lidarena.envs.base_env import entry_point
from lidarena.envs.registration import Family, Registration

__all__ = ["FAMILY", "ArenaEnv", "BatchedArena"]

EPISODE_STEPS = 500
"""Five times what it takes to cross an arena."""


make_single = entry_point(ArenaEnv)

FAMILY = Family(
    "arena",
    ids={
        "lidarena/Arena-v0": Registration(
            "lidarena.envs.arena:make_single", "lidarena.envs.arena.env:BatchedArena", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.arena:MEASURES",
    baselines="lidarena.baselines.arena",
    agent_options=("observation", "action", "lidar.beams", "lidar.field_of_view"),
    keywords_of_0_1="lidarena.envs.arena.options:modern_keywords",
)
