"""Frontiers: where the known free space ends (Yamauchi 1997), found and ranked as ROS's explore_lite does.

The search floods the free cells from the robot (4 neighbours). An unknown cell with a free 4-neighbour is a frontier
cell; frontier cells that touch, also by a corner, make one frontier. Its cost (explore_lite's, here with the distance
in cells, so that both terms are metres) is

    cost = potential_scale * min_distance * resolution - gain_scale * size * resolution

With the customary scales of 1e-3 and 1 the least cost is almost always the *largest* frontier's.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.jit import inlined, kernel, leaf

_FREE = 0  # only a cell that is surely free carries the flood, as in explore_lite


@dataclass(frozen=True)
class Frontier:
    """One frontier; cells are [row, column].

    Attributes:
        cells: (size, 2) unknown cells, in the order in which they were found.
        size: Number of cells.
        min_distance: Straight distance in cells from the robot's cell to the nearest of them.
        cost: explore_lite's cost, in metres; the least is the best.
        centroid: Mean of the cells.
        goal: The free cell nearest to the centroid, among those the search was allowed to choose.
    """

    cells: NDArray[np.int64]
    size: int
    min_distance: float
    cost: float
    centroid: tuple[float, float]
    goal: tuple[int, int]


@kernel
def nearest_free(grid: NDArray[np.int8], row: int, col: int) -> tuple[int, int]:
    """The free cell with the fewest 4-neighbour steps from (row, col), through anything; (-1, -1) if none is free."""
    rows, cols = grid.shape
    seen = np.zeros((rows, cols), np.bool_)
    queue = np.empty((rows * cols, 2), np.int32)
    queue[0, 0], queue[0, 1] = row, col
    seen[row, col] = True
    head, tail = 0, 1
    while head < tail:
        r, c = queue[head, 0], queue[head, 1]
        head += 1
        if grid[r, c] == _FREE:
            return r, c
        for dr, dc in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            y, x = r + dr, c + dc
            if 0 <= y < rows and 0 <= x < cols and not seen[y, x]:
                seen[y, x] = True
                queue[tail, 0], queue[tail, 1] = y, x
                tail += 1
    return -1, -1


@inlined
def _is_frontier(cells: NDArray[np.int8], wide: int, cell: int) -> bool:
    near_free = cells[cell - wide] == _FREE or cells[cell + wide] == _FREE
    near_free = near_free or cells[cell - 1] == _FREE or cells[cell + 1] == _FREE
    return bool(cells[cell] < 0 and near_free)


@leaf
def _grow(
    cells: NDArray[np.int8], wide: int, taken: NDArray[np.bool_], members: NDArray[np.int32], first: int, cell: int
) -> int:
    """Write the frontier that contains a cell into ``members`` (n,) from ``first`` on; return where it ends."""
    members[first], taken[cell] = cell, True
    head, tail = first, first + 1
    while head < tail:
        middle = np.int64(members[head])
        head += 1
        for row in range(-1, 2):
            for column in range(-1, 2):
                there = middle + row * wide + column
                if not taken[there] and _is_frontier(cells, wide, there):
                    taken[there] = True
                    members[tail] = there
                    tail += 1
    return tail


@kernel
def _flood(
    cells: NDArray[np.int8],
    wide: int,
    start: int,
    seen: NDArray[np.bool_],
    taken: NDArray[np.bool_],
    members: NDArray[np.int32],
    ends: NDArray[np.int64],
) -> int:
    """Flood the free ``cells`` (n,), rows of ``wide``, and grow each frontier where it is met; how many there are."""
    queue = np.empty(len(cells), np.int32)
    queue[0], seen[start], ends[0] = start, True, 0
    head, tail, count = 0, 1, 0
    while head < tail:
        middle = np.int64(queue[head])
        head += 1
        for k in range(4):
            there = middle + (1 if k == 0 else wide if k == 1 else -1 if k == 2 else -wide)
            if cells[there] == _FREE:
                if not seen[there]:
                    seen[there] = True
                    queue[tail] = there
                    tail += 1
            elif cells[there] < 0 and not taken[there]:
                ends[count + 1] = _grow(cells, wide, taken, members, ends[count], there)
                count += 1
    return count


@kernel
def flood_frontiers(
    grid: NDArray[np.int8], row: int, col: int
) -> tuple[NDArray[np.bool_], NDArray[np.int32], NDArray[np.int64]]:
    """Flood ``grid`` (rows, cols) from (row, col).

    Returns:
        The free cells that were reached (rows, cols); all frontier cells (m, 2); where each frontier begins in them and
        the last ends (k + 1,).
    """
    rows, cols = grid.shape
    wide = cols + 2  # a border of occupied cells spares asking whether a neighbour is on the grid
    cells = np.full((rows + 2, wide), np.int8(100))
    cells[1:-1, 1:-1] = grid
    seen, taken = np.zeros((rows + 2, wide), np.bool_), np.zeros(cells.size, np.bool_)
    members, ends = np.empty(cells.size, np.int32), np.empty(cells.size + 1, np.int64)
    count = _flood(
        cells.reshape(cells.size), wide, (row + 1) * wide + col + 1, seen.reshape(cells.size), taken, members, ends
    )
    found = np.empty((ends[count], 2), np.int32)
    for i in range(len(found)):
        found[i, 0], found[i, 1] = members[i] // wide - 1, members[i] % wide - 1
    return seen[1:-1, 1:-1].copy(), found, ends[: count + 1].copy()


@kernel
def measure_frontier(cells: NDArray[np.int32], row: int, col: int) -> tuple[float, float, float]:
    """Distance from (row, col) to the nearest of ``cells`` (n, 2), and their mean row and column."""
    nearest, rows, cols = np.inf, 0.0, 0.0
    for i in range(cells.shape[0]):
        r, c = float(cells[i, 0]), float(cells[i, 1])
        nearest = min(nearest, (r - row) ** 2 + (c - col) ** 2)
        rows += r
        cols += c
    return math.sqrt(nearest), rows / cells.shape[0], cols / cells.shape[0]


@kernel
def nearest_cell(mask: NDArray[np.bool_], row: float, col: float) -> tuple[int, int]:
    """Return the cell of ``mask`` nearest to a point in straight distance, the first in raster order among equals.

    Args:
        mask: (rows, cols) the cells to choose from.
        row: The point's row, may be fractional.
        col: The point's column, may be fractional.

    Returns:
        [row, column], or (-1, -1) if the mask is empty.
    """
    rows, cols = mask.shape
    best = np.inf
    best_row, best_col = -1, -1
    middle = min(max(round(row), 0), rows - 1)
    for k in range(2 * rows):  # rows from the point's outwards, until none can be nearer
        offset = (k + 1) // 2
        if (offset - 0.5) ** 2 > best and offset > 0:
            break
        r = middle + (offset if k % 2 else -offset)
        away = (r - row) ** 2
        if r < 0 or r >= rows or away > best:
            continue
        reach = math.sqrt(best - away) + 1.0 if best < np.inf else cols + abs(col)  # what is farther away is no nearer
        for c in range(max(int(col - reach), 0), min(int(col + reach) + 1, cols)):
            if mask[r, c]:
                d = away + (c - col) ** 2
                if d < best or (d == best and (r < best_row or (r == best_row and c < best_col))):
                    best, best_row, best_col = d, r, c
    return best_row, best_col


def find_frontiers(
    occupancy: NDArray[np.int8],
    start: tuple[int, int],
    resolution: float,
    min_frontier_size: float = 0.5,
    potential_scale: float = 1e-3,
    gain_scale: float = 1.0,
    goals: NDArray[np.bool_] | None = None,
) -> list[Frontier]:
    """Return the frontiers that the robot's free space touches, the best (least cost) first.

    Args:
        occupancy: (rows, cols), -1 unknown, 0 free .. 100 occupied.
        start: [row, column] of the robot. If it is not free, the search starts at the nearest free cell.
        resolution: Side of a cell (m).
        min_frontier_size: Frontiers with size * resolution below this (m) are dropped.
        potential_scale: Weight of the distance.
        gain_scale: Weight of the size.
        goals: (rows, cols) cells from which goals may be chosen; default: every free cell that was reached.

    Returns:
        Frontiers by rising cost, equal costs in the order of discovery; empty if none or no cell may be a goal.

    Raises:
        ConfigError: for a start outside of the map or a resolution that is not positive.
    """
    grid = np.ascontiguousarray(occupancy, dtype=np.int8)
    if grid.ndim != 2 or not (0 <= start[0] < grid.shape[0] and 0 <= start[1] < grid.shape[1]):
        raise ConfigError(f"start cell {start} lies outside of the map of shape {grid.shape}")
    if not 0.0 < resolution < math.inf:
        raise ConfigError(f"a resolution of {resolution} m, allowed is a positive length")
    row, col = nearest_free(grid, *start)
    if row < 0:
        return []
    seen, cells, ends = flood_frontiers(grid, row, col)
    targets = seen if goals is None else np.ascontiguousarray(goals, dtype=np.bool_)
    found = []
    for first, last in itertools.pairwise(ends):
        size = int(last - first)
        if size * resolution < min_frontier_size - 1e-9:
            continue
        distance, *centre = measure_frontier(cells[first:last], *start)
        goal = nearest_cell(targets, *centre)
        if goal[0] < 0:
            return []
        cost = potential_scale * distance * resolution - gain_scale * size * resolution
        members = cells[first:last].astype(np.int64)
        found.append(Frontier(members, size, distance, cost, (centre[0], centre[1]), (int(goal[0]), int(goal[1]))))
    return sorted(found, key=lambda frontier: frontier.cost)
