"""Regression search (Yang et al., section III D): a path's points connected by the longest free chords."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.field_kernels import NEAREST

_CANDIDATES = 256
_ROUNDS = 6
_BISECTIONS = 8
_GAIN = 5e-4
"""A further round must make the path shorter by this share."""


@leaf
def _see(
    path: NDArray[np.float64],
    i: int,
    j: int,
    kept: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
) -> bool:
    return segment_is_free(path[i, 0], path[i, 1], path[j, 0], path[j, 1], kept, walls, blocker)


@leaf
def connect(
    path: NDArray[np.float64],
    kept: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
    chosen: NDArray[np.int64],
) -> int:
    """Choose the points of a path that are connected directly: from each the farthest one in sight.

    Args:
        path: (M, 2) the points.
        kept: (K, 3) x, y, radius of the discs, grown by the clearance that a chord keeps (Yang et al.'s H0).
        walls: (4,) the room, drawn in likewise.
        blocker: (1,) scratch, 0.
        chosen: (M,) receives the indices; where even the next point is not in sight, the single step is taken.

    Returns:
        How many were chosen.
    """
    last = path.shape[0] - 1
    stride = max(1, last // _CANDIDATES)
    here, count = 0, 1
    chosen[0] = 0
    while here < last:
        there = last
        while there > here + 1 and not _see(path, here, there, kept, walls, blocker):
            there = max(there - stride, here + 1)
        while there < last and there < here + stride and _see(path, here, there + 1, kept, walls, blocker):
            there += 1
        here = there
        chosen[count] = here
        count += 1
    return count


@leaf
def cut_corners(
    corners: NDArray[np.float64],
    kept: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
    cut: NDArray[np.float64],
) -> None:
    """Replace each corner by the two ends of the longest free chord that cuts it off evenly.

    Args:
        corners: (S, 2) a path.
        kept: (K, 3) see :func:`connect`.
        walls: (4,) see there.
        blocker: (1,) scratch, 0.
        cut: (2 S - 2, 2) receives the new path.
    """
    last = corners.shape[0] - 1
    cut[0, 0], cut[0, 1] = corners[0, 0], corners[0, 1]
    cut[2 * last - 1, 0], cut[2 * last - 1, 1] = corners[last, 0], corners[last, 1]
    for i in range(1, last):
        x, y = corners[i, 0], corners[i, 1]
        ax, ay = corners[i - 1, 0] - x, corners[i - 1, 1] - y
        bx, by = corners[i + 1, 0] - x, corners[i + 1, 1] - y
        before, behind = math.hypot(ax, ay), math.hypot(bx, by)
        # neighbouring corners share a side, each may use half of it
        most = min(before if i == 1 else 0.5 * before, behind if i == last - 1 else 0.5 * behind)
        share, step = 0.0, 1.0
        for _ in range(_BISECTIONS):
            d = (share + step) * most
            p, q = d / max(before, NEAREST), d / max(behind, NEAREST)
            if segment_is_free(x + p * ax, y + p * ay, x + q * bx, y + q * by, kept, walls, blocker):
                share += step
            step *= 0.5
        p, q = share * most / max(before, NEAREST), share * most / max(behind, NEAREST)
        cut[2 * i - 1, 0], cut[2 * i - 1, 1] = x + p * ax, y + p * ay
        cut[2 * i, 0], cut[2 * i, 1] = x + q * bx, y + q * by


def path_length(path: NDArray[np.float64]) -> float:
    """Return the length (m) of a polyline (M, 2)."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def _densified(path: NDArray[np.float64], points: int) -> NDArray[np.float64]:
    """The same polyline with its corners and some ``points`` more, evenly spaced."""
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    wanted = np.union1d(at, np.linspace(0.0, at[-1], points))
    return np.column_stack([np.interp(wanted, at, path[:, 0]), np.interp(wanted, at, path[:, 1])])


def regression_search(
    path: NDArray[np.float64], kept: NDArray[np.float64], walls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a shorter path through some points of ``path``, Yang et al.'s search.

    Args:
        path: (M, 2) the planned points (m).
        kept: (K, 3) x, y, radius of the discs, grown by the clearance that a chord keeps (m).
        walls: (4,) the room, drawn in likewise (m).

    Returns:
        (S, 2) its corners; the ends are those of ``path``.
    """
    chosen = np.empty(len(path), np.int64)
    return path[chosen[: connect(path, kept, walls, np.zeros(1, np.int64), chosen)]]


def shortened(
    corners: NDArray[np.float64], kept: NDArray[np.float64], walls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Cut the corners and search again over points between them, from either end, while the path gets shorter.

    Args:
        corners: (S, 2) from :func:`regression_search` (m).
        kept: (K, 3) see there.
        walls: (4,) see there.

    Returns:
        (T, 2) corners of a path that is no longer.
    """
    best, blocker = corners.copy(), np.zeros(1, np.int64)
    for turn in range(_ROUNDS if len(corners) > 2 else 0):
        before, step = path_length(best), -1 if turn % 2 == 0 else 1
        cut = np.empty((2 * len(best) - 2, 2))
        cut_corners(best, kept, walls, blocker, cut)
        found = regression_search(np.ascontiguousarray(_densified(cut, _CANDIDATES)[::step]), kept, walls)[::step]
        best = np.ascontiguousarray(found) if path_length(found) < before else best
        if before - path_length(best) < _GAIN * before and turn > 0:
            break
    return best
