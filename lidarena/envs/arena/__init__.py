"""Goal reaching among obstacles: the arena family."""

from typing import Any

from lidarena.envs.arena.env import ArenaEnv, BatchedArena
from lidarena.envs.registration import Family, Registration

__all__ = ["FAMILY", "ArenaEnv", "BatchedArena"]

EPISODE_STEPS = 500
"""Five times what it takes to cross an arena."""


def make_single(**keywords: Any) -> ArenaEnv:
    """Entry point of ``gym.make``, whose own ``TimeLimit`` truncates: its ``max_episode_steps`` never gets here."""
    return ArenaEnv(**{"max_episode_steps": -1, **keywords})


FAMILY = Family(
    "arena",
    ids={
        "lidarena/Arena-v0": Registration(
            "lidarena.envs.arena:make_single", "lidarena.envs.arena.env:BatchedArena", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.arena:MEASURES",
    baselines="lidarena.baselines.arena",
)
