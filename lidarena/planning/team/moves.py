"""What a robot can do in one time step, and when two robots that do it come too close.

Robots are discs on the centres of cells. In a step a robot waits, moves to one of 4 or 8 neighbours, in a straight line
and at constant speed. Two robots conflict if their centres come closer than the sum of their radii at *any* time of
the step, or meet: for points (radius 0) in 4 directions that is the usual pair of vertex and swap conflicts, in 8
directions also two diagonals that cross.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined

MOVES = np.array([(0, 0), (0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1)], dtype=np.int64)
"""(9, 2) rows and columns: the wait, the four straight moves, the four diagonals."""

WAIT = 0
CLOSE = 1e-9
"""Robots that only touch do not conflict; the slack is for the rounding of squares."""


@inlined
def nearest_approach(row: float, col: float, rows: float, cols: float) -> float:
    """When two robots are nearest to each other in a step, in [0, 1].

    Args:
        row: Where one is, seen from the other, at the step's beginning [cells].
        col: As ``row``.
        rows: How much that changes in the step [cells].
        cols: As ``rows``.
    """
    square = rows * rows + cols * cols
    if square == 0.0:
        return 0.0
    return min(max(-(row * rows + col * cols) / square, 0.0), 1.0)


@inlined
def too_close(row: float, col: float, rows: float, cols: float, apart: float) -> bool:
    """Whether two robots conflict in a step.

    Args:
        row: Where one is, seen from the other, at the step's beginning [cells].
        col: As ``row``.
        rows: How much that changes in the step [cells].
        cols: As ``rows``.
        apart: Sum of the two radii [cells].
    """
    when = nearest_approach(row, col, rows, cols)
    dr, dc = row + when * rows, col + when * cols
    return dr * dr + dc * dc < max(apart * apart - 1e-9, 1e-9)


def _conflicting_bits(move: int, apart: float, connectivity: int) -> NDArray[np.int64]:
    """Bits of the other's moves that conflict with ``move``, (2 r + 1, 2 r + 1) by where the other one stands."""
    reach = math.ceil(apart) + 2
    offsets = np.arange(-reach, reach + 1, dtype=np.float64)
    bits = np.zeros((len(offsets), len(offsets)), np.int64)
    for other in range(connectivity + 1):
        rows, cols = (MOVES[other] - MOVES[move]).astype(np.float64)
        square = max(rows * rows + cols * cols, CLOSE)
        along = -(offsets[:, None] * rows + offsets[None, :] * cols) / square
        when = np.clip(along, 0.0, 1.0)
        near = (offsets[:, None] + when * rows) ** 2 + (offsets[None, :] + when * cols) ** 2
        bits |= np.where(near < max(apart * apart - CLOSE, CLOSE), 1 << other, 0)
    return bits


def conflicting_moves(apart: float, connectivity: int) -> dict[int, dict[tuple[int, int], int]]:
    """For each move of one robot: which moves of another conflict with it, by where the other one stands.

    Args:
        apart: Sum of the two radii [cells].
        connectivity: 4 or 8 neighbours.

    Returns:
        ``{move: {(row, column) of the other's cell seen from the robot's: bits of the other's moves}}``.
    """
    table: dict[int, dict[tuple[int, int], int]] = {}
    for move in range(connectivity + 1):
        bits = _conflicting_bits(move, apart, connectivity)
        reach = len(bits) // 2
        table[move] = {(int(r) - reach, int(c) - reach): int(bits[r, c]) for r, c in np.argwhere(bits)}
    return table


def footprints(apart: float, connectivity: int, stride: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """``conflicting_moves`` as arrays for kernels.

    Args:
        apart: Sum of the two radii [cells].
        connectivity: 4 or 8 neighbours.
        stride: Columns of the padded grid in which the other cell is looked up.

    Returns:
        Where each move's entries begin and the last's end (connectivity + 2,); entries (n, 3): offset in the flattened
        padded grid, bits of the moves, and a one for each of them in its four bits of ``search_arrays.Reservations``.
    """
    parts = []
    for move in range(connectivity + 1):
        bits = _conflicting_bits(move, apart, connectivity)
        rows, cols = np.nonzero(bits)
        reach = len(bits) // 2
        ones = sum((bits[rows, cols] >> m & 1) << 4 * m for m in range(9))
        parts.append(np.stack([(rows - reach) * stride + cols - reach, bits[rows, cols], ones], axis=1))
    begins = np.cumsum([0, *(len(part) for part in parts)]).astype(np.int64)
    return begins, np.concatenate(parts).astype(np.int64)
