"""Mazes on a grid of cells, as the benchmarks of multi-agent path finding have them: corridors of a few cells."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError


def draw_grid_maze(rng: np.random.Generator, side: int = 32, corridor: int = 2) -> NDArray[np.bool_]:
    """Draw a maze without loops by depth-first search; its walls are one cell thick.

    Args:
        rng: Draws the maze.
        side: Cells along each side.
        corridor: Cells across a corridor.

    Returns:
        (side, side), True where a cell is blocked.

    Raises:
        MapError: There is no room for a corridor.
    """
    if corridor < 1 or side < corridor:
        raise MapError(f"a corridor of {corridor} cells does not fit into a maze of {side} x {side} cells")
    count, pitch = (side + 1) // (corridor + 1), corridor + 1
    blocked = np.ones((side, side), np.bool_)
    blocked[:corridor, :corridor] = False
    met, stack = {(0, 0)}, [(0, 0)]
    while stack:
        r, c = stack[-1]
        beside = [(r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)]
        new = [(y, x) for y, x in beside if 0 <= y < count and 0 <= x < count and (y, x) not in met]
        if not new:
            stack.pop()
            continue
        y, x = new[int(rng.integers(len(new)))]
        rows = slice(min(r, y) * pitch, max(r, y) * pitch + corridor)
        blocked[rows, min(c, x) * pitch : max(c, x) * pitch + corridor] = False
        met.add((y, x))
        stack.append((y, x))
    return blocked
