"""Correlative scan matching (Olson 2009) against the last keyframes: the best pose in a window, whatever the guess.

The grid around the robot repeats itself every ``CELLS`` cells, so that it never has to move or grow: what lies so far
apart is never in it at the same time.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.slam.graph.surface_points import SurfacePoints

CELLS = 1024
"""Cells of a side of the grid; a power of two."""
CELL = 0.05
"""Side of a cell [m]."""
_REACH = 4
"""Cells around a point that it makes likely."""
_WIDE = 2.0
"""Spread of a point's likelihood in cells."""


class LocalGrid(NamedTuple):
    """Where the last keyframes saw surfaces.

    Attributes:
        likelihood: (CELLS, CELLS) uint8, 255 at a point, falling off around it.
    """

    likelihood: NDArray[np.uint8]


def empty_grid() -> LocalGrid:
    """A grid that knows nothing."""
    return LocalGrid(np.zeros((CELLS, CELLS), np.uint8))


@leaf
def draw_scan(grid: LocalGrid, store: SurfacePoints, s: int, pose: NDArray[np.float64], sign: int) -> None:
    """Draw a scan taken at ``pose`` (3,) into the grid, or with a ``sign`` of -1 wipe out all that it touches."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    mask = CELLS - 1
    for b in range(store.points.shape[1]):
        if store.weights[s, b] == 0.0:
            continue
        px, py = float(store.points[s, b, 0]), float(store.points[s, b, 1])
        u, v = (pose[0] + cos * px - sin * py) / CELL, (pose[1] + sin * px + cos * py) / CELL
        c, r = math.floor(u), math.floor(v)
        for dr in range(-_REACH, _REACH + 1):
            for dc in range(-_REACH, _REACH + 1):
                if sign < 0:
                    grid.likelihood[(r + dr) & mask, (c + dc) & mask] = 0
                    continue
                away = (c + dc + 0.5 - u) ** 2 + (r + dr + 0.5 - v) ** 2
                value = np.uint8(255.0 * math.exp(-0.5 * away / (_WIDE * _WIDE)))
                if value > grid.likelihood[(r + dr) & mask, (c + dc) & mask]:
                    grid.likelihood[(r + dr) & mask, (c + dc) & mask] = value


@kernel
def best_in_window(
    grid: LocalGrid,
    store: SurfacePoints,
    s: int,
    guess: NDArray[np.float64],
    window: NDArray[np.float64],
    steps: NDArray[np.float64],
    spread: NDArray[np.float64],
    most: int,
) -> NDArray[np.float64]:
    """Search a window of poses around a guess.

    Args:
        grid: What is known.
        store: The scans.
        s: Which scan to match.
        guess: (3,) the window's middle.
        window: (2,) how far to either side: [m, rad].
        steps: (2,) from a pose to the next: [m, rad].
        spread: (2,) standard deviations of the guess [m, rad]; what is farther away must fit better.
        most: Points of the scan that are looked at.

    Returns:
        (4,) the best pose and its share of the highest likelihood, without what the distance cost it.
    """
    chosen = np.flatnonzero(store.weights[s] > 0.0)
    stride = max(len(chosen) // most, 1)
    n = (len(chosen) + stride - 1) // stride
    us, vs = np.empty(n), np.empty(n)
    best = np.array([guess[0], guess[1], guess[2], 0.0])
    if n == 0:
        return best
    turns, shifts = math.ceil(window[1] / steps[1]), math.ceil(window[0] / steps[0])
    highest, mask = -1e9, CELLS - 1
    for t in range(-turns, turns + 1):
        angle = guess[2] + t * steps[1]
        cos, sin = math.cos(angle), math.sin(angle)
        for k in range(n):
            px, py = float(store.points[s, chosen[k * stride], 0]), float(store.points[s, chosen[k * stride], 1])
            us[k], vs[k] = (guess[0] + cos * px - sin * py) / CELL, (guess[1] + sin * px + cos * py) / CELL
        off_turn = 0.5 * (t * steps[1] / spread[1]) ** 2
        for a in range(-shifts, shifts + 1):
            for b in range(-shifts, shifts + 1):
                du, dv = a * steps[0] / CELL, b * steps[0] / CELL
                total = 0
                for k in range(n):
                    total += grid.likelihood[math.floor(vs[k] + dv) & mask, math.floor(us[k] + du) & mask]
                share = total / (255.0 * n)
                cost = 0.01 * (off_turn + 0.5 * (a * a + b * b) * (steps[0] / spread[0]) ** 2)
                if share - cost > highest:
                    highest = share - cost
                    best[0], best[1], best[2] = guess[0] + a * steps[0], guess[1] + b * steps[0], angle
                    best[3] = share
    return best
