"""From maps and scans to the grids that drivers plan on: what is near a robot, and all that is known."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel, leaf, merged_kernel
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
from lidarena.planning.grid.guard import GUARDED, carried, nearby
from lidarena.planning.grid.inflation import ESCAPE_BASE, ESCAPE_SLOPE, cost_at, squared_distances
from lidarena.planning.grid.steering import move
from lidarena.planning.grid.way_lengths import way_lengths

_OCCUPIED = 50
_WEIGHT, _RATE = 5.0, 10.0  # of the inflation, as in Inflation


@merged_kernel
def remember_hits(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> bool:
    """Note where the newest scan of a world hit something nearby, in place of the oldest; whether it is a new one."""
    if drive.given[w] >= 0:
        move(drive.reckoned[w], settings.commands.moves[drive.given[w]])
        drive.given[w] = -1
    slot = (drive.newest[w] + 1) % drive.hits.shape[1]
    drive.newest[w], count = slot, 0
    drive.hit_counts[w, slot] = 0
    total = 0.0
    for k in range(senses.scans.shape[1]):
        total += np.float64(senses.scans[w, k])
    if total == drive.scan_sum[w]:
        return False  # a slow lidar's scan of before
    drive.scan_sum[w], drive.scanned[w] = total, drive.reckoned[w]
    x, y, heading = drive.reckoned[w, 0], drive.reckoned[w, 1], drive.reckoned[w, 2]
    reach, longest = NEAR_HITS + settings.extra, settings.max_range
    for k in range(senses.scans.shape[1]):
        share = np.float64(senses.scans[w, k]) / longest
        if 0.0 < share < 1.0 and share * longest < reach:
            away, angle = share * longest, settings.angles[k] + heading
            drive.hits[w, slot, count, 0] = x + away * math.cos(angle)
            drive.hits[w, slot, count, 1] = y + away * math.sin(angle)
            count += 1
    drive.hit_counts[w, slot] = count
    return True


@merged_kernel
def points_around(w: int, senses: Perceptions, settings: DriverSettings, drive: Drive) -> NDArray[np.float64]:
    """What a world's robot must keep clear of, (n, 2) in its own frame [m]: what beams have hit.

    Where they do not see all that is near, also what is occupied in the window around it.
    """
    angles, longest = settings.angles, settings.max_range
    near, count = np.empty((len(angles) + drive.hits.shape[1] * drive.hits.shape[2], 2)), 0
    for k in range(len(angles)):
        away = np.float64(senses.scans[w, k])
        if 0.0 < away < min(longest, GUARDED):
            near[count, 0], near[count, 1] = away * math.cos(angles[k]), away * math.sin(angles[k])
            count += 1
    near[:count] = carried(near[:count], np.zeros(3), drive.scanned[w])
    for slot in range(drive.hits.shape[1]):
        if slot != drive.newest[w]:
            end = count + drive.hit_counts[w, slot]
            near[count:end] = drive.hits[w, slot, : drive.hit_counts[w, slot]]
            count = end
    points = nearby(near[:count], drive.reckoned[w])
    return points if settings.all_around else np.concatenate((points, _occupied_around(w, senses, drive)))


@merged_kernel
def _occupied_around(w: int, senses: Perceptions, drive: Drive) -> NDArray[np.float64]:
    rows, columns, frame = drive.near.extent[w, 2], drive.near.extent[w, 3], drive.near.frame[w]
    found, count = np.empty((rows * columns, 2)), 0
    for k in range(rows * columns):
        if drive.near.occupancy[w, k] >= _OCCUPIED:
            found[count, 0] = (k % columns + 0.5) * frame[2] + frame[0]
            found[count, 1] = (k // columns + 0.5) * frame[2] + frame[1]
            count += 1
    return nearby(found[:count], senses.poses[w])


@inlined
def _reach(settings: DriverSettings) -> int:
    """How far clearances matter, in cells."""
    return math.ceil((INFLATED + settings.extra + settings.resolution) / settings.resolution)


@inlined
def _gap_of(square: np.int32, side: float) -> np.float32:
    """Clearance [m] of a cell so far from what is occupied."""
    return max((np.sqrt(np.float32(square)) - np.float32(0.5)) * np.float32(side), np.float32(0.0))


@leaf
def _fill_gaps(
    squares: NDArray[np.int32],
    occupancy: NDArray[np.int8],
    side: float,
    gap: NDArray[np.float32],
    closed: NDArray[np.bool_],
) -> None:
    for k in range(len(squares)):
        gap[k] = _gap_of(squares[k], side)
        closed[k] = occupancy[k] < 0 or occupancy[k] >= _OCCUPIED


@merged_kernel
def _fill(
    w: int, senses: Perceptions, settings: DriverSettings, drive: Drive, ground: KnownGround
) -> NDArray[np.int32]:
    """Fill in occupancy, clearance and closed cells of a world's grid whose extent is set.

    Returns:
        (cells,) squared distances to what is occupied, in cells, as far as it matters.
    """
    first_r, first_c = ground.extent[w, 0], ground.extent[w, 1]
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    cells, side = rows * columns, settings.resolution
    occupancy = ground.occupancy[w, :cells].reshape(rows, columns)
    occupancy[:] = senses.maps[w, first_r : first_r + rows, first_c : first_c + columns]
    x, y = senses.origin[w, 0] + first_c * side, senses.origin[w, 1] + first_r * side
    ground.frame[w, 0], ground.frame[w, 1], ground.frame[w, 2] = x, y, side
    for slot in range(drive.hits.shape[1]):
        hits = carried(drive.hits[w, slot, : drive.hit_counts[w, slot]], drive.reckoned[w], senses.poses[w])
        for i in range(len(hits)):
            c = math.floor((hits[i, 0] - x) / side)
            r = math.floor((hits[i, 1] - y) / side)
            if 0 <= r < rows and 0 <= c < columns:
                occupancy[r, c] = 100
    squares = squared_distances(occupancy, _OCCUPIED, _reach(settings)).reshape(cells)
    _fill_gaps(squares, ground.occupancy[w], side, ground.gap[w], ground.closed[w])
    return squares


@merged_kernel
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
    squares = _fill(w, senses, settings, drive, ground)
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    cells, frame = rows * columns, ground.frame[w]
    row = min(max(math.floor((senses.poses[w, 1] - frame[1]) / side), 0), rows - 1)
    column = min(max(math.floor((senses.poses[w, 0] - frame[0]) / side), 0), columns - 1)
    ground.cell[w, 0], ground.cell[w, 1] = row, column
    cost = ground.cost[w, :cells].reshape(rows, columns)
    _fill_costs(w, squares, settings, ground)
    if not math.isfinite(cost[row, column]):
        occupancy = ground.occupancy[w, :cells].reshape(rows, columns)
        gap = ground.gap[w, :cells].reshape(rows, columns)
        reach = math.ceil((ESCAPE + settings.extra) / side)
        _open(cost, occupancy, gap, row, column, reach, LETHAL + settings.extra)
    _connect(w, ground)
    return True


@merged_kernel
def _fill_costs(w: int, squares: NDArray[np.int32], settings: DriverSettings, ground: KnownGround) -> None:
    """Fill in what entering the cells costs: one of as many numbers as there are squared distances."""
    lethal, inflated = LETHAL + settings.extra, INFLATED + settings.extra
    costs = np.empty((_reach(settings) + 1) ** 2 + 1)
    for square in range(len(costs)):
        gap = _gap_of(np.int32(square), settings.resolution)
        costs[square] = cost_at(gap, lethal, inflated, _WEIGHT, _RATE)
    _look_up(squares, costs, ground.closed[w], ground.cost[w])


@leaf
def _look_up(
    squares: NDArray[np.int32], costs: NDArray[np.float64], closed: NDArray[np.bool_], cost: NDArray[np.float64]
) -> None:
    for k in range(len(squares)):
        cost[k] = np.inf if closed[k] else costs[squares[k]]


@merged_kernel
def _crop(grid: NDArray[np.int8], extent: NDArray[np.int64]) -> bool:
    """The lines that contain anything known, and one more on either side for the frontiers."""
    rows, columns = grid.shape
    top, bottom, left, right = rows, -1, columns, -1
    for r in range(rows):
        first = 0
        while first < columns and grid[r, first] < 0:
            first += 1
        if first == columns:
            continue
        last = columns - 1
        while grid[r, last] < 0:
            last -= 1
        top, bottom, left, right = min(top, r), r, min(left, first), max(right, last)
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


@merged_kernel
def _connect(w: int, ground: KnownGround) -> None:
    """Measure the ways from the robot's cell, and mark what can be reached from it.

    From a robot in a blocked cell what counts is what is connected with the passable cell nearest to it.
    """
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    cells, row, column = rows * columns, ground.cell[w, 0], ground.cell[w, 1]
    passable = (ground.cost[w, :cells] < np.inf).reshape(rows, columns)
    lengths = way_lengths(passable, row, column)
    ground.way[w, :cells] = lengths.reshape(cells) * ground.frame[w, 2]
    if not passable[row, column]:
        r, c = nearest_cell(passable, float(row), float(column))
        if r < 0:
            ground.reachable[w, :cells] = False
            return
        lengths = way_lengths(passable, r, c)
    ground.reachable[w, :cells] = lengths.reshape(cells) < np.inf
