"""Regression search (Yang et al., section III D): a path's points connected by the longest free chords."""

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.disc_clearance import segment_is_free
from lidarena.world.kernels import leaf

_CANDIDATES = 256
_ROUNDS = 6
_GAIN = 1e-3
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
        kept: (K, 3) x, y, radius of the discs, grown by the clearance that a chord keeps (the paper's H0).
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


def path_length(path: NDArray[np.float64]) -> float:
    """Return the length (m) of a polyline (M, 2)."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def _densified(path: NDArray[np.float64], points: int) -> NDArray[np.float64]:
    """The same polyline with its corners and some ``points`` more, evenly spaced."""
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    wanted = np.union1d(at, np.linspace(0.0, at[-1], points))
    return np.column_stack([np.interp(wanted, at, path[:, 0]), np.interp(wanted, at, path[:, 1])])


def regression_search(
    path: NDArray[np.float64], kept: NDArray[np.float64], walls: NDArray[np.float64], repeat: bool = False
) -> NDArray[np.float64]:
    """Return a shorter path through some points of ``path``.

    Args:
        path: (M, 2) the planned points.
        kept: (K, 3) x, y, radius of the discs, grown by the clearance that a chord keeps (m).
        walls: (4,) the room, drawn in likewise (m).
        repeat: Go on with points between the corners, from the goal and the start in turn, while that shortens the
            path; the paper searches once, from the start.

    Returns:
        (S, 2) its corners; the ends are those of ``path``.
    """
    if len(path) < 3:
        return path.copy()
    blocker, chosen = np.zeros(1, np.int64), np.empty(len(path), np.int64)
    best = path[chosen[: connect(path, kept, walls, blocker, chosen)]]
    for turn in range(_ROUNDS if repeat and len(best) > 2 else 0):
        points = np.ascontiguousarray(_densified(best, _CANDIDATES)[:: -1 if turn % 2 == 0 else 1])
        chosen = np.empty(len(points), np.int64)
        found = points[chosen[: connect(points, kept, walls, blocker, chosen)]]
        found = found[:: -1 if turn % 2 == 0 else 1]
        shorter = path_length(found) < (1.0 - _GAIN) * path_length(best)
        if path_length(found) < path_length(best):
            best = np.ascontiguousarray(found)
        if not shorter and turn > 0:
            break
    return best
