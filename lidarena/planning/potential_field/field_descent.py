"""The walk down the potential: constant steps, trap detection, potential filling (Yang et al., Fig. 6)."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.base.random_streams import normal
from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.field_kernels import Field, Obstacles, force_at

ARRIVED, OUT_OF_STEPS, TRAPPED, COLLIDED, OUT_OF_FILLS = 0, 1, 2, 3, 4
"""How a walk ends."""

_TURNS = np.array([0.0, 15, -15, 30, -30, 45, -45, 60, -60, 75, -75, 90, -90, 105, -105, 120, -120, 150, -150, 180])
_TURNS *= math.pi / 180.0
"""In which order a guarded walk tries other headings when the force leads too near to an obstacle."""


class Motion(NamedTuple):
    """The numbers of a walk, all of them floats; lengths in metres."""

    gamma: float
    """Length of a step (eq. 14)."""
    arrival: float
    """At this distance the goal is reached (Yang et al.'s D)."""
    same: float
    """X_k and X_{k-2} are the same place if they are less than this apart; 0: only if they are equal."""
    window: float
    """A walk that moved less than ``net`` over so many steps is trapped; 0: not tested."""
    net: float
    """See ``window``."""
    fill: float
    """Strength s of a fill (eq. 15); 0: a trap ends the walk."""
    jitter: float
    """Standard deviation of a fill's place around the middle of the cycle."""
    guarded: float
    """1: a step that would come too near to an obstacle is turned aside; 0: it is taken."""


@leaf
def _is_trapped(path: NDArray[np.float64], k: int, since: int, motion: Motion) -> bool:
    """Whether the walk has stopped getting on at step ``k``; ``since``: the step at which it may last have filled."""
    if k >= 2 and k > since:
        net = math.hypot(path[k, 0] - path[k - 2, 0], path[k, 1] - path[k - 2, 1])
        if net < motion.same or net == 0.0:
            return True
    window = int(motion.window)
    if window == 0 or k < since + window:
        return False
    return math.hypot(path[k, 0] - path[k - window, 0], path[k, 1] - path[k - window, 1]) < motion.net


@leaf
def _fill(
    path: NDArray[np.float64],
    k: int,
    motion: Motion,
    noise: NDArray[np.uint64],
    fills: NDArray[np.float64],
    count: int,
) -> None:
    """Write x, y, s of a new fill: the mean of the cycle that ends at step ``k``, and a little noise."""
    first = max(k - max(int(motion.window), 2) + 1, 0)
    x, y = 0.0, 0.0
    for i in range(first, k + 1):
        x += path[i, 0]
        y += path[i, 1]
    fills[count, 0] = x / (k + 1 - first) + motion.jitter * normal(noise)
    fills[count, 1] = y / (k + 1 - first) + motion.jitter * normal(noise)
    fills[count, 2] = motion.fill


@leaf
def _turned_aside(
    x: float,
    y: float,
    heading: float,
    gamma: float,
    kept: Obstacles,
    blocker: NDArray[np.int64],
) -> float:
    """The free heading nearest to the wanted one; NaN if there is none."""
    for i in range(_TURNS.shape[0]):
        turned = heading + _TURNS[i]
        ahead, aside = x + gamma * math.cos(turned), y + gamma * math.sin(turned)
        if segment_is_free(x, y, ahead, aside, kept.discs, kept.walls, blocker):
            return float(turned)
    return math.nan


@leaf
def walk(
    path: NDArray[np.float64],
    goal: NDArray[np.float64],
    obstacles: Obstacles,
    kept: Obstacles,
    field: Field,
    motion: Motion,
    fills: NDArray[np.float64],
    blocker: NDArray[np.int64],
    noise: NDArray[np.uint64],
) -> tuple[int, int, int]:
    """Walk down the field from ``path[0]``.

    Args:
        path: (N + 1, 2) its first row is the start; the others are written.
        goal: (2,) x, y (m).
        obstacles: Discs and walls, grown by the robot's radius.
        kept: The same, grown by the clearance that a guarded walk keeps.
        field: The potential.
        motion: How to walk.
        fills: (F, 3) room for x, y, s of the fills.
        blocker: (1,) scratch, 0.
        noise: (4,) random stream, see :mod:`lidarena.base.random_streams`.

    Returns:
        Index of the last row of ``path`` that was written, number of fills, and how it ended.
    """
    count, since = 0, 0
    last = path.shape[0] - 1
    for k in range(last + 1):
        x, y = path[k, 0], path[k, 1]
        if math.hypot(x - goal[0], y - goal[1]) <= motion.arrival:
            return k, count, ARRIVED
        if k == last:
            break
        if _is_trapped(path, k, since, motion):
            if motion.fill == 0.0:
                return k, count, TRAPPED
            if count == fills.shape[0]:
                return k, count, OUT_OF_FILLS
            _fill(path, k, motion, noise, fills, count)
            count += 1
            since = k + int(motion.window)  # one window of rest
        fx, fy = force_at(x, y, goal, obstacles.discs, obstacles.walls, field, fills, count)
        heading = math.atan2(fy, fx)
        if motion.guarded != 0.0:
            heading = _turned_aside(x, y, heading, motion.gamma, kept, blocker)
        boxed_in = math.isnan(heading)  # stays, which is a trap
        path[k + 1, 0] = x if boxed_in else x + motion.gamma * math.cos(heading)
        path[k + 1, 1] = y if boxed_in else y + motion.gamma * math.sin(heading)
        nx, ny = path[k + 1, 0], path[k + 1, 1]
        if motion.guarded == 0.0 and not segment_is_free(x, y, nx, ny, obstacles.discs, obstacles.walls, blocker):
            return k + 1, count, COLLIDED
    return last, count, OUT_OF_STEPS
