"""Which of several attempts at a log to keep, and how far they agree."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.traced_map import TracedMap
from lidarena.slam.planar import between

DOUBTFUL = 0.5
"""Where the attempt nearest to the one that was kept is farther from it than this, there is no telling which one is
right [m]."""


@dataclass(frozen=True)
class Attempt:
    """What one run of a filter made of a log.

    Attributes:
        scans: (K,) which scans were processed.
        poses: (K, 3) the laser's poses then.
        made: The map that they make.
        path: (S, 3) the laser's poses at all scans.
    """

    scans: NDArray[np.int64]
    poses: NDArray[np.float64]
    made: TracedMap
    path: NDArray[np.float64]


class Spread(NamedTuple):
    """How far the other attempts are from the one that was kept, each at the median of its poses [m].

    Attributes:
        nearest: Of the others.
        farthest: Of the others.
    """

    nearest: float
    farthest: float


ALONE = Spread(0.0, 0.0)
"""Of a single attempt."""


def choose_attempt(attempts: Sequence[Attempt]) -> tuple[int, Spread]:
    """Choose the attempt with the largest evidence.

    The evidence of different sets of scans does not compare, so it is taken for each scan.

    Returns:
        Which one, and how far the others are from it.
    """
    worth = [each.made.evidence / max(len(each.scans), 1) for each in attempts]
    best = int(np.argmax(worth))
    away = [_apart(attempts[best].path, each.path) for k, each in enumerate(attempts) if k != best]
    return best, Spread(min(away, default=0.0), max(away, default=0.0))


def _apart(path: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """How far motions over half of the way differ between two paths (S, 3), in the median [m].

    Between poses of one path and poses much later the frame in which they lie cancels, and so does a bend at the start.
    """
    half = max(len(path) // 2, 1)
    if len(path) < 2:
        return 0.0
    apart = between(path[:-half], path[half:])[:, :2] - between(other[:-half], other[half:])[:, :2]
    return float(np.median(np.hypot(apart[:, 0], apart[:, 1])))
