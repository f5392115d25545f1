"""Clearance of points and segments among discs and the walls of a room."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.field_kernels import wall_gap
from lidarena.world.kernels import leaf


@leaf
def segment_is_free(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    discs: NDArray[np.float64],
    walls: NDArray[np.float64],
    blocker: NDArray[np.int64],
) -> bool:
    """Whether a segment touches neither a disc nor a wall (exact, not sampled).

    Args:
        ax: x of its first end (m).
        ay: y of its first end (m).
        bx: x of its second end (m).
        by: y of its second end (m).
        discs: (K, 3) x, y, radius, grown by the clearance that is asked for (m).
        walls: (4,) x_min, y_min, x_max, y_max, drawn in likewise (m).
        blocker: (1,) the disc that was last in the way; it is asked first, for neighbouring segments share it.
    """
    ex, ey = bx - ax, by - ay
    for side in range(4):
        if wall_gap(ax, ay, walls, side) <= 0.0 or wall_gap(bx, by, walls, side) <= 0.0:
            return False
    length = max(ex * ex + ey * ey, 1e-300)
    for k in range(-1, discs.shape[0]):
        i = blocker[0] if k < 0 else k
        if i >= discs.shape[0]:
            continue
        dx, dy = discs[i, 0] - ax, discs[i, 1] - ay
        along = min(max((dx * ex + dy * ey) / length, 0.0), 1.0)
        dx -= along * ex
        dy -= along * ey
        if dx * dx + dy * dy <= discs[i, 2] * abs(discs[i, 2]):  # a radius below 0 is in nobody's way
            blocker[0] = i
            return False
    return True


@leaf
def path_clearance(path: NDArray[np.float64], discs: NDArray[np.float64], walls: NDArray[np.float64]) -> float:
    """Return the least distance (m) of a polyline (M, 2) to any disc (K, 3) or wall (4,); negative inside, inf alone."""
    least = math.inf
    for j in range(path.shape[0]):
        ax, ay = path[max(j - 1, 0), 0], path[max(j - 1, 0), 1]
        bx, by = path[j, 0], path[j, 1]
        for side in range(4):
            least = min(least, wall_gap(bx, by, walls, side))
        ex, ey = bx - ax, by - ay
        length = max(ex * ex + ey * ey, 1e-300)
        for i in range(discs.shape[0]):
            dx, dy = discs[i, 0] - ax, discs[i, 1] - ay
            along = min(max((dx * ex + dy * ey) / length, 0.0), 1.0)
            least = min(least, math.hypot(dx - along * ex, dy - along * ey) - discs[i, 2])
    return least
