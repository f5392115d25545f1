"""Exploring by choice: what the chooser is told, and that the robot goes where it says."""

import gymnasium as gym
import numpy as np
import pytest
from numpy.typing import NDArray

import lidarena  # noqa: F401
from lidarena.baselines.exploration.frontier_features import CANDIDATES, FEATURES, NAMES
from lidarena.baselines.exploration.goal_choice import GoalChoicePolicy

COLUMN = {name: index for index, name in enumerate(NAMES)}


class Nearest:
    """Chooses the nearest frontier, and remembers what it was told."""

    def __init__(self) -> None:
        self.told: list[NDArray[np.float32]] = []

    def __call__(self, features: NDArray[np.float32]) -> int:
        self.told.append(features)
        return 0


def explore(choose: object, steps: int, world: str = "maze:5?width=5&height=5", seed: int = 2) -> tuple:
    env = gym.make("lidarena/Exploration-v0", map=world, max_episode_steps=5000, disable_env_checker=True)
    policy = GoalChoicePolicy(env, choose)  # type: ignore[arg-type]
    observation, info = env.reset(seed=seed)
    policy.reset()
    infos, ended = [info], False
    while not (ended or policy.finished or len(infos) > steps):
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        infos.append(info)
        ended = terminated or truncated
    return policy, infos


def test_choosing_the_nearest_explores_a_maze() -> None:
    chooser = Nearest()
    _, infos = explore(chooser, 3000)
    assert infos[-1]["completeness"] > 0.97 and not infos[-1]["collision"]
    assert len(chooser.told) > 5


def test_what_is_told_is_of_the_order_of_one_and_in_order() -> None:
    chooser = Nearest()
    explore(chooser, 400)
    for features in chooser.told:
        assert features.shape == (CANDIDATES, FEATURES) and np.isfinite(features).all()
        assert np.abs(features).max() < 20
        there = features[:, COLUMN["there"]]
        count = int(there.sum())
        assert count >= 2 and (there[:count] == 1).all() and not features[count:].any()
        told = features[:count]
        frontiers = told[told[:, COLUMN["revisit"]] == 0]
        assert (np.diff(frontiers[:, COLUMN["way"]]) >= 0).all()
        assert told[:, COLUMN["pursued"]].sum() <= 1 and told[:, COLUMN["nearest"]].sum() == 1
        assert (told[:, COLUMN["unknown"]] <= 1).all() and (frontiers[:, COLUMN["size"]] * 3 >= 0.5 - 1e-6).all()
        assert (told[:, COLUMN["way"]] >= 0).all() and (told[:, COLUMN["turn"]] <= 1).all()


def test_whoever_cannot_decide_explores_all_the_same() -> None:
    """To and fro for half a minute, and the robot keeps to what was chosen last."""
    calls: list[int] = []

    def undecided(features: NDArray[np.float32]) -> int:
        calls.append(0)
        frontiers = int(features[:, 0].sum()) - int(features[:, COLUMN["revisit"]].sum())
        return (frontiers - 1) * (len(calls) % 2) if not features[:, COLUMN["end"]].any() else 0

    policy, infos = explore(undecided, 2000, world="maze:7?width=8&height=8")
    assert infos[-1]["completeness"] > 0.97 and policy.finished  # without that it needs 3000 steps


def test_the_robot_goes_back_to_its_start_when_told_to() -> None:
    calls = []

    def back_after_a_while(features: NDArray[np.float32]) -> int:
        calls.append(features)
        back = np.flatnonzero(features[:, COLUMN["revisit"]])
        return int(back[0]) if len(back) and len(calls) > 8 else 0

    _, infos = explore(back_after_a_while, 700)
    away = np.array([np.hypot(*(info["pose"][:2] - infos[0]["pose"][:2])) for info in infos])
    farthest = int(np.argmax(away))
    assert away[farthest] > 2.0
    assert away[farthest:].min() < 1.0  # below 2 m the start is no candidate any more


def test_a_choice_that_is_not_there_stands_for_the_nearest() -> None:
    first, second = (explore(lambda _, answer=answer: answer, 200)[1] for answer in (0, CANDIDATES - 1))
    frontiers_only = [info["pose"] for info in second][:20]
    assert np.allclose([info["pose"] for info in first][:20], frontiers_only)


def test_a_chooser_may_put_its_answer_off() -> None:
    """As the training does: the question is raised as an exception, and answered in a second call."""

    class Later(Exception):  # noqa: N818
        pass

    answers: list[int] = []

    def choose(_: NDArray[np.float32]) -> int:
        if not answers:
            raise Later
        return answers.pop()

    env = gym.make("lidarena/Exploration-v0", map="maze:5?width=5&height=5", disable_env_checker=True)
    policy = GoalChoicePolicy(env, choose)
    observation, info = env.reset(seed=2)
    policy.reset()
    asked = 0
    for _ in range(150):
        try:
            action = policy.act(observation, info)
        except Later:
            answers.append(0)
            asked += 1
            action = policy.act(observation, info)
        observation, _, terminated, _, info = env.step(action)
        assert not terminated
    assert asked >= 3
    assert len(policy._places) == 150


@pytest.mark.parametrize("seed", [0, 1])
def test_the_same_seed_explores_the_same_way(seed: int) -> None:
    first, second = (explore(Nearest(), 150, seed=seed)[1] for _ in range(2))
    assert np.array_equal(first[-1]["pose"], second[-1]["pose"])
