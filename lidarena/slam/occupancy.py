"""The published map: an occupancy grid that counts, for every cell, how often beams ended in it and passed it.

A scan that was traced can be taken back exactly, since the counts are integers: when another particle turns out to be
the best, only the scans in which its past differs are traced anew (gmapping traces its whole past instead).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.world.kernels import inlined, leaf

OCCUPIED_SHARE = 0.25
"""A cell is occupied where more than this share of the beams that reached it ended there (gmapping's threshold)."""
_ONE = 1 << 16  # fixed-point unit of the ray's steps


class OccupancyMaps(NamedTuple):
    """Occupancy grids of a batch, ``(worlds, rows, columns)``, row 0 at the smallest y.

    Attributes:
        visits: (worlds, rows, columns) int32: beams that reached a cell, times two, plus one where the cell is
            occupied. (With that bit the innermost loop knows from a single number that a cell stays what it is: known
            and free.)
        hits: (worlds, rows, columns) int32: beams that ended in a cell.
        occupancy: int8: -1 unknown, 0 free, 100 occupied.
        wanted: (plans, rows, columns) uint8: 1 where a known cell counts as covered, else 0.
        plan: (worlds,) which of ``wanted`` a world uses.
        covered: (worlds,) number of known cells among the wanted.
        origin: (worlds, 2) lower-left corner of each grid [m].
    """

    visits: NDArray[np.int32]
    hits: NDArray[np.int32]
    occupancy: NDArray[np.int8]
    wanted: NDArray[np.uint8]
    plan: NDArray[np.int64]
    covered: NDArray[np.int64]
    origin: NDArray[np.float64]


def empty_maps(worlds: int, wanted: NDArray[np.uint8]) -> OccupancyMaps:
    """Unknown maps for ``worlds`` worlds, as large as ``wanted`` (plans, rows, columns)."""
    rows, columns = wanted.shape[1:]
    return OccupancyMaps(
        np.zeros((worlds, rows, columns), np.int32),
        np.zeros((worlds, rows, columns), np.int32),
        np.full((worlds, rows, columns), -1, np.int8),
        wanted,
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros((worlds, 2)),
    )


def clear_map(maps: OccupancyMaps, world: int, plan: int, origin: NDArray[np.float64]) -> None:
    """Forget everything that one world's map knows."""
    maps.visits[world] = 0
    maps.hits[world] = 0
    maps.occupancy[world] = -1
    maps.plan[world] = plan
    maps.covered[world] = 0
    maps.origin[world] = origin


@leaf
def trace_scan(
    maps: OccupancyMaps,
    world: int,
    resolution: float,
    pose: NDArray[np.float64],
    scan: NDArray[np.float32],
    directions: NDArray[np.float64],
    max_range: float,
    sign: int,
) -> None:
    """Trace a scan's beams into a world's map, or take them back.

    A beam without return frees the cells up to ``max_range``.

    Args:
        maps: The grids.
        world: Which one.
        resolution: [m].
        pose: (3,) where the scan was taken.
        scan: (beams,) ranges [m].
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: Ranges from here on are no returns [m].
        sign: +1 traces, -1 takes back what +1 traced with the same arguments.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    start_u = (pose[0] - maps.origin[world, 0]) / resolution
    start_v = (pose[1] - maps.origin[world, 1]) / resolution
    visits, hits, occupancy = maps.visits[world], maps.hits[world], maps.occupancy[world]
    wanted = maps.wanted[maps.plan[world]]
    rows, columns = occupancy.shape
    c0, r0 = math.floor(start_u), math.floor(start_v)
    inside = 0 <= c0 < columns and 0 <= r0 < rows
    change = 0
    for k in range(scan.shape[0]):
        reach = min(scan[k], max_range) / resolution
        c1 = math.floor(start_u + reach * (directions[0, k] * cos - directions[1, k] * sin))
        r1 = math.floor(start_v + reach * (directions[0, k] * sin + directions[1, k] * cos))
        if inside and 0 <= c1 < columns and 0 <= r1 < rows:
            change += _pass_cells(visits, hits, occupancy, wanted, c0, r0, c1, r1, sign)
            visits[r1, c1] += 2 * sign
            hits[r1, c1] += sign if scan[k] < max_range else 0
            change += _reassess(visits, hits, occupancy, wanted, r1, c1)
        else:
            change += _pass_clipped(visits, hits, occupancy, wanted, c0, r0, c1, r1, sign)
    maps.covered[world] += change


@inlined
def _pass_cells(
    visits: NDArray[np.int32],
    hits: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    wanted: NDArray[np.uint8],
    c0: int,
    r0: int,
    c1: int,
    r1: int,
    sign: int,
) -> int:
    """Count a beam in every cell of the line from (r0, c0) up to, without, (r1, c1), both inside the grid.

    The innermost loop of all: one step along the longer axis, in fixed point, free of tests that fit outside.
    """
    dc, dr = c1 - c0, r1 - r0
    steps = max(abs(dc), abs(dr))
    if steps == 0:
        return 0
    u, v = c0 * _ONE + _ONE // 2, r0 * _ONE + _ONE // 2
    scale = _ONE / steps
    step_u, step_v = int(dc * scale), int(dr * scale)
    change = 0
    for _ in range(steps):
        c, r = np.uint64(u >> 16), np.uint64(v >> 16)
        u, v = u + step_u, v + step_v
        before = visits[r, c]
        visits[r, c] = before + 2 * sign
        if sign < 0 or before < 2 or before & 1:  # one more passing beam leaves a free cell free
            change += _reassess(visits, hits, occupancy, wanted, np.int64(r), np.int64(c))
    return change


@leaf
def _pass_clipped(
    visits: NDArray[np.int32],
    hits: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    wanted: NDArray[np.uint8],
    c0: int,
    r0: int,
    c1: int,
    r1: int,
    sign: int,
) -> int:
    """The same for a line that leaves the grid: only its cells inside count."""
    steps = max(abs(c1 - c0), abs(r1 - r0))
    change = 0
    for k in range(steps):
        c, r = c0 + (c1 - c0) * k // steps, r0 + (r1 - r0) * k // steps
        if 0 <= c < occupancy.shape[1] and 0 <= r < occupancy.shape[0]:
            visits[r, c] += 2 * sign
            change += _reassess(visits, hits, occupancy, wanted, r, c)
    return change


@leaf
def _reassess(
    visits: NDArray[np.int32],
    hits: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    wanted: NDArray[np.uint8],
    r: int,
    c: int,
) -> int:
    """Set a cell's occupancy from its counts and return the change in covered cells."""
    reached, was_known = visits[r, c] >> 1, occupancy[r, c] >= 0
    occupied = hits[r, c] > OCCUPIED_SHARE * reached
    visits[r, c] = 2 * reached + (1 if occupied else 0)
    occupancy[r, c] = -1 if reached == 0 else 100 if occupied else 0
    if was_known == (reached > 0):
        return 0
    return -int(np.int64(wanted[r, c])) if was_known else int(np.int64(wanted[r, c]))
