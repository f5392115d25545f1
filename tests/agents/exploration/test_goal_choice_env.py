"""The world of choices, the network that learns in it, and the agent that comes of it."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from lidarena.agents.exploration.goal_choice_env import GOAL_CHOICE_ID, GoalChoiceEnv
from lidarena.base.errors import ConfigError

MAZE = "maze:5?width=5&height=5"


def test_gymnasium_finds_nothing_to_complain_about() -> None:
    check_env(GoalChoiceEnv(map=MAZE, max_episode_steps=200), skip_render_check=True)


def episode(**weights: float) -> tuple[float, dict, dict, list[float]]:
    """Sum of the rewards with these weights alone, first and last info, and D-optimality at every decision."""
    only = dict.fromkeys(("path", "uncertainty", "completeness", "collision"), 0.0)
    env = GoalChoiceEnv(map=MAZE, reward=only | weights, certain_enough=1e-9, max_episode_steps=400)
    _, start = env.reset(seed=1)
    seen: list[float] = []
    step = env._world.step
    env._world.step = lambda action: note(step(action), seen)  # type: ignore[method-assign]
    total, ended = 0.0, False
    while not ended:
        _, reward, terminated, truncated, info = env.step(0)
        total, ended = total + reward, terminated or truncated
    return total, start, info, seen


def note(outcome: tuple, seen: list[float]) -> tuple:
    seen.append(outcome[4]["d_optimality"])
    return outcome


def test_rewards_are_what_their_weights_say() -> None:
    total, start, end, _ = episode(completeness=1.0)
    assert total == pytest.approx(end["completeness"] - start["completeness"]) and total > 0.5
    total, start, end, _ = episode(path=1.0)
    assert total == pytest.approx(-(end["path_length"] - start["path_length"]) / (0.55 * 25))
    total, *_, seen = episode(uncertainty=1.0)
    usual = np.full(50, np.log(1.3e-4))
    gain = usual[0] - np.concatenate([usual, np.log(seen)]).mean()
    assert total == pytest.approx((25 / 56) ** 1.5 * gain)  # less than in a larger world


def test_unknown_weights_are_refused() -> None:
    with pytest.raises(ConfigError, match=r"unknown term 'paht' of the reward; did you mean 'path'"):
        GoalChoiceEnv(map=MAZE, reward={"preset": "combined", "paht": 1.0})


def test_a_world_that_lives_through_its_episode_again_goes_on_alike() -> None:
    one, other = (GoalChoiceEnv(map=[MAZE, "maze:6?width=5&height=5"], start="random") for _ in range(2))
    one.reset(seed=7)
    for choice in (0, 1, 0, 2):
        one.step(choice)
    other.reset(seed=8)
    other.step(1)
    other.memory = one.memory
    for choice in (0, 3, 0):
        for first, second in zip(one.step(choice), other.step(choice), strict=True):
            np.testing.assert_equal(first, second)
    for first, second in zip(one.reset(), other.reset(), strict=True):  # the generators stand at the same number, too
        np.testing.assert_equal(first, second)


def test_the_id_is_registered_once() -> None:
    assert GOAL_CHOICE_ID in gym.registry
