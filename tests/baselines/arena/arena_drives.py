"""Arenas, and episodes in them with a policy."""

from typing import Any

import gymnasium as gym
import numpy as np

import lidarena
from lidarena.baselines.arena.robot_interface import KnownWorld
from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.planning.potential_field.regression_search import path_length
from lidarena.world.arenas import Arena

KNOWN = ("astar", "apf", "apf_improved", "apf_global")


LIDAR = ("apf_lidar", "apf_improved_lidar")


EMPTY = Arena("empty", np.empty((0, 3)), (10.0, 50.0), (90.0, 50.0), (0.0, 0.0, 100.0, 100.0), 1.0)


RING = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)


WALLED_IN = np.column_stack([70 + 8 * np.cos(RING), 50 + 8 * np.sin(RING), np.full(60, 0.8)])


NO_WAY = Arena("no way", WALLED_IN, (10.0, 50.0), (70.0, 50.0), (0.0, 0.0, 100.0, 100.0), 1.0)


def drive(
    policy: str, seed: int = 0, options: dict[str, Any] | None = None, **keywords: Any
) -> tuple[str, dict[str, Any]]:
    """Run an episode; how it ended, and the last info with the least clearance."""
    env = gym.make("lidarena/Arena-v0", expose_truth=True, disable_env_checker=True, **keywords)
    driver = lidarena.baselines.make(policy, env, **(options or {}))
    observation, info = env.reset(seed=seed)
    driver.reset(seed=0)
    least, decisions = info["clearance"], 0
    while True:
        action = driver.act(observation, info)
        decisions += 1
        if getattr(driver, "finished", False):
            return "finished", info | {"least": least, "decisions": decisions}
        assert env.action_space.contains(action)
        observation, _, terminated, truncated, info = env.step(action)
        least = min(least, info["clearance"])
        if terminated or truncated:
            end = "success" if info["success"] else "collision" if info["collision"] else "out of time"
            return end, info | {"least": least, "decisions": decisions}


def over_astar(info: dict[str, Any], start: tuple[float, float]) -> float:
    truth = info["truth"]
    path = astar_path(truth["circles"], start, info["goal"], info["radius"], truth["bounds"])
    return float((info["path_length"] + info["distance"]) / path_length(path))


def planner(name: str, **options: Any) -> Any:
    """A policy that plans, to look at its plans."""
    return lidarena.baselines.make(name, gym.make("lidarena/Arena-v0", arena="yang"), **options)


def world(circles: list[tuple[float, float, float]], radius: float = 1.0) -> KnownWorld:
    """A room of 100 m to be crossed from the left to the right."""
    bounds, pose = np.array([0.0, 0.0, 100.0, 100.0]), np.array([10.0, 50.0, 0.0])
    return KnownWorld(np.array(circles).reshape(-1, 3), bounds, pose, np.array([90.0, 50.0]), radius)
