"""Registration of every environment id with Gymnasium."""

from typing import Any

import gymnasium as gym

from lidarena.envs.arena.env import ArenaEnv
from lidarena.envs.corridor.central_env import CorridorCentralEnv
from lidarena.envs.corridor.shared_env import register_shared
from lidarena.envs.exploration.env import ExplorationEnv

EPISODE_STEPS = 1000
"""Yang et al.'s training cap."""
ARENA_STEPS = 500
"""Five times what it takes to cross an arena."""
CENTRAL_ID = "lidarena/CorridorCentral-v0"
EXPLORATION_MAPS = {f"lidarena/Env{k}-v0": f"env{k}" for k in (1, 2, 3, 4)} | {
    "lidarena/Exploration-v0": "willow_lobby"
}


def make_single(max_episode_steps: int | None = None, **keywords: Any) -> ExplorationEnv:
    """Entry point of ``gym.make``, whose own ``TimeLimit`` truncates: its ``max_episode_steps`` never gets here."""
    return ExplorationEnv(max_episode_steps=max_episode_steps, **keywords)


def make_single_arena(max_episode_steps: int | None = None, **keywords: Any) -> ArenaEnv:
    """Entry point of ``gym.make``, likewise."""
    return ArenaEnv(max_episode_steps=max_episode_steps, **keywords)


def make_central(max_episode_steps: int | None = None, **keywords: Any) -> CorridorCentralEnv:
    """Entry point of ``gym.make`` for a team, as ``make_single`` for one robot."""
    return CorridorCentralEnv(max_episode_steps=max_episode_steps, **keywords)


def register_all() -> None:
    """Register the ids; doing so again changes nothing."""
    _register_corridor()
    for name, plan in EXPLORATION_MAPS.items():
        if name not in gym.registry:
            gym.register(
                id=name,
                entry_point="lidarena.envs.registration:make_single",
                vector_entry_point="lidarena.envs.exploration.env:BatchedExploration",
                max_episode_steps=EPISODE_STEPS,
                kwargs={"map": plan},
            )
    if "lidarena/Arena-v0" not in gym.registry:
        gym.register(
            id="lidarena/Arena-v0",
            entry_point="lidarena.envs.registration:make_single_arena",
            vector_entry_point="lidarena.envs.arena.env:BatchedArena",
            max_episode_steps=ARENA_STEPS,
        )


def _register_corridor() -> None:
    register_shared()
    if CENTRAL_ID not in gym.registry:
        gym.register(
            id=CENTRAL_ID,
            entry_point="lidarena.envs.registration:make_central",
            vector_entry_point="lidarena.envs.corridor.central_env:BatchedCorridor",
            max_episode_steps=EPISODE_STEPS,
        )
