"""Driving along a planned path at constant speed: a step is a chord of the path, or turns aside from what it hits."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.potential_field.disc_clearance import segment_is_free

_POINTS_A_STEP = 16
_WINDOW = 3 * _POINTS_A_STEP
"""How far ahead the path is looked at, in points."""
_TURN = math.radians(7.5)
_TURNS = 24
"""Headings that are tried to either side of the wanted one, ``_TURN`` apart."""
_AHEAD = math.radians(75.0)
"""Headings that turn aside by more lead back rather than on."""
_SPARE = 1e-3
"""Clearance of every step, over its length."""
NO_WALLS = np.array([-np.inf, -np.inf, np.inf, np.inf])


@leaf
def _in_sight(
    points: NDArray[np.float64],
    first: int,
    x: float,
    y: float,
    discs: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
) -> bool:
    """Whether a point of the path not far behind number ``first`` can be seen from a place."""
    for k in range(first, min(first + _WINDOW, points.shape[0])):
        if segment_is_free(x, y, points[k, 0], points[k, 1], discs, walls, blocker):
            return True
    return False


@leaf
def aim(
    points: NDArray[np.float64],
    first: int,
    x: float,
    y: float,
    step: float,
    discs: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
) -> tuple[int, float]:
    """Choose the heading of the next step.

    Args:
        points: (P, 2) the path, points close together [m].
        first: The point that was last aimed at.
        x: Of the robot [m].
        y: Of the robot [m].
        step: Length of the step [m].
        discs: (K, 3) x, y, radius of the obstacles, grown by the robot's [m].
        walls: (4,) the room, drawn in likewise [m].
        blocker: (1,) scratch, 0.

    Returns:
        The point aimed at, and the heading [rad]: to the farthest point within a step, or the one nearest to that on
        which nothing is hit, if one is from where the path is in sight again.
    """
    last = points.shape[0] - 1
    target = first
    while (
        target < last and target < first + _WINDOW and math.hypot(points[target, 0] - x, points[target, 1] - y) < step
    ):
        target += 1  # the first point a step away: a later one may lie beyond a bend of the path
    wanted = math.atan2(points[target, 1] - y, points[target, 0] - x)
    second = math.nan
    for k in range(2 * _TURNS + 1):
        heading = wanted + _TURN * ((k + 1) // 2) * (1.0 if k % 2 else -1.0)
        there_x, there_y = x + step * math.cos(heading), y + step * math.sin(heading)
        if segment_is_free(x, y, there_x, there_y, discs, walls, blocker):
            if _in_sight(points, target, there_x, there_y, discs, walls, blocker):
                return target, heading
            if math.isnan(second):
                second = heading
    return target, wanted if math.isnan(second) else second


@leaf
def is_free(
    points: NDArray[np.float64],
    first: int,
    discs: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
) -> bool:
    """Whether a path (P, 2) touches no disc (K, 3) and no wall (4,) from point number ``first`` on."""
    for k in range(first, points.shape[0] - 1):
        if not segment_is_free(points[k, 0], points[k, 1], points[k + 1, 0], points[k + 1, 1], discs, walls, blocker):
            return False
    return True


class ChordFollower:
    """Follows one path.

    Args:
        path: (S, 2) corners, the robot's place first [m].
        step: What the robot drives in a decision [m].
        discs: (K, 3) x, y, radius of obstacles that no step may touch, grown by the robot's radius [m].
        walls: (4,) the room, drawn in likewise; None: none [m].
    """

    def __init__(
        self,
        path: NDArray[np.float64],
        step: float,
        discs: NDArray[np.float64],
        walls: NDArray[np.float64] | None = None,
    ) -> None:
        at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
        wanted = np.union1d(at, np.arange(0.0, at[-1], step / _POINTS_A_STEP))
        self._points = np.column_stack([np.interp(wanted, at, path[:, axis]) for axis in (0, 1)])
        self._step, self._next = step, 0
        self._discs = discs + np.array([0.0, 0.0, _SPARE * step])
        spare = _SPARE * step * np.array([1.0, 1.0, -1.0, -1.0])
        self._walls = NO_WALLS if walls is None else walls + spare

    def heading(self, place: NDArray[np.float64]) -> float:
        """Heading of the next step [rad] from where the robot is (2,) or longer [m]."""
        self._next, heading = aim(
            self._points,
            self._next,
            float(place[0]),
            float(place[1]),
            self._step,
            self._discs,
            self._walls,
            np.zeros(1, np.int64),
        )
        return float(heading)

    def careful_heading(self, place: NDArray[np.float64], choices: Sequence[NDArray[np.float64]]) -> tuple[float, bool]:
        """Heading of the next step among obstacles that are known only in part.

        Args:
            place: See :meth:`heading`.
            choices: Discs (K, 3) as the class takes them, those that would best be kept away from first; further ones
                count if none of the headings that lead on keeps away from these [m].

        Returns:
            The heading [rad], and whether it touches none of the last discs.
        """
        x, y, blocker = float(place[0]), float(place[1]), np.zeros(1, np.int64)
        for discs in choices:
            grown = discs + np.array([0.0, 0.0, _SPARE * self._step])
            target, heading = aim(self._points, self._next, x, y, self._step, grown, self._walls, blocker)
            there = x + self._step * math.cos(heading), y + self._step * math.sin(heading)
            free = segment_is_free(x, y, *there, grown, self._walls, blocker)
            wanted = math.atan2(self._points[target, 1] - y, self._points[target, 0] - x)
            if free and abs(math.remainder(heading - wanted, 2.0 * math.pi)) <= _AHEAD:
                break
        self._next = int(target)
        return float(heading), bool(free)

    def at_end(self, place: NDArray[np.float64]) -> bool:
        """Whether the robot is within a step of the path's end."""
        away = self._points[-1] - place[:2]
        return self._next == len(self._points) - 1 and float(np.hypot(*away)) <= self._step

    def is_blocked(self, discs: NDArray[np.float64]) -> bool:
        """Whether a disc (K, 3) lies on the path from the point last aimed at on [m]."""
        return not is_free(self._points, self._next, discs, NO_WALLS, np.zeros(1, np.int64))
