"""The occupancy grid of a log's scans, traced part by part, and how well the scans agree on it.

A building is traced in square parts, each with the scans that reach into it: counting takes memory for one part at a
time, however far apart the ends of the building lie, and the result is the same as in one piece but for rounding.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaln

from lidarena.slam.logs.recorded_log import RecordedLog
from lidarena.slam.occupancy import OccupancyMaps, empty_maps, trace_scan
from lidarena.slam.planar import compose
from lidarena.slam.rbpf.likelihood_field import CELL
from lidarena.slam.scan_outline import empty_outlines
from lidarena.world.extent import MAX_DRAWN_CELLS, check_extent
from lidarena.world.map_server import OccupancyMap

USABLE_RANGE = 20.0
"""Ranges beyond this are only known to be free up to here [m]."""
_PART = 1024
"""Side of a part [cells]."""
_ENTER = np.int64(1)
_HALF = 0.5
"""Jeffreys's prior of a cell's probability to stop a beam."""


@dataclass(frozen=True)
class TracedMap:
    """A map and how much speaks for it.

    Attributes:
        grid: The map, cut to what is known.
        evidence: Logarithm of the probability of what the scans say of the cells, if each cell stops beams with a
            probability of its own that nobody knows (Jeffreys's prior): Σ ln B(h + ½, f + ½) / B(½, ½) over cells that
            were hit in h scans and passed in f [nat]. Walls that stand twice cost twice; scans through each other's
            walls, as in a folded map, cost most.
    """

    grid: OccupancyMap
    evidence: float


def informative_ranges(log: RecordedLog) -> NDArray[np.float32]:
    """Ranges (S, B) in which a beam without return is 0, which says nothing: glass returns none either."""
    limit = log.max_range * (1.0 - 1e-4)
    return np.where(log.ranges < limit, log.ranges, np.float32(0.0)).astype(np.float32)


def laser_odometry(log: RecordedLog) -> NDArray[np.float64]:
    """(R, 3) where the laser is by the wheels alone."""
    return compose(log.odometry, np.broadcast_to(log.mount, log.odometry.shape))


def beam_directions(log: RecordedLog) -> NDArray[np.float64]:
    """(2, B) cos and sin of the beams' angles."""
    return np.stack([np.cos(log.angles), np.sin(log.angles)])


def trace_map(
    log: RecordedLog,
    scans: NDArray[np.int64],
    poses: NDArray[np.float64],
    reach: float = USABLE_RANGE,
    resolution: float = CELL,
) -> OccupancyMap:
    """The grid alone; see ``traced``."""
    return traced(log, scans, poses, reach, resolution).grid


def traced(
    log: RecordedLog,
    scans: NDArray[np.int64],
    poses: NDArray[np.float64],
    reach: float = USABLE_RANGE,
    resolution: float = CELL,
    part: int = _PART,
) -> TracedMap:
    """Trace scans into an occupancy grid.

    Args:
        log: Where they are from.
        scans: (K,) which scans.
        poses: (K, 3) where the laser was.
        reach: Ranges beyond this are only known to be free up to here [m].
        resolution: Side of a cell [m].
        part: Side of the parts that are traced one by one [cells].

    Raises:
        MapError: They are too far apart for a map.
    """
    low = resolution * np.floor((poses[:, :2].min(axis=0) - reach) / resolution - 1.0)
    columns, rows = (int(n) for n in np.ceil((poses[:, :2].max(axis=0) + reach - low) / resolution) + 1)
    check_extent(f"the map of log {log.name!r}", rows, columns, resolution, MAX_DRAWN_CELLS)
    whole = np.full((rows, columns), -1, np.int8)
    ranges, directions = informative_ranges(log)[scans], beam_directions(log)
    cells, evidence = (poses[:, :2] - low) / resolution, 0.0
    side = reach / resolution + 2.0
    for row in range(0, rows, part):
        for column in range(0, columns, part):
            height, width = min(part, rows - row), min(part, columns - column)
            middle, half = np.array([column + width / 2, row + height / 2]), np.array([width, height]) / 2
            near = np.flatnonzero(np.all(np.abs(cells - middle) < half + side, axis=1))
            if not len(near):
                continue
            maps = empty_maps(1, np.zeros((1, height, width), np.uint8))
            maps.origin[0] = low + resolution * np.array([column, row])
            outlines = empty_outlines(1, height, len(log.angles), reach, resolution)
            for k in near:
                trace_scan(maps, 0, resolution, poses[k], ranges[k], directions, reach, _ENTER, outlines, 0)
            whole[row : row + height, column : column + width] = maps.occupancy[0]
            evidence += _evidence(maps)
    return TracedMap(_cropped(whole, low, resolution), evidence)


def _evidence(maps: OccupancyMaps) -> float:
    """Of the cells of one world; see ``TracedMap``."""
    seen = maps.visits[0] > 0
    hits, visits = maps.hits[0][seen], maps.visits[0][seen]
    hits = np.minimum(hits, visits)  # a cell that two beams of a scan hit, with others between, is passed once
    kinds, counts = np.unique(hits.astype(np.int64) * (int(visits.max(initial=0)) + 1) + visits, return_counts=True)
    h, v = np.divmod(kinds, int(visits.max(initial=0)) + 1)
    return float(np.sum(counts * (betaln(h + _HALF, v - h + _HALF) - math.log(math.pi))))


def _cropped(grid: NDArray[np.int8], origin: NDArray[np.float64], resolution: float) -> OccupancyMap:
    """Cut off the unknown borders of a grid except one cell; an unknown grid becomes one unknown cell."""
    rows, columns = np.flatnonzero((grid >= 0).any(axis=1)), np.flatnonzero((grid >= 0).any(axis=0))
    if not len(rows):
        return OccupancyMap(np.full((1, 1), -1, np.int8), resolution, (float(origin[0]), float(origin[1]), 0.0))
    bottom, left = max(int(rows[0]) - 1, 0), max(int(columns[0]) - 1, 0)
    cut = grid[bottom : int(rows[-1]) + 2, left : int(columns[-1]) + 2]
    x, y = float(origin[0]) + left * resolution, float(origin[1]) + bottom * resolution
    return OccupancyMap(cut.copy(), resolution, (x, y, 0.0))
