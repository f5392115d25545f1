"""Registration of every environment id with Gymnasium."""

from typing import Any

import gymnasium as gym

from lidarena.envs.exploration import ExplorationEnv

EPISODE_STEPS = 1000
"""The paper's training cap."""
EXPLORATION_MAPS = {f"lidarena/Env{k}-v0": f"env{k}" for k in (1, 2, 3, 4)} | {
    "lidarena/Exploration-v0": "willow_lobby"
}


def make_single(max_episode_steps: int | None = None, **keywords: Any) -> ExplorationEnv:
    """Entry point of ``gym.make``, whose own ``TimeLimit`` truncates: its ``max_episode_steps`` never gets here."""
    return ExplorationEnv(max_episode_steps=max_episode_steps, **keywords)


def register_all() -> None:
    """Register the ids; doing so again changes nothing."""
    for name, plan in EXPLORATION_MAPS.items():
        if name not in gym.registry:
            gym.register(
                id=name,
                entry_point="lidarena.envs.registration:make_single",
                vector_entry_point="lidarena.envs.exploration:BatchedExploration",
                max_episode_steps=EPISODE_STEPS,
                kwargs={"map": plan},
            )
