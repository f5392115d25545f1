"""The published map: an occupancy grid that counts, for every cell, how many scans ended in it and passed it.

A scan counts a cell once, however many of its beams went that way (as OctoMap does): the beams of one scan err
together, and near the robot hundreds of them share a cell. A scan that was traced can be taken back exactly, since the
counts are integers: when another particle turns out to be the best, only the scans in which its past differs are traced
anew (gmapping traces its whole past instead).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.slam.scan_outline import Outlines, outline_scan

OCCUPIED_SHARE = 0.25
"""A cell is occupied where more than this share of what reached it ended there (gmapping's threshold)."""


class OccupancyMaps(NamedTuple):
    """Occupancy grids of a batch, ``(worlds, rows, columns)``, row 0 at the smallest y.

    Attributes:
        visits: (worlds, rows, columns) int32: how often a cell was seen free or hit.
        hits: (worlds, rows, columns) int32: how often a beam ended in it.
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
    outlines: Outlines,
    s: int,
) -> None:
    """Trace a scan into a world's map, or take it back.

    A beam without return frees the cells up to ``max_range``.

    Args:
        maps: The grids.
        world: Which one.
        resolution: [m].
        pose: (3,) where the scan was taken.
        scan: (beams,) ranges [m]; a beam of range 0 says nothing.
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: Ranges from here on are no returns [m].
        sign: +1 traces, -1 takes back what +1 traced with the same arguments.
        outlines: Room to work in, as given by ``empty_outlines`` for these grids and this lidar.
        s: Which row of it.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    u = (pose[0] - maps.origin[world, 0]) / resolution
    v = (pose[1] - maps.origin[world, 1]) / resolution
    outline_scan(outlines, s, maps.visits.shape[2], u, v, cos, sin, resolution, scan, directions, max_range)
    visits, hits, occupancy = maps.visits[world], maps.hits[world], maps.occupancy[world]
    wanted = maps.wanted[maps.plan[world]]
    heads, crossings, reaches = outlines.heads[s], outlines.crossings[s], outlines.reaches[s]
    change = 0
    for r in range(heads.shape[0]):
        k = heads[r]
        heads[r] = -1
        while k >= 0:
            other = crossings[k, 1]
            change += _pass_run(visits[r], hits[r], occupancy[r], wanted[r], crossings[k, 0], crossings[other, 0], sign)
            k = crossings[other, 1]
    last_r = last_c = -1
    for k in range(scan.shape[0]):
        du, dv = directions[0, k] * cos - directions[1, k] * sin, directions[0, k] * sin + directions[1, k] * cos
        reach, spoken = min(np.float64(scan[k]), max_range) / resolution, max(reaches[k, 0], reaches[k, 1])
        r, c = math.floor(v + reach * dv), math.floor(u + reach * du)
        if spoken < reach - 1.0:
            change += _pass_line(visits, hits, occupancy, wanted, u, v, du, dv, spoken, r, c, sign)
        inside = 0 <= c < visits.shape[1] and 0 <= r < visits.shape[0]
        if 0.0 < scan[k] < max_range and inside and (r != last_r or c != last_c):
            hits[np.uint64(r), np.uint64(c)] += sign
            change += _pass(visits, hits, occupancy, wanted, r, c, sign)
            last_r, last_c = r, c
    maps.covered[world] += change


@leaf
def _pass_run(
    visits: NDArray[np.int32],
    hits: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    wanted: NDArray[np.uint8],
    first: int,
    last: int,
    sign: int,
) -> int:
    """Count cells first … last - 1 of a row as passed; returns the change in covered cells. Free of branches."""
    change = 0
    for c in range(np.uint64(first), np.uint64(last)):
        before = visits[c]
        now = np.int32(before + sign)
        visits[c] = now
        occupancy[c] = np.int8(-1 if now == 0 else 100 if 4 * hits[c] > now else 0)
        change += wanted[c] * ((now > 0) - (before > 0))
    return change


@inlined
def _pass(
    visits: NDArray[np.int32],
    hits: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    wanted: NDArray[np.uint8],
    r: int,
    c: int,
    sign: int,
) -> int:
    """Count one cell as passed and set its occupancy; returns the change in covered cells."""
    row, column = np.uint64(r), np.uint64(c)
    before = visits[row, column]
    now = np.int32(before + sign)
    visits[row, column] = now
    occupancy[row, column] = np.int8(-1 if now == 0 else 100 if 4 * hits[row, column] > now else 0)
    return int(wanted[row, column] * ((now > 0) - (before > 0)))


@leaf
def _pass_line(
    visits: NDArray[np.int32],
    hits: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    wanted: NDArray[np.uint8],
    u: float,
    v: float,
    du: float,
    dv: float,
    reach: float,
    r1: int,
    c1: int,
    sign: int,
) -> int:
    """Count the cells of a beam's line from ``reach`` on up to, without, the cell (r1, c1) where it ends."""
    c0, r0 = math.floor(u + reach * du), math.floor(v + reach * dv)
    steps = max(abs(c1 - c0), abs(r1 - r0))
    change = 0
    for k in range(steps):
        c, r = c0 + (c1 - c0) * k // steps, r0 + (r1 - r0) * k // steps
        if 0 <= c < visits.shape[1] and 0 <= r < visits.shape[0]:
            change += _pass(visits, hits, occupancy, wanted, r, c, sign)
    return change
