"""The actions of the workshop: to begin one of the task's, or to wait."""

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.action_parsing import choices_of
from lidarena.envs.workshop.kernels import OPEN
from lidarena.envs.workshop.task import TaskArrays


def action_space(actions: int) -> gym.spaces.Discrete:
    """``Discrete(actions + 1)``: the task's actions by number, and to wait."""
    return gym.spaces.Discrete(actions + 1)


def decisions_of(actions: Any, count: int, known: int) -> NDArray[np.int64]:
    """The numbers (count,) of decisions among ``known`` actions and waiting.

    Raises:
        ActionError: Something else than whole numbers from 0 to ``known``.
    """
    return choices_of(actions, count, known + 1)


def allowed(task: TaskArrays, status: NDArray[np.int64]) -> NDArray[np.bool_]:
    """What each agent may begin, (worlds, 2, n): what it can do, is open, and waits for nothing that is open.

    Args:
        task: What is to be done.
        status: (worlds, n) of the actions.
    """
    unopened = status == OPEN
    blocked = (unopened.astype(np.int64) @ task.before.astype(np.int64)) > 0
    free: NDArray[np.bool_] = (unopened & ~blocked)[:, None, :] & task.capable[None]
    return free


def with_waiting(free: NDArray[np.bool_], other_acts: NDArray[np.bool_], due: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask (worlds, n + 1) of an agent: what it may begin, and last whether it may wait.

    To wait is allowed while the other one is at something, or where there is nothing to begin.

    Args:
        free: (worlds, n) what it may begin.
        other_acts: (worlds,) whether the other agent is at an action.
        due: (worlds,) whether it is the agent's to decide; if not, it can only go on.
    """
    begins = free & due[:, None]
    waits = other_acts | ~begins.any(axis=1) | ~due
    return np.concatenate([begins, waits[:, None]], axis=1)
