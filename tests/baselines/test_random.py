import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.baselines.random import RandomPolicy


@pytest.mark.parametrize("action", ["discrete", "continuous"])
def test_actions_are_allowed_ones_and_equal_seeds_draw_equal_ones(action: str) -> None:
    env = gym.make("lidarena/Arena-v0", arena="yang", action=action)
    policy = lidarena.baselines.make("random", env)
    runs = []
    for seed in (0, 0, 1):
        policy.reset(seed=seed)
        runs.append([policy.act(None, {}) for _ in range(20)])
    assert all(env.action_space.contains(one) for run in runs for one in run)
    numbers = [np.ravel(run).tolist() for run in runs]
    assert numbers[0] == numbers[1] != numbers[2]


def test_the_environments_own_generator_stays_untouched() -> None:
    env = gym.make("lidarena/Arena-v0", arena="yang", action="discrete")
    env.action_space.seed(3)
    expected = [env.action_space.sample() for _ in range(10)]
    env.action_space.seed(3)
    policy = RandomPolicy(env)
    policy.reset(seed=9)
    policy.act(None, {})
    assert [env.action_space.sample() for _ in range(10)] == expected
