import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ActionError
from lidarena.envs.workshop.actions import action_space, allowed, decisions_of, with_waiting
from lidarena.envs.workshop.task import load_task
from tests.envs.workshop.workshops import action, chain, task_of


def test_there_is_an_action_each_and_waiting() -> None:
    assert action_space(5) == gym.spaces.Discrete(6)
    assert decisions_of([5, 0], 2, 5).tolist() == [5, 0]
    for wrong in ([6], [-1], [0.5], ["wait"]):
        with pytest.raises(ActionError):
            decisions_of(wrong, 1, 5)


def test_an_action_is_allowed_once_what_comes_before_is_under_way() -> None:
    task = load_task(chain(3)).arrays
    table = allowed(task, np.array([[0, 0, 0], [1, 0, 0], [2, 1, 0], [2, 2, 2]]))
    assert table[:, 0].astype(int).tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]
    assert (table[:, 0] == table[:, 1]).all()


def test_only_who_can_may() -> None:
    task = load_task(task_of({"x": action("a", human=None), "y": action("b", robot=None)})).arrays
    assert allowed(task, np.zeros((1, 2), np.int64))[0].tolist() == [[False, True], [True, False]]


def test_waiting_is_allowed_beside_somebody_at_work_or_with_nothing_to_begin() -> None:
    free = np.array([[True, False], [True, False], [False, False], [True, True]])
    acts, due = np.array([True, False, False, False]), np.array([True, True, True, False])
    mask = with_waiting(free, acts, due)
    assert mask[:, 2].tolist() == [True, False, True, True]
    assert mask[3].tolist() == [False, False, True]  # not asked: it can only go on
