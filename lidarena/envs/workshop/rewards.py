"""What a decision in the workshop is worth."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.rewards import Floats, RewardTerms

REWARDS = RewardTerms(
    ("time", "completion", "deadline", "robot_idle", "human_idle", "unfinished"),
    {
        "default": {
            "time": 10.0,
            "completion": 1.0,
            "deadline": 1.0,
            "robot_idle": 0.0,
            "human_idle": 0.0,
            "unfinished": 10.0,
        },
        "makespan": {"time": 10.0, "unfinished": 10.0},
    },
)
"""``time`` is minus the seconds over the task's deadline, ``completion`` 1 when everything is done, ``deadline`` 1 when
it is done in time, ``robot_idle`` and ``human_idle`` minus the idle seconds over the deadline, ``unfinished`` minus the
share of the actions that are not done when the time is up."""


def weigh_terms(
    weights: Mapping[str, float],
    spent: Floats,
    idle: Floats,
    over: NDArray[np.bool_],
    undone: Floats,
    time: Floats,
) -> dict[str, Floats]:
    """Return the terms of the last step, each times its weight, (worlds,).

    Args:
        weights: By term.
        spent: (worlds,) time of the step over the deadline.
        idle: (worlds, 2) idle time of human and robot over the deadline.
        over: (worlds,) whether everything is done or the time is up.
        undone: (worlds,) share of the actions that are not done.
        time: (worlds,) since the episode began, over the deadline.
    """
    complete = over & (undone == 0.0)
    values = {
        "time": -spent,
        "completion": complete.astype(np.float64),
        "deadline": (complete & (time <= 1.0)).astype(np.float64),
        "robot_idle": -idle[:, 1],
        "human_idle": -idle[:, 0],
        "unfinished": -np.where(over, undone, 0.0),
    }
    return {term: weight * values[term] for term, weight in weights.items()}
