"""Robots that get new goals whenever they reach one."""

import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.envs import corridor_v0
from lidarena.world.floorplan import Floorplan

KEYWORDS = {"map": "office", "robots": 3, "goals": "lifelong", "places": "random"}


def drive(env, policy, steps, seed=0):
    observation, info = env.reset(seed=seed)
    policy.reset(seed=seed)
    goals, infos = [info["goal"].copy()], [info]
    for _ in range(steps):
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        goals.append(info["goal"].copy())
        infos.append(info)
        if terminated or truncated:
            break
    return np.array(goals), infos


def test_whoever_reaches_its_goal_gets_another_and_drives_on() -> None:
    env = gym.make("lidarena/CorridorCentral-v0", **KEYWORDS).unwrapped
    goals, infos = drive(env, lidarena.baselines.make("lifelong", env), 600)
    reached = infos[-1]["goals_reached"]
    changes = (goals[1:] != goals[:-1]).any(axis=2).sum(axis=0)
    assert (reached == changes).all() and reached.sum() >= 3
    assert not infos[-1]["collision"].any() and not infos[-1]["finished"].any()
    for now in goals:  # nobody gets a goal where another one is going to stop
        gaps = np.hypot(*(now[:, None] - now[None]).transpose(2, 0, 1)) + 9.0 * np.eye(3)
        assert gaps.min() >= 2 * env.options.robot.radius
    measures = infos[-1]["measures"]
    assert measures["throughput"] == pytest.approx(reached.sum() / infos[-1]["time"])


def test_the_same_seed_gives_the_same_goals() -> None:
    runs = []
    for _ in range(2):
        env = gym.make("lidarena/CorridorCentral-v0", **KEYWORDS).unwrapped
        runs.append(drive(env, lidarena.baselines.make("lifelong", env), 200, seed=5)[0])
    assert np.array_equal(*runs)


def test_pettingzoo_agents_go_on_too() -> None:
    env = corridor_v0.parallel_env(**KEYWORDS)
    policy = lidarena.baselines.make("lifelong", env)
    observations, infos = env.reset(seed=1)
    policy.reset(seed=1)
    for _ in range(450):
        observations, _, _, _, infos = env.step(policy.act(observations, infos))
    assert len(env.agents) == 3
    assert sum(info["goals_reached"] for info in infos.values()) >= 1
    reached = [info["success"] for info in infos.values()]
    assert reached == [info["goals_reached"] > 0 for info in infos.values()]


def closet(side: float) -> Floorplan:
    walls = [(0, 0, 0, side), (0, side, side, side), (side, side, side, 0), (side, 0, 0, 0)]
    return Floorplan("closet", np.array(walls, float), np.empty((0, 3)), (0.0, 0.0, side, side), (0.3, 0.3, 0.0))


def test_other_words_and_maps_with_one_place_are_refused() -> None:
    with pytest.raises(ConfigError, match="lifelong"):
        corridor_v0.parallel_env(goals="livelong")
    with pytest.raises(ConfigError, match="together"):
        corridor_v0.parallel_env(goals="lifelong", starts=[(1, 1)] * 4)
    with pytest.raises(LidarenaError, match="needed"):
        corridor_v0.parallel_env(map=closet(0.62), robots=1, goals="lifelong").reset(seed=0)
