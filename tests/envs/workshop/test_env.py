"""The workshop as a Gymnasium environment: the checkers, endings, own parts, and what it refuses."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env

import lidarena  # noqa: F401
from lidarena.base.errors import ActionError
from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import Sleeper, chain, loose, play

SPECS: list[dict[str, Any]] = [
    {},
    {"task": "gearbox", "human": "mixture", "expose_truth": True},
    {"task": chain(3), "human": "absent", "recognition": "position", "render_mode": "rgb_array"},
    {"task": loose(2), "human": Sleeper, "reward": {"time": 1.0, "robot_idle": 2.0}},
]


@pytest.mark.parametrize("keywords", SPECS, ids=["pile", "gearbox", "chain", "own"])
def test_both_checkers_are_passed(keywords: dict[str, Any]) -> None:
    from stable_baselines3.common.env_checker import check_env as check_for_sb3

    check_env(gym.make("lidarena/Workshop-v0", **keywords).unwrapped)
    check_for_sb3(gym.make("lidarena/Workshop-v0", **keywords))


@pytest.mark.parametrize("human", ["free", "helpful", "stubborn", "slow", "absent", "mixture"])
def test_every_human_and_a_robot_that_acts_get_it_done(human: str) -> None:
    for task in ("pile", "cabinet"):
        info = play(WorkshopEnv(task=task, human=human), seed=1)[-1]
        assert info["success"] and info["completion"] == 1.0 and not info["collision"]


def test_rewards_count_the_time() -> None:
    env = WorkshopEnv(task=loose(3), reward="makespan")
    env.reset(seed=0)
    total, over = 0.0, False
    while not over:
        _, reward, terminated, truncated, info = env.step(int(np.flatnonzero(env.action_masks())[0]))
        total, over = total + reward, terminated or truncated
    assert total == pytest.approx(-10.0 * info["makespan"] / 100.0)
    assert sum(info["reward_terms"].values()) == pytest.approx(reward)
    with pytest.raises(ResetNeeded):
        env.step(0)


def test_a_seed_fixes_an_episode() -> None:
    first, second, other = (play(WorkshopEnv(task="gearbox"), seed=seed) for seed in (5, 5, 6))
    assert [info["time"] for info in first] == [info["time"] for info in second]
    assert first[-1]["time"] != other[-1]["time"]


def test_a_reward_and_an_observation_of_ones_own() -> None:
    class Clock:
        space = gym.spaces.Box(0.0, 1e4, (1,), np.float32)

        def observe(self, info: dict[str, Any]) -> np.ndarray:
            return np.array([info["time"]], np.float32)

    env = WorkshopEnv(task=loose(2), observation=Clock(), reward=lambda step: -step.info["duration"])
    seen, info = env.reset(seed=0)
    assert seen.tolist() == [0.0]
    seen, reward, _, _, info = env.step(int(np.flatnonzero(info["action_mask"])[0]))
    assert reward == pytest.approx(-info["duration"]) and seen[0] == pytest.approx(info["time"])


@pytest.mark.parametrize("action", [6, -1, 0.5, np.nan, [0], "wait", None, True])
def test_bad_actions_are_refused(action: object) -> None:
    env = WorkshopEnv()
    env.reset(seed=0)
    with pytest.raises(ActionError, match="action"):
        env.step(action)
