"""A single team that meets another plan after every reset with a seed."""

from typing import Any

import gymnasium as gym
import numpy as np

import lidarena  # noqa: F401


def test_one_controller_meets_a_plan_for_every_seed() -> None:
    env = gym.make("lidarena/CorridorCentral-v0", robots=2, plans="random:rooms", places="random")
    _, info = env.reset(seed=4)
    _, other = env.reset(seed=5)
    assert info["map"].shape != other["map"].shape or (info["map"] != other["map"]).any()
    observation, again = env.reset(seed=4)
    assert np.array_equal(info["map"], again["map"])
    world: Any = env.unwrapped
    saved = world.episodes.arrays()
    env.reset(seed=5)
    world.episodes.load_arrays(saved)
    assert np.array_equal(world.episodes.observe()[0], observation)
    assert np.array_equal(world.floorplan.bounds, world.episodes.teams.core.plan.bounds)
