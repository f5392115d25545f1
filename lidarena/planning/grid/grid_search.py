"""A* on a grid whose cells cost a number each: the shortest way through an inflated map.

A step from cell a to cell b costs ``|a b| * cost[b]`` (1 straight, sqrt(2) diagonally): what is entered is paid for, so
a start inside a blocked cell is allowed, and a cost of 1 everywhere gives lengths in cells.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.heap import pop, push
from lidarena.base.jit import kernel

# the four straight steps first, so that the 4-connected search takes a prefix
_STEPS = np.array([(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1)], dtype=np.int64)
_SQRT2 = math.sqrt(2.0)


@kernel
def _estimate(rows: int, cols: int, diagonal: bool) -> float:
    """Length in cells of the shortest way over an empty grid: octile, or Manhattan without diagonals."""
    rows = abs(rows)
    cols = abs(cols)
    if not diagonal:
        return float(rows + cols)
    return max(rows, cols) + (_SQRT2 - 1.0) * min(rows, cols)


@kernel
def search_grid(
    cost: NDArray[np.float64], start: int, goal: int, diagonal: bool, cheapest: float
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """A* from ``start`` to ``goal`` (flat indices) over ``cost`` (rows, cols); ``goal`` = -1 explores everything.

    Returns:
        ``parent`` (rows * cols,): the cell before each on its best way, -1 at the start and where nothing came;
        ``reached`` (rows * cols,): what the way there costs, inf where nothing came.
    """
    rows, cols = cost.shape
    n = rows * cols
    parent = np.full(n, -1, np.int32)
    reached = np.full(n, np.inf)
    keys = np.empty(n)
    heap = np.empty(n, np.int32)
    where = np.full(n, -1, np.int32)
    reached[start] = 0.0
    keys[start] = 0.0
    size = push(heap, where, keys, 0, start)
    goal_row, goal_col = goal // cols, goal % cols
    while size > 0:
        here = pop(heap, where, keys, size)
        size -= 1
        if here == goal:
            break
        row, col = here // cols, here % cols
        for k in range(8 if diagonal else 4):
            r = row + _STEPS[k, 0]
            c = col + _STEPS[k, 1]
            if r < 0 or r >= rows or c < 0 or c >= cols or cost[r, c] == np.inf:
                continue
            if k >= 4 and (cost[row, c] == np.inf or cost[r, col] == np.inf):
                continue  # no cutting of corners
            new = reached[here] + (_SQRT2 if k >= 4 else 1.0) * cost[r, c]
            there = r * cols + c
            if new < reached[there]:
                reached[there] = new
                parent[there] = here
                ahead = cheapest * _estimate(r - goal_row, c - goal_col, diagonal) if goal >= 0 else 0.0
                keys[there] = new + ahead
                size = push(heap, where, keys, size, there)
    return parent, reached


@kernel
def trace(parent: NDArray[np.int32], goal: int, cols: int) -> NDArray[np.int64]:
    """The cells (n, 2) on the way to ``goal``, the start first; ``parent`` is that of ``search_grid``."""
    n = 1
    cell = goal
    while parent[cell] >= 0:
        cell = parent[cell]
        n += 1
    path = np.empty((n, 2), np.int64)
    cell = goal
    for i in range(n - 1, -1, -1):
        path[i, 0] = cell // cols
        path[i, 1] = cell % cols
        cell = parent[cell]
    return path


def _checked(cost: ArrayLike, *cells: tuple[int, int]) -> NDArray[np.float64]:
    grid = np.ascontiguousarray(cost, dtype=np.float64)
    if grid.ndim != 2 or grid.size == 0:
        raise ConfigError(f"the cost grid has shape {grid.shape}, allowed is (rows, columns) with at least one cell")
    lowest = grid.min()
    if not lowest >= 0.0:  # also true of NaN
        raise ConfigError(f"the cost grid contains {lowest}, allowed are numbers >= 0 and inf for blocked cells")
    for row, col in cells:
        if not (0 <= row < grid.shape[0] and 0 <= col < grid.shape[1]):
            raise ConfigError(f"cell ({row}, {col}) lies outside of the grid of shape {grid.shape}")
    return grid


def find_path(
    cost: ArrayLike, start: tuple[int, int], goal: tuple[int, int], diagonal: bool = True
) -> NDArray[np.int64]:
    """Return the cheapest way from ``start`` to ``goal`` (A*, octile heuristic scaled by the smallest cost).

    Args:
        cost: (rows, cols) cost of entering each cell, per cell length; >= 0, inf = blocked.
        start: [row, column]; may be blocked itself.
        goal: [row, column].
        diagonal: True for 8 neighbours without cutting corners, False for 4.

    Returns:
        (n, 2) cells [row, column] from ``start`` to ``goal`` inclusive; (0, 2) if there is no way.

    Raises:
        ConfigError: for a grid that is empty or has a negative or NaN cost, or a cell outside of it.
    """
    grid = _checked(cost, start, goal)
    cols = grid.shape[1]
    source, target = start[0] * cols + start[1], goal[0] * cols + goal[1]
    cheapest = float(grid.min())
    parent, reached = search_grid(grid, source, target, diagonal, cheapest if math.isfinite(cheapest) else 0.0)
    if not math.isfinite(reached[target]):
        return np.empty((0, 2), np.int64)
    path: NDArray[np.int64] = trace(parent, target, cols)
    return path


def path_costs(cost: ArrayLike, start: tuple[int, int], diagonal: bool = True) -> NDArray[np.float64]:
    """Return what the cheapest way from ``start`` to every cell costs (Dijkstra).

    Args:
        cost: (rows, cols) cost of entering each cell, per cell length; >= 0, inf = blocked.
        start: [row, column]; may be blocked itself.
        diagonal: True for 8 neighbours without cutting corners, False for 4.

    Returns:
        (rows, cols): 0 at the start, inf where there is no way.

    Raises:
        ConfigError: as in :func:`find_path`.
    """
    grid = _checked(cost, start)
    _, reached = search_grid(grid, start[0] * grid.shape[1] + start[1], -1, diagonal, 0.0)
    costs: NDArray[np.float64] = reached.reshape(grid.shape)
    return costs
