import gymnasium as gym
import numpy as np

import lidarena
from tests.baselines.arena.arena_drives import EMPTY, drive


def test_nothing_seen_is_planned_once() -> None:
    env = gym.make("lidarena/Arena-v0", arena=EMPTY, knowledge="lidar")
    policy = lidarena.baselines.make("apf_improved_lidar", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    for _ in range(10):
        observation, _, _, _, info = env.step(policy.act(observation, info))
    assert policy.plans == 1


def test_what_comes_into_sight_is_planned_around() -> None:
    env = gym.make("lidarena/Arena-v0", arena="u_trap:3", knowledge="lidar")
    policy = lidarena.baselines.make("apf_improved_lidar", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    ended, least = False, np.inf
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        ended, least = terminated or truncated, min(least, float(np.min(info["scan"])))
    assert info["success"] and policy.plans > 1 and least > info["radius"]


def test_a_new_episode_forgets_what_was_seen() -> None:
    first, second = (drive("apf_improved_lidar", arena="u_trap:1", knowledge="lidar") for _ in range(2))
    assert first[0] == second[0] and first[1]["decisions"] == second[1]["decisions"]
