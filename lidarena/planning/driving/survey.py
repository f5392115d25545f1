"""From maps and scans to the grids that drivers plan on: what is near a robot, and all that is known."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.planning.driving.state import (
    ESCAPE,
    INFLATED,
    LETHAL,
    NEAR_HITS,
    NEARBY,
    Drive,
    DriverSettings,
    KnownGround,
    Perceptions,
)
from lidarena.planning.grid.frontiers import nearest_cell
from lidarena.planning.grid.inflation import ESCAPE_BASE, ESCAPE_SLOPE, cell_costs, cell_distances

_OCCUPIED = 50
_WEIGHT, _RATE = 5.0, 10.0  # of the inflation, as in Inflation


@kernel
def remember_hits(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> None:
    """Note where the newest scan of a world hit something nearby, in place of the oldest that is remembered."""
    slot = (drive.newest[w] + 1) % drive.hits.shape[1]
    drive.newest[w], count = slot, 0
    x, y, heading = senses.poses[w, 0], senses.poses[w, 1], senses.poses[w, 2]
    reach, longest = NEAR_HITS + settings.extra, settings.max_range
    for k in range(senses.scans.shape[1]):
        share = np.float64(senses.scans[w, k]) / longest
        if 0.0 < share < 1.0 and share * longest < reach:
            away, angle = share * longest, settings.angles[k] + heading
            drive.hits[w, slot, count, 0] = x + away * math.cos(angle)
            drive.hits[w, slot, count, 1] = y + away * math.sin(angle)
            count += 1
    drive.hit_counts[w, slot] = count


@kernel
def _fill(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive, ground: KnownGround) -> None:
    """Fill in occupancy, clearance and closed cells of a world's grid whose extent is set."""
    first_r, first_c = ground.extent[w, 0], ground.extent[w, 1]
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    cells, side = rows * columns, settings.resolution
    occupancy = ground.occupancy[w, :cells].reshape(rows, columns)
    occupancy[:] = senses.maps[w, first_r : first_r + rows, first_c : first_c + columns]
    x, y = senses.origin[w, 0] + first_c * side, senses.origin[w, 1] + first_r * side
    ground.frame[w, 0], ground.frame[w, 1], ground.frame[w, 2] = x, y, side
    for slot in range(drive.hits.shape[1]):
        for i in range(drive.hit_counts[w, slot]):
            c = math.floor((drive.hits[w, slot, i, 0] - x) / side)
            r = math.floor((drive.hits[w, slot, i, 1] - y) / side)
            if 0 <= r < rows and 0 <= c < columns:
                occupancy[r, c] = 100
    reach = math.ceil((INFLATED + settings.extra + side) / side)
    distance = cell_distances(occupancy, _OCCUPIED, reach).reshape(cells)
    for k in range(cells):
        ground.gap[w, k] = max((distance[k] - np.float32(0.5)) * np.float32(side), np.float32(0.0))
        ground.closed[w, k] = ground.occupancy[w, k] < 0 or ground.occupancy[w, k] >= _OCCUPIED


@kernel
def look_around(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> None:
    """Fill in the window around the robot of a world."""
    near, side = drive.near, settings.resolution
    row = int((senses.poses[w, 1] - senses.origin[w, 1]) / side)
    column = int((senses.poses[w, 0] - senses.origin[w, 0]) / side)
    half = math.ceil((NEARBY + settings.extra) / side)
    for axis, centre in ((0, row), (1, column)):
        size = senses.maps.shape[1 + axis]
        first = min(max(centre - half, 0), size - 1)
        near.extent[w, axis] = first
        near.extent[w, 2 + axis] = max(min(centre + half + 1, size), first + 1) - first
    _fill(w, senses, settings, drive, near)


@kernel
def survey(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Fill in the ground of a world, ready for planning; whether anything is known."""
    ground, side = drive.ground, settings.resolution
    if not _crop(senses.maps[w], ground.extent[w]):
        return False
    _fill(w, senses, settings, drive, ground)
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    cells, frame = rows * columns, ground.frame[w]
    row = min(max(math.floor((senses.poses[w, 1] - frame[1]) / side), 0), rows - 1)
    column = min(max(math.floor((senses.poses[w, 0] - frame[0]) / side), 0), columns - 1)
    ground.cell[w, 0], ground.cell[w, 1] = row, column
    occupancy = ground.occupancy[w, :cells].reshape(rows, columns)
    gap = ground.gap[w, :cells].reshape(rows, columns)
    cost = ground.cost[w, :cells].reshape(rows, columns)
    lethal, inflated = LETHAL + settings.extra, INFLATED + settings.extra
    cost[:] = cell_costs(occupancy, gap, lethal, inflated, _WEIGHT, _RATE, False, _OCCUPIED)
    if not math.isfinite(cost[row, column]):
        _open(cost, occupancy, gap, row, column, math.ceil((ESCAPE + settings.extra) / side), lethal)
    _connect(cost, row, column, ground.reachable[w, :cells].reshape(rows, columns))
    return True


@kernel
def _crop(grid: NDArray[np.int8], extent: NDArray[np.int64]) -> bool:
    """The lines that contain anything known, and one more on either side for the frontiers."""
    rows, columns = grid.shape
    top, bottom, left, right = rows, -1, columns, -1
    for r in range(rows):
        for c in range(columns):
            if grid[r, c] >= 0:
                top, bottom, left, right = min(top, r), r, min(left, c), max(right, c)
    if bottom < 0:
        extent[:] = 0
        return False
    extent[0], extent[1] = max(top - 1, 0), max(left - 1, 0)
    extent[2], extent[3] = min(bottom + 2, rows) - extent[0], min(right + 2, columns) - extent[1]
    return True


@kernel
def _open(
    cost: NDArray[np.float64],
    occupancy: NDArray[np.int8],
    gap: NDArray[np.float32],
    row: int,
    column: int,
    reach: int,
    lethal: float,
) -> None:
    """Let a robot out that stands in the lethal zone; see ``inflation.open_start``."""
    for r in range(max(row - reach, 0), min(row + reach + 1, cost.shape[0])):
        for c in range(max(column - reach, 0), min(column + reach + 1, cost.shape[1])):
            if math.isinf(cost[r, c]) and 0 <= occupancy[r, c] < _OCCUPIED:
                depth = max(lethal - np.float64(gap[r, c]), 0.0) / max(lethal, 1e-9)
                cost[r, c] = 1.0 + _WEIGHT * (ESCAPE_BASE + ESCAPE_SLOPE * depth)


@kernel
def _connect(cost: NDArray[np.float64], row: int, column: int, reachable: NDArray[np.bool_]) -> None:
    """Mark the cells connected with a cell, or with the passable cell nearest to it; all passable ones without any."""
    rows, columns = cost.shape
    passable = np.empty((rows, columns), np.bool_)
    for r in range(rows):
        for c in range(columns):
            passable[r, c] = cost[r, c] < np.inf
            reachable[r, c] = False
    r, c = nearest_cell(passable, float(row), float(column))
    if r < 0:
        return
    queue = np.empty((rows * columns, 2), np.int32)
    queue[0, 0], queue[0, 1], reachable[r, c] = r, c, True
    head, tail = 0, 1
    while head < tail:
        r, c = queue[head, 0], queue[head, 1]
        head += 1
        for dr, dc in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            y, x = r + dr, c + dc
            if 0 <= y < rows and 0 <= x < columns and passable[y, x] and not reachable[y, x]:
                reachable[y, x] = True
                queue[tail, 0], queue[tail, 1] = y, x
                tail += 1
