"""What a robot knows of its surroundings, and what planning asks of it: where there is room, and what is in sight."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel


@dataclass(frozen=True)
class Surroundings:
    """What the robot knows of its surroundings, as arrays on one grid.

    Attributes:
        gap: (rows, cols) float32 clearance of each cell (m), see :func:`lidarena.planning.grid.inflation.clearance`.
        closed: (rows, cols) bool, cells where the robot's centre must not go whatever the clearance.
        resolution: Side of a cell (m).
        origin: World x, y of the lower-left corner of cell [0, 0].
    """

    gap: NDArray[np.float32]
    closed: NDArray[np.bool_]
    resolution: float
    origin: tuple[float, float]

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Return the [row, column] of a point, moved into the grid if it lies outside."""
        rows, cols = self.gap.shape
        row = math.floor((y - self.origin[1]) / self.resolution)
        col = math.floor((x - self.origin[0]) / self.resolution)
        return min(max(row, 0), rows - 1), min(max(col, 0), cols - 1)

    def points(self, cells: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the centres (n, 2) x, y of cells (n, 2) [row, column]."""
        centres: NDArray[np.float64] = np.asarray(cells, np.float64)[:, ::-1] + 0.5
        points: NDArray[np.float64] = centres * self.resolution + np.asarray(self.origin)
        return points

    @cached_property
    def frame(self) -> NDArray[np.float64]:
        """The numbers that kernels need: x and y of the origin, side of a cell."""
        return np.array([self.origin[0], self.origin[1], self.resolution])


@kernel
def gap_at(
    gap: NDArray[np.float32], closed: NDArray[np.bool_], frame: NDArray[np.float64], x: float, y: float
) -> float:
    """Return the clearance (m) at a point, bilinear between cell centres; -1 in a closed cell or off the grid.

    Args:
        gap: (rows, cols) clearance of the cells (m).
        closed: (rows, cols) cells that are forbidden.
        frame: (3,) x, y of the origin, side of a cell.
        x: The point's x (m).
        y: The point's y (m).
    """
    rows, cols = gap.shape
    u = (x - frame[0]) / frame[2]
    v = (y - frame[1]) / frame[2]
    if u < 0.0 or v < 0.0 or u >= cols or v >= rows or closed[int(v), int(u)]:
        return -1.0
    u = min(max(u - 0.5, 0.0), cols - 1.0)
    v = min(max(v - 0.5, 0.0), rows - 1.0)
    c, r = int(u), int(v)
    c1, r1 = min(c + 1, cols - 1), min(r + 1, rows - 1)
    u -= c
    v -= r
    low = (1.0 - u) * gap[r, c] + u * gap[r, c1]
    high = (1.0 - u) * gap[r1, c] + u * gap[r1, c1]
    return float((1.0 - v) * low + v * high)


@kernel
def line_is_free(
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
    frame: NDArray[np.float64],
    start: NDArray[np.float64],
    end: NDArray[np.float64],
    margin: float,
) -> bool:
    """The kernel of :func:`in_sight`; gap and closed (rows, cols), frame (3,), start and end (2,) or longer."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    steps = max(1, math.ceil(math.hypot(dx, dy) / (0.5 * frame[2])))
    for i in range(1, steps + 1):
        if gap_at(gap, closed, frame, start[0] + dx * i / steps, start[1] + dy * i / steps) < margin:
            return False
    return True


def in_sight(around: Surroundings, start: NDArray[np.float64], end: NDArray[np.float64], margin: float = 0.0) -> bool:
    """Return whether the straight line between two points crosses no closed cell and keeps a clearance.

    Args:
        around: The surroundings.
        start: (2,) or longer, x, y (m); not looked at itself.
        end: (2,) or longer, x, y (m).
        margin: Least clearance (m).
    """
    ends = np.asarray(start, np.float64)[:2], np.asarray(end, np.float64)[:2]
    return bool(line_is_free(around.gap, around.closed, around.frame, *ends, margin))
