"""Whether a segment is free among discs and the walls of a room."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.potential_field.field_kernels import wall_gap


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
    """Whether a segment touches no disc and stays within the walls, which it may touch (exact, not sampled).

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
        if wall_gap(ax, ay, walls, side) < 0.0 or wall_gap(bx, by, walls, side) < 0.0:
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
