"""Frontier exploration with other robots and lidars than DA-SLAM's: it reads them from the environment."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.baselines.exploration.frontier import FrontierPolicy
from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.envs import ExplorationEnv

AHEAD = {"beams": 180, "field_of_view": math.radians(270.0)}
DRIVES: list[dict[str, Any]] = [
    {"lidar": {"beams": 180}, "observation": "sectors"},
    {"lidar": AHEAD, "observation": "sectors", "robot": "turtlebot3_waffle"},
    {"lidar": "hokuyo_ust_10lx", "observation": "map", "robot": "jackal", "action": "continuous"},
    {"robot": {"collision_distance": 0.2}},
    {"lidar": {"rate": 1.0, "min_range": 0.1}},
]


@pytest.mark.parametrize("keywords", DRIVES)
def test_it_explores_env_2_without_a_collision(keywords: dict[str, Any]) -> None:
    env = gym.make("lidarena/Env2-v0", max_episode_steps=1500, **keywords)
    policy = lidarena.baselines.make("frontier", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    over = False
    while not (over or policy.finished):
        observation, _, ended, cut_off, info = env.step(policy.act(observation, info))
        over = ended or cut_off
    assert not info["collision"] and info["completeness"] > 0.97


def test_it_keeps_the_collision_distance_wherever_it_drives() -> None:
    env = ExplorationEnv(map="env2", robot={"collision_distance": 0.2}, stop_at=None, slam="truth")
    policy = FrontierPolicy(gym.wrappers.TimeLimit(env, 5000))
    observation, info = env.reset(seed=0)
    least = math.inf
    for _ in range(500):
        least = min(least, float(env.episodes.core.sensors.ranges.min()))
        observation, _, ended, _, info = env.step(policy.act(observation, info))
        assert not ended
    assert least > 0.2


@pytest.mark.parametrize("keywords", DRIVES)
def test_distances_from_walls_grow_with_the_robot(keywords: dict[str, Any]) -> None:
    robot = Robot(ExplorationEnv(map="env2", **keywords))
    assert robot.extra_room == pytest.approx(robot.spec.bumper - 0.12)
    policy = FrontierPolicy(ExplorationEnv(map="env2", **keywords))
    assert policy.driver.inflation.lethal_radius > robot.spec.bumper
    follower = policy.driver._follower
    assert follower.margin > follower.least_margin > follower.last_margin >= robot.spec.bumper - 1e-9


def test_beams_are_where_the_lidar_has_them() -> None:
    env = ExplorationEnv(map="env2", observation="map", lidar=AHEAD | {"max_range": 5.0, "noise": 0.0}, slam="truth")
    seen, info = env.reset(seed=0)
    hits = Robot(env).hits(seen, info["pose"], 5.0)
    assert len(hits) > 50 and np.abs(env.floorplan.clearance(hits)).max() < 1e-4
    assert Robot(env).hits({"scan": np.zeros(180)}, info["pose"], 5.0).shape == (0, 2)


class Nothing:
    """An observation without beams."""

    space = gym.spaces.Box(0.0, 1.0, (50,), np.float32)

    def observe(self, snapshot: Any) -> np.ndarray:
        return np.full(50, 0.1, np.float32)


def test_beams_of_a_strangers_observation_come_from_the_info() -> None:
    env = ExplorationEnv(map="env2", observation=Nothing, slam="truth", lidar={"noise": 0.0})
    robot, (observation, info) = Robot(env), env.reset(seed=0)
    assert robot.hits(observation, np.zeros(3), 5.0).shape == (0, 2) and not robot.sees_what_is_near(observation)
    hits = robot.hits(robot.beams_in(observation, info), info["pose"], 5.0)
    assert len(hits) > 50 and np.abs(env.floorplan.clearance(hits)).max() < 1e-4
