import math

import gymnasium as gym
import numpy as np
import pytest

import lidarena


def drive(policy: str, seed: int, **keywords: object) -> dict:
    env = gym.make("lidarena/Arena-v0", arena="random", **keywords).unwrapped
    driver = lidarena.baselines.make(policy, env)
    observation, info = env.reset(seed=seed)
    driver.reset(seed=seed)
    over = False
    while not over:
        observation, _, terminated, truncated, info = env.step(driver.act(observation, info))
        over = terminated or truncated
    return info


@pytest.mark.parametrize("policy", ["velocity_obstacles", "dwa"])
def test_obstacles_that_stand_are_driven_around(policy: str) -> None:
    ends = [drive(policy, seed, density=0.05, knowledge="lidar") for seed in range(4)]
    assert sum(info["success"] for info in ends) >= 3


def test_who_knows_how_obstacles_move_meets_fewer_of_them() -> None:
    moving = {"number": 15, "speed": 1.0, "kind": "straight"}
    ends = {
        policy: [drive(policy, seed, density=0.0, moving=moving)["collision"] for seed in range(8)]
        for policy in ("velocity_obstacles", "dwa")
    }
    assert sum(ends["velocity_obstacles"]) <= 1
    assert sum(ends["velocity_obstacles"]) <= sum(ends["dwa"])


def test_one_that_comes_head_on_is_dodged() -> None:
    env = gym.make("lidarena/Arena-v0", arena="random", density=0.0, moving={"number": 1, "speed": 1.0}).unwrapped
    driver = lidarena.baselines.make("velocity_obstacles", env)
    observation, info = env.reset(seed=0)
    driver.reset(seed=0)
    arenas = env.episodes.core
    x, y, theta = arenas.physics.poses[0, 0]
    ahead = np.array([math.cos(theta), math.sin(theta)])
    arenas.moving.states[0, 0] = *((x, y) + 25.0 * ahead), *(-ahead)
    info["moving"] = arenas.moving.discs(0)
    least = math.inf
    for _ in range(25):
        observation, _, terminated, _, info = env.step(driver.act(observation, info))
        least = min(least, info["clearance"])
        assert not terminated
    assert least > 0.0


@pytest.mark.parametrize("action", ["continuous", "discrete"])
def test_the_action_is_one_of_the_environment_s(action: str) -> None:
    env = gym.make("lidarena/Arena-v0", action=action, moving=2).unwrapped
    driver = lidarena.baselines.make("velocity_obstacles", env)
    observation, info = env.reset(seed=0)
    assert env.action_space.contains(driver.act(observation, info))
