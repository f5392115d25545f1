"""The cheapest way over a grid whose cells cost a small whole number each, by A* with buckets.

A step costs 5 straight and 7 diagonally, times what the cell costs that is entered; a diagonal step costs as much as
the dearest of the cells that it touches, so that no corner is cut for less. Every way's cost is a whole number, and
buckets of one each (Dial 1969) take the place of a heap, which is several times as slow.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

DEAREST = 255
"""What a cell may cost at most; the least is 1."""
_STRAIGHT, _SLANTED = 5, 7
_RING = 2048  # more than the dearest step and what the estimate changes by on it
_ROWS = np.array([0, 1, 0, -1, 1, 1, -1, -1], np.int64)
_COLUMNS = np.array([1, 0, -1, 0, 1, -1, -1, 1], np.int64)


class SearchSpace(NamedTuple):
    """Memory of a search over N × N cells, used again by the next one.

    Attributes:
        costs: (N, N) of the way to each cell, where ``round`` is that of the search.
        round: (N, N) number of the search that came to a cell last.
        came: (N, N) by which of the eight steps.
        final: (N, N) number of the search that was done with a cell last.
        pool: (8 N², 2) cell and the next entry of its bucket.
        heads: (ring,) first entry of each bucket, -1 where it is empty.
        searches: (1,) how many there were.
    """

    costs: NDArray[np.int32]
    round: NDArray[np.int32]
    came: NDArray[np.int8]
    final: NDArray[np.int32]
    pool: NDArray[np.int32]
    heads: NDArray[np.int32]
    searches: NDArray[np.int32]


def search_space(cells: int) -> SearchSpace:
    """Memory for grids of ``cells`` × ``cells``."""
    shape = (cells, cells)
    return SearchSpace(
        np.zeros(shape, np.int32),
        np.zeros(shape, np.int32),
        np.zeros(shape, np.int8),
        np.zeros(shape, np.int32),
        np.zeros((8 * cells * cells + 1, 2), np.int32),
        np.full(_RING, -1, np.int32),
        np.zeros(1, np.int32),
    )


@inlined
def _estimate(rows: int, columns: int) -> int:
    """What the way over cells of cost 1 would cost."""
    rows, columns = abs(rows), abs(columns)
    return _STRAIGHT * max(rows, columns) + (_SLANTED - _STRAIGHT) * min(rows, columns)


@inlined
def _step_cost(cost: NDArray[np.uint8], row: int, column: int, step: int) -> int:
    """What a step from a cell costs; -1 where it leads off the grid."""
    r, c = row + _ROWS[step], column + _COLUMNS[step]
    if r < 0 or c < 0 or r >= cost.shape[0] or c >= cost.shape[1]:
        return -1
    dear = np.int64(cost[r, c])
    if step < 4:
        return int(_STRAIGHT * dear)
    return int(_SLANTED * max(dear, np.int64(cost[row, c]), np.int64(cost[r, column])))


@leaf
def search_way(cost: NDArray[np.uint8], start: int, goal: int, space: SearchSpace) -> int:
    """Find the cheapest way between two cells of a grid; returns what it costs.

    Args:
        cost: (N, N) of entering each cell, 1 to 255, so that there always is a way.
        start: Cell, row · N + column; what it costs does not matter.
        goal: Cell.
        space: Of N; ``came`` tells the way to :func:`trace_way`.
    """
    wide = cost.shape[1]
    space.searches[0] += 1
    number, space.heads[:] = space.searches[0], -1
    goal_row, goal_column = goal // wide, goal % wide
    row, column = start // wide, start % wide
    space.costs[row, column], space.round[row, column], space.came[row, column] = 0, number, -1
    key = _estimate(row - goal_row, column - goal_column)
    space.pool[0, 0], space.pool[0, 1] = start, -1
    space.heads[key % _RING] = 0
    used = 1
    while True:
        entry = space.heads[key % _RING]
        if entry < 0:
            key += 1
            continue
        here = space.pool[entry, 0]
        space.heads[key % _RING] = space.pool[entry, 1]
        row, column = here // wide, here % wide
        if space.final[row, column] == number:
            continue
        space.final[row, column] = number
        if here == goal:
            return int(space.costs[row, column])
        for step in range(8):
            more = _step_cost(cost, row, column, step)
            if more < 0:
                continue
            r, c = row + _ROWS[step], column + _COLUMNS[step]
            new = space.costs[row, column] + more
            if space.round[r, c] == number and new >= space.costs[r, c]:
                continue
            space.round[r, c], space.costs[r, c], space.came[r, c] = number, new, step
            bucket = (new + _estimate(r - goal_row, c - goal_column)) % _RING
            space.pool[used, 0], space.pool[used, 1] = r * wide + c, space.heads[bucket]
            space.heads[bucket] = used
            used += 1


@leaf
def trace_way(start: int, goal: int, space: SearchSpace, cells: NDArray[np.int32]) -> int:
    """Write the last way that was found into ``cells`` (L,), as much of it from its start on as there is room for.

    Args:
        start: Of the search.
        goal: Of the search.
        space: Of the search.
        cells: Output, the start first.

    Returns:
        How many cells the whole way has.
    """
    wide = space.came.shape[1]
    count, here = 1, goal
    while here != start:
        step = space.came[here // wide, here % wide]
        here -= _ROWS[step] * wide + _COLUMNS[step]
        count += 1
    here = goal
    for k in range(count - 1, -1, -1):
        if k < len(cells):
            cells[k] = here
        if k:
            step = space.came[here // wide, here % wide]
            here -= _ROWS[step] * wide + _COLUMNS[step]
    return count
