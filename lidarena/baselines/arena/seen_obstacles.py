"""What a lidar has seen of an arena: hits as points, of this scan or of all."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.world.lidar import LidarSpec

_JUMP = 0.25
"""Neighbouring ranges that differ by more than this share of the nearer one, and by what lies between two beams, are
of different obstacles."""


def hits_of(info: dict[str, Any], lidar: LidarSpec) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Where the beams end.

    Args:
        info: An arena environment's; ``scan`` and ``pose`` are used.
        lidar: Its lidar.

    Returns:
        Points (n, 2) [m], and the numbers (n,) of their beams.
    """
    scan, (x, y, theta) = np.asarray(info["scan"], np.float64), info["pose"]
    beams = np.flatnonzero(_hit(scan, lidar))
    angles = theta + lidar.angles[beams]
    away = scan[beams, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.array([x, y]) + away, beams


def _hit(ranges: NDArray[np.float64], lidar: LidarSpec) -> NDArray[np.bool_]:
    """Which ranges are of beams that met something, and could say where."""
    return np.asarray((ranges > 0.0) & (ranges < np.float32(lidar.max_range)))


def nearest_of_each(info: dict[str, Any], lidar: LidarSpec) -> NDArray[np.float64]:
    """The nearest hit (n, 2) of each obstacle that the scan shows [m]: the point that repels the robot.

    Args:
        info: See :func:`hits_of`.
        lidar: See there.
    """
    points, beams = hits_of(info, lidar)
    if not len(points):
        return points
    scan = np.asarray(info["scan"], np.float64)
    ranges = scan[beams]
    before = scan[beams - 1]
    spread = _JUMP + 2.0 * lidar.increment  # a surface seen at a slant recedes from beam to beam
    new = (np.abs(ranges - before) > spread * np.minimum(ranges, before)) | ~_hit(before, lidar)
    if not lidar.sees_all_around:
        new[0] = True  # whatever the last beam sees is not beside it
    group = np.cumsum(new) % max(int(new.sum()), 1)  # the run before the first edge belongs to the last one
    order = np.lexsort((ranges, group))
    firsts = np.concatenate([[True], np.diff(group[order]) > 0])
    nearest: NDArray[np.float64] = points[order[firsts]]
    return nearest


def hidden_beside(info: dict[str, Any], lidar: LidarSpec) -> NDArray[np.float64]:
    """How far from each hit (n,) of :func:`hits_of` its obstacle may go on unseen [m].

    Half way to the neighbouring hit, or to the next beam where that sees past the obstacle: its end lies somewhere
    before it.

    Args:
        info: See :func:`hits_of`.
        lidar: See there.
    """
    scan = np.asarray(info["scan"], np.float64)
    hit, hidden = _hit(scan, lidar), np.zeros(len(scan))
    for side in (-1, 1):
        beyond = np.roll(scan, side)
        nearer = np.minimum(scan, beyond)
        together = np.roll(hit, side) & (np.abs(scan - beyond) <= (_JUMP + 2.0 * lidar.increment) * nearer)
        apart = np.sqrt((scan - beyond) ** 2 + scan * beyond * lidar.increment**2)
        hidden = np.maximum(hidden, np.where(together, 0.5 * apart, scan * lidar.increment))
    return np.asarray(hidden[hit])


class SeenObstacles:
    """Remembers one hit in every cell of a fine lattice, the one beside which the least was hidden.

    Args:
        cell: Side of a cell [m].
    """

    def __init__(self, cell: float) -> None:
        self._cell = cell
        self._hits: dict[tuple[int, int], tuple[float, float, float]] = {}

    def add(self, points: NDArray[np.float64], hidden: NDArray[np.float64]) -> bool:
        """Remember hits; whether one of them was in a new cell.

        Args:
            points: (n, 2) [m].
            hidden: (n,) how far beside each its obstacle may go on unseen [m].
        """
        before = len(self._hits)
        cells = np.floor(points / self._cell).astype(int).tolist()
        for (column, row), (x, y), beside in zip(cells, points.tolist(), hidden.tolist(), strict=True):
            known = self._hits.get((column, row))
            if known is None or beside < known[2]:
                self._hits[column, row] = (x, y, beside)
        return len(self._hits) > before

    def hits(self) -> NDArray[np.float64]:
        """All of them (n, 3): x, y, and how far beside each its obstacle may go on unseen [m]."""
        return np.array(list(self._hits.values())).reshape(-1, 3)
