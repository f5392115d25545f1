"""What of a grid is connected with a cell, and the rectangle that is known, in one pass over the grid each."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel


@kernel
def connected_cells(passable: NDArray[np.bool_], row: int, col: int) -> NDArray[np.bool_]:
    """The cells (rows, cols) that 4-neighbour steps through passable ones connect with a passable cell.

    Whole runs of a row are taken at a time, which is several times as fast as labelling all parts of a large map.
    """
    rows, cols = passable.shape
    seen = np.zeros((rows, cols), np.bool_)
    # runs of neighbouring rows that touch are pushed once from either side, and a row has at most every second cell
    stack = np.empty(2 * (rows + 1) * (cols + 2), np.int32)
    stack[0], height = row * cols + col, 1
    while height > 0:
        height -= 1
        r, c = stack[height] // cols, stack[height] % cols
        if seen[r, c]:
            continue
        left, right = c, c + 1
        while left > 0 and passable[r, left - 1]:
            left -= 1
        while right < cols and passable[r, right]:
            right += 1
        for k in range(left, right):
            seen[r, k] = True
        for beside in (r - 1, r + 1):
            if 0 <= beside < rows:
                inside = False
                for k in range(left, right):
                    new = passable[beside, k] and not seen[beside, k]
                    if new and not inside:
                        stack[height] = beside * cols + k
                        height += 1
                    inside = new
    return seen


@kernel
def known_extent(occupancy: NDArray[np.int8]) -> tuple[int, int, int, int]:
    """First row, row after the last, first column, column after the last with a known cell; zeros if none is known."""
    rows, cols = occupancy.shape
    top, bottom, left, right = rows, 0, cols, 0
    for r in range(rows):
        first = 0
        while first < cols and occupancy[r, first] < 0:
            first += 1
        if first == cols:
            continue
        last = cols - 1
        while occupancy[r, last] < 0:
            last -= 1
        top, bottom = min(top, r), r + 1
        left, right = min(left, first), max(right, last + 1)
    return (top, bottom, left, right) if bottom else (0, 0, 0, 0)
