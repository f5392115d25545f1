"""Plan generation: every allocation of the actions to the two, with every valid order of each one's share."""

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.workshop.task import TaskArrays

_Orders = tuple[tuple[int, ...], tuple[int, ...]]


def enumerate_plans(task: TaskArrays, most: int) -> NDArray[np.int64] | None:
    """List all plans: n actions one after the other have 2^n, n independent ones (n + 1) · n!.

    A plan is a sequence of actions for each agent such that precedence and both sequences together have no cycle.

    Args:
        task: What is to be done.
        most: Give up beyond so many.

    Returns:
        (P, 2, n) sequences of human and robot, -1 behind the last one; None if there are more than ``most``.
    """
    count = task.before.shape[0]
    level: set[_Orders] = {((), ())}
    for _ in range(count):
        following: set[_Orders] = set()
        for human, robot in level:
            done = np.zeros(count, np.bool_)
            done[[*human, *robot]] = True
            ready = ~done & ~(task.before & ~done[:, None]).any(axis=0)
            for action in np.flatnonzero(ready).tolist():
                if task.capable[0, action]:
                    following.add(((*human, action), robot))
                if task.capable[1, action]:
                    following.add((human, (*robot, action)))
        if len(following) > most:  # every beginning goes on to at least one plan of its own
            return None
        level = following
    plans = np.full((len(level), 2, count), -1, np.int64)
    for row, orders in zip(plans, sorted(level), strict=True):
        for agent, order in enumerate(orders):
            row[agent, : len(order)] = order
    return plans
