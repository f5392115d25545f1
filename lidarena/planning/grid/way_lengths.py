"""How long the shortest ways from one place to all others are, over cells that are passable or not.

Dijkstra with buckets one cell wide (Dial 1969): no step is shorter than a cell, so that a bucket's cells are all final
when its turn comes, in whatever order. The lengths are those of ``grid_search.path_costs`` over costs of 1, to the bit,
in a tenth of the time.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel

_SQRT2 = math.sqrt(2.0)
LEG = 0.6
"""A way begins in the direction of its point so far ahead [m]."""
_RINGS = 3  # no step is longer than √2, so that cells are put into one of the next two buckets


@inlined
def _file(
    cell: int,
    new: float,
    lengths: NDArray[np.float64],
    filed: NDArray[np.int32],
    waiting: NDArray[np.int32],
    counts: NDArray[np.int64],
) -> int:
    """Note a shorter way to a cell, and put the cell into its bucket unless it is there; how many were put."""
    if new >= lengths[cell]:
        return 0
    lengths[cell] = new
    bucket = np.int32(new)
    if filed[cell] == bucket:
        return 0
    filed[cell] = bucket
    ring = bucket % _RINGS
    waiting[ring, counts[ring]] = cell
    counts[ring] += 1
    return 1


@inlined
def _spread(
    cell: int,
    wide: int,
    free: NDArray[np.bool_],
    lengths: NDArray[np.float64],
    filed: NDArray[np.int32],
    waiting: NDArray[np.int32],
    counts: NDArray[np.int64],
) -> int:
    """Go on from a cell to its free neighbours; how many cells were put into buckets."""
    put = 0
    straight, slanted = lengths[cell] + 1.0, lengths[cell] + _SQRT2
    east, west, north, south = free[cell + 1], free[cell - 1], free[cell + wide], free[cell - wide]
    if east:
        put += _file(cell + 1, straight, lengths, filed, waiting, counts)
    if west:
        put += _file(cell - 1, straight, lengths, filed, waiting, counts)
    if north:
        put += _file(cell + wide, straight, lengths, filed, waiting, counts)
        if east and free[cell + wide + 1]:
            put += _file(cell + wide + 1, slanted, lengths, filed, waiting, counts)
        if west and free[cell + wide - 1]:
            put += _file(cell + wide - 1, slanted, lengths, filed, waiting, counts)
    if south:
        put += _file(cell - wide, straight, lengths, filed, waiting, counts)
        if east and free[cell - wide + 1]:
            put += _file(cell - wide + 1, slanted, lengths, filed, waiting, counts)
        if west and free[cell - wide - 1]:
            put += _file(cell - wide - 1, slanted, lengths, filed, waiting, counts)
    return put


@kernel
def way_lengths(passable: NDArray[np.bool_], row: int, column: int) -> NDArray[np.float64]:
    """Return the length in cells of the shortest way from one cell to every other, 8 neighbours, no corners cut.

    Args:
        passable: (rows, columns) cells that may be entered.
        row: Of the cell where the ways begin; it may be impassable itself.
        column: Of it.

    Returns:
        (rows, columns): 0 where the ways begin, inf where there is none.
    """
    rows, columns = passable.shape
    wide = columns + 2  # a border of impassable cells spares asking whether a neighbour is on the grid
    free = np.zeros((rows + 2) * wide, np.bool_)
    for r in range(rows):
        for c in range(columns):
            free[(r + 1) * wide + 1 + c] = passable[r, c]
    lengths, filed = np.full(len(free), np.inf), np.full(len(free), -1, np.int32)
    waiting, counts = np.empty((_RINGS, len(free)), np.int32), np.zeros(_RINGS, np.int64)
    left = _file((row + 1) * wide + column + 1, 0.0, lengths, filed, waiting, counts)
    bucket = 0
    while left > 0:
        ring = bucket % _RINGS
        left -= counts[ring]
        for i in range(counts[ring]):
            cell = np.int64(waiting[ring, i])
            if filed[cell] != bucket:
                continue  # a shorter way was found since, which has had its turn
            left += _spread(cell, wide, free, lengths, filed, waiting, counts)
        counts[ring] = 0
        bucket += 1
    return lengths.reshape(rows + 2, wide)[1:-1, 1:-1].copy()


@kernel
def first_leg(lengths: NDArray[np.float64], row: int, column: int, length: float) -> tuple[int, int]:
    """The cell that lies ``length`` on the way to a cell, found by going back along falling ``lengths``."""
    while lengths[row, column] > length:
        best_r, best_c = row, column
        for r in range(max(row - 1, 0), min(row + 2, lengths.shape[0])):
            for c in range(max(column - 1, 0), min(column + 2, lengths.shape[1])):
                if lengths[r, c] < lengths[best_r, best_c]:
                    best_r, best_c = r, c
        if best_r == row and best_c == column:
            break  # nothing leads there
        row, column = best_r, best_c
    return row, column
