import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.base.errors import ConfigError
from lidarena.baselines.corridor.lifelong import LifelongFleet


def make(**keywords):
    return gym.make("lidarena/CorridorCentral-v0", map="office", robots=4, places="random", **keywords).unwrapped


def test_fixed_goals_are_driven_to_without_a_collision() -> None:
    env = make(max_episode_steps=-1)
    policy = lidarena.baselines.make("lifelong", env)
    observation, info = env.reset(seed=2)
    policy.reset(seed=2)
    for _ in range(1500):
        observation, _, terminated, _, info = env.step(policy.act(observation, info))
        if terminated:
            break
    assert info["success"].all() and not info["collision"].any()
    assert policy.steps > 10 and not policy.finished


def test_nobody_begins_a_step_before_all_have_completed_the_last() -> None:
    env = make(goals="lifelong")
    policy = LifelongFleet(env, futures=2, horizon=3)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    steps, targets = 0, None
    for _ in range(120):
        action = policy.act(observation, info)
        if policy.steps > steps and targets is not None:
            assert (np.hypot(*(info["pose"][:, :2] - targets).T) < 0.1).all()
        steps, targets = policy.steps, policy._targets.copy()
        observation, _, _, _, info = env.step(action)
    assert steps >= 5


@pytest.mark.parametrize(("option", "value"), [("futures", -1), ("horizon", 0), ("repairs", 1001)])
def test_numbers_out_of_range_are_refused(option: str, value: int) -> None:
    with pytest.raises(ConfigError, match=f"{option} = {value}"):
        LifelongFleet(make(), **{option: value})
