"""The area that a scan saw free, as runs of cells row by row: a polygon instead of hundreds of overlapping lines.

Neighbouring beams clear the gap between them up to the shorter one's end and as long as the gap is narrower than
``GAP``; where they end on the same surface, up to the line between their ends. What a beam saw beyond that is a line
(``occupancy.trace_scan`` walks it).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

GAP = 0.1
"""Widest gap between two beams that counts as seen [m]."""
SURFACE = 0.2
"""Two neighbouring beams end on the same surface where their ranges differ by no more than this [m]."""


class Outlines(NamedTuple):
    """Room for the outlines of scans, a row for each thread that traces at a time.

    Attributes:
        heads: (W, rows) int32: each row's first crossing, -1 for none.
        crossings: (W, capacity, 2) int32: a crossing's column (the first cell whose centre lies behind it) and the next
            crossing of its row, -1 for none; by ascending column.
        reaches: (W, beams, 2) how far each beam clears the gaps on its right and on its left [cells].
    """

    heads: NDArray[np.int32]
    crossings: NDArray[np.int32]
    reaches: NDArray[np.float64]


def empty_outlines(worlds: int, rows: int, beams: int, max_range: float, resolution: float) -> Outlines:
    """Room for ``worlds`` outlines in grids of so many rows; memory is taken up only as it is used."""
    edge = math.ceil((SURFACE + 2.0 * GAP) / resolution) + 2  # rows that the edge between two beams crosses at most
    radius = math.ceil(max_range / resolution) + 2
    return Outlines(
        np.full((worlds, rows), -1, np.int32),
        np.zeros((worlds, beams * (edge + radius), 2), np.int32),
        np.zeros((worlds, beams, 2)),
    )


@leaf
def outline_scan(
    outlines: Outlines,
    s: int,
    columns: int,
    u: float,
    v: float,
    cos: float,
    sin: float,
    resolution: float,
    scan: NDArray[np.float32],
    directions: NDArray[np.float64],
    max_range: float,
) -> None:
    """Enter the outline of a scan into row ``s`` of ``outlines``, whose heads are all -1, and the beams' reaches.

    Args:
        outlines: Where to.
        s: Which row.
        columns: Of the grid.
        u: Column of the sensor, in cells and fractions.
        v: Its row.
        cos: Of its heading.
        sin: Of its heading.
        resolution: [m].
        scan: (beams,) ranges [m].
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: Ranges from here on are no returns [m].
    """
    heads, crossings, reaches = outlines.heads[s], outlines.crossings[s], outlines.reaches[s]
    beams, per_cell = scan.shape[0], 1.0 / resolution
    _find_reaches(scan, directions, max_range, per_cell, reaches)
    used = int(np.int64(0))  # a plain 0 would be a type of its own, compiled apart
    before_u, before_v = _end(u, v, cos, sin, directions, beams - 1, reaches[beams - 1, 1])
    for k in range(beams):
        right_u, right_v = _end(u, v, cos, sin, directions, k, reaches[k, 0])
        left_u, left_v = _end(u, v, cos, sin, directions, k, reaches[k, 1])
        used = _add_edge(heads, crossings, used, columns, before_u, before_v, right_u, right_v)
        used = _add_edge(heads, crossings, used, columns, right_u, right_v, left_u, left_v)
        before_u, before_v = left_u, left_v


@leaf
def _find_reaches(
    scan: NDArray[np.float32],
    directions: NDArray[np.float64],
    max_range: float,
    per_cell: float,
    reaches: NDArray[np.float64],
) -> None:
    """How far each beam clears the gap on its right and on its left (beams, 2) [cells]."""
    last = scan.shape[0] - 1
    a, ax, ay = min(np.float64(scan[last]), max_range), directions[0, last], directions[1, last]
    for k in range(scan.shape[0]):
        b, bx, by = min(np.float64(scan[k]), max_range), directions[0, k], directions[1, k]
        cross = ax * by - ay * bx  # sine of the angle between them
        widest = GAP / cross if cross > 1e-9 and ax * bx + ay * by > 0.0 else 0.0
        shorter = min(a, b, widest)
        same = abs(a - b) <= SURFACE
        reaches[k - 1 if k > 0 else last, 1] = per_cell * (min(a, widest) if same else shorter)
        reaches[k, 0] = per_cell * (min(b, widest) if same else shorter)
        a, ax, ay = b, bx, by


@inlined
def _end(
    u: float, v: float, cos: float, sin: float, directions: NDArray[np.float64], k: int, reach: float
) -> tuple[float, float]:
    """Where beam ``k`` is after ``reach`` cells; the sensor itself after none, to the bit."""
    dx, dy = directions[0, k], directions[1, k]
    return u + reach * (dx * cos - dy * sin), v + reach * (dx * sin + dy * cos)


@inlined
def _add_edge(
    heads: NDArray[np.int32],
    crossings: NDArray[np.int32],
    used: int,
    columns: int,
    u1: float,
    v1: float,
    u2: float,
    v2: float,
) -> int:
    """Enter where an edge crosses the rows' middles; returns how many crossings are used now.

    Rows are half open, so that a corner between two edges is counted once and every row is crossed an even number of
    times.
    """
    if v1 > v2:
        u1, v1, u2, v2 = u2, v2, u1, v1
    first, last = max(math.ceil(v1 - 0.5), 0), min(math.ceil(v2 - 0.5), heads.shape[0])
    if first >= last:
        return used
    slope = (u2 - u1) / (v2 - v1)
    for r in range(first, last):
        c = np.int32(min(max(math.ceil(u1 + (r + 0.5 - v1) * slope - 0.5), 0), columns))
        after, before = heads[r], -1
        while after >= 0 and crossings[after, 0] < c:
            before, after = after, crossings[after, 1]
        crossings[used, 0], crossings[used, 1] = c, after
        if before < 0:
            heads[r] = used
        else:
            crossings[before, 1] = used
        used += 1
    return used
