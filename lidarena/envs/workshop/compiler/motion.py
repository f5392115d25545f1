"""How long ways take in the shared workspace, where one may stand in the other's way: motion acquisition."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.workshop.task import WorkshopTask
from lidarena.envs.workshop.walking import walking_time

Floats = NDArray[np.float64]
_PATIENCE = 60.0
"""A way that takes so much longer because of the other is blocked [s]."""
_BLOCKED = 15.0
"""What a blocked way costs beside its usual time: the other will be gone by then [s]."""


class WorkspaceMotion(NamedTuple):
    """Durations of ways between the ``L`` locations of a task."""

    time: Floats
    """(2, L, L, L + 1) of each agent from the first location to the second while the other is at the third; the last
    place stands for nobody in the way [s]"""
    near: NDArray[np.bool_]
    """(L, L) whether an agent at the first location and the other at the second would come too near: one must wait"""


def acquire_motion(task: WorkshopTask, separation: float, space: bool = True) -> WorkspaceMotion:
    """Walk every way, alone and past the other at every location; the walks are the environment's own.

    Args:
        task: What is to be done.
        separation: Distance between the two that is kept [m].
        space: False takes no notice of space: every way takes no time, and nobody is in the way.
    """
    count, arrays, grid = len(task.locations), task.arrays, task.grid
    time, near = np.zeros((2, count, count, count + 1)), np.zeros((count, count), np.bool_)
    if not space:
        return WorkspaceMotion(time, near)
    keep = float(sum(task.radii)) + separation
    for agent in range(2):
        mine, theirs = grid.points[arrays.field[:, agent]], grid.points[arrays.field[:, 1 - agent]]
        apart = np.hypot(*np.moveaxis(mine[:, None] - theirs[None], 2, 0))
        near |= apart < keep if agent == 0 else (apart < keep).T
        step = float(arrays.step[agent])
        nobody = np.full(2, np.nan)
        for i, j in np.ndindex(count, count):
            ends = int(arrays.field[i, agent]), int(arrays.field[j, agent])
            alone = walking_time(grid, *ends, nobody, step, keep, 1e4)
            time[agent, i, j] = alone
            for k in range(count):
                if min(apart[i, k], apart[j, k]) >= keep:
                    past = walking_time(grid, *ends, theirs[k].copy(), step, keep, alone + _PATIENCE)
                    time[agent, i, j, k] = past if np.isfinite(past) else alone + _BLOCKED
    return WorkspaceMotion(time, near)
