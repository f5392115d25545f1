"""Where the edge of the known map lies, as seen from the robot: a lidar of the unknown that looks through walls."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.world.kernels import leaf

_FADE = 2.0
"""A cell of the edge counts e times less at this distance [m]."""
_ENOUGH = 10.0
"""So many cells right here, half a metre of edge, are as much as can be said."""


@leaf
def feel_frontiers(
    occupancy: NDArray[np.int8],
    origins: NDArray[np.float64],
    poses: NDArray[np.float64],
    resolution: float,
    out: NDArray[np.float32],
) -> None:
    """Sum up the frontier cells (unknown, with a free 4-neighbour) of every sector around each pose.

    A sector's value is min(1, Σ exp(-d / 2 m) / 10) over its frontier cells at distances d: a speck says next to
    nothing, half a metre of frontier nearby as much as there is to say.

    Args:
        occupancy: (worlds, rows, columns) -1, 0, 100.
        origins: (worlds, 2) [m].
        poses: (worlds, 3).
        resolution: Side of a cell [m].
        out: (worlds, sectors) output; the first sector is centred ahead, the next ones lie to the left.
    """
    rows, columns = occupancy.shape[1:]
    sectors = out.shape[1]
    for w in range(out.shape[0]):
        out[w] = 0.0
        x, y = poses[w, 0] - origins[w, 0], poses[w, 1] - origins[w, 1]
        for r in range(1, rows - 1):
            for c in range(1, columns - 1):
                if occupancy[w, r, c] != -1:
                    continue
                beside = (occupancy[w, r - 1, c] == 0) | (occupancy[w, r + 1, c] == 0)
                if not (beside | (occupancy[w, r, c - 1] == 0) | (occupancy[w, r, c + 1] == 0)):
                    continue
                dx, dy = (c + 0.5) * resolution - x, (r + 0.5) * resolution - y
                turn = (math.atan2(dy, dx) - poses[w, 2]) / (2.0 * math.pi) * sectors + 0.5
                sector = int(turn - math.floor(turn / sectors) * sectors) % sectors
                out[w, sector] += math.exp(-math.sqrt(dx * dx + dy * dy) / _FADE) / _ENOUGH
        for k in range(sectors):
            out[w, k] = min(out[w, k], 1.0)
