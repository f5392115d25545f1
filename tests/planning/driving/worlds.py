"""Exploration worlds in whose middle of an episode the compiled drivers are looked at."""

from typing import Any

import gymnasium as gym
import numpy as np

from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.envs.exploration.goal_choice.explorers import driver_settings, explorer_settings
from lidarena.envs.exploration.goal_choice.options import GoalChoiceOptions
from lidarena.planning.driving.explorer import Explorers, ExplorerSettings, begin, empty_explorers
from lidarena.planning.driving.state import DriverSettings, Perceptions

MAZE = "maze:3?width=6&height=5.5"


def make_world(seed: int = 1, **keywords: Any) -> tuple[gym.Env[Any, Any], dict[str, Any]]:
    """An environment with a known pose after its reset, and what it told."""
    given = {"map": MAZE, "slam": "truth", "start": "random", "stop_at": None, "max_episode_steps": 5000}
    env = gym.make("lidarena/Exploration-v0", **given | keywords)
    return env, env.reset(seed=seed)[1]


def perceived(info: dict[str, Any]) -> Perceptions:
    """What a driver is told of a single world."""
    pose, scan = np.array(info["pose"], np.float64), np.array(info["scan"], np.float32)
    return Perceptions(np.array(info["map"])[None], np.array(info["origin"])[None], pose[None], scan[None])


def hired(
    env: gym.Env[Any, Any], info: dict[str, Any], places: int = 0, most: int = 24
) -> tuple[DriverSettings, ExplorerSettings, Explorers]:
    """An explorer of a single world, at the beginning."""
    robot = Robot(env)
    driver = driver_settings(robot.options, robot.commands, float(info["resolution"]))
    explorers = empty_explorers(1, *info["map"].shape, most, driver)
    begin(explorers, 0)
    return driver, explorer_settings(robot.period, GoalChoiceOptions.choice_period, 0.2, places), explorers
