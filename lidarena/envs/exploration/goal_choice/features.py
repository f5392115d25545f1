"""What an explorer is told of its candidates before it chooses one: numbers of the order of 1."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.planning.driving.candidates import BEYOND, FRONTIER, Candidates
from lidarena.planning.driving.explorer import Explorers
from lidarena.planning.driving.state import KnownGround

NAMES = (
    "there",  # 1, or 0 where there is no such candidate and all the rest is 0
    "place",  # 1 for a place that is known already: going there makes the pose more certain
    "way",  # length of the way to it / 3 m
    "log_way",  # ln(1 + way / 1 m) / 2
    "detour",  # how much longer than the way to the nearest frontier / 3 m; by a place, on to the best frontier
    "nearest",  # 1 for the nearest frontier
    "size",  # of the frontier, at most 2 m / 2 m
    "wide",  # the same, at most 6 m / 6 m
    "small",  # 1 for a frontier below 0.5 m
    "turn",  # angle from the heading to the beginning of the way / pi
    "unknown",  # share of unknown cells within 1.5 m of it
    "sight",  # ln(1 + unknown area that no known wall hides within 3 m of it / 0.1 m²) / 4
    "pocket",  # ln(1 + area of the unknown region behind it / 0.1 m²) / 4
    "enclosed",  # 1 where that region lies within what is known
    "pursued",  # 1 for the one that is driven to
    "advantage",  # distance advantage / 3 m: mean way to it from all that is known, less the robot's
    "remote",  # mean way to the other frontiers / 6 m
    "apart",  # way to the nearest other frontier / 3 m
    "since",  # for a place: how long ago the robot was there first / 100 s
    "surer",  # for a place: ln of D-optimality now less that when the robot was there first, / 3
    "wanted",  # the same times the preference
    # the same for all:
    "uncertainty",  # ln of D-optimality / 1e-4, over 3
    "mean_uncertainty",  # its mean over the area that was mapped so far
    "elapsed",  # time / 200 s
    "area",  # known area / 50 m²
    "frontiers",  # number of frontiers / 10
    "growth",  # time since something new came last / 20 s
    "preference",  # how much certainty is worth, 0 to 1
)
"""The features, in their order; after them come the ways to every candidate / 6 m."""
FEATURES = len(NAMES)
USUAL_D = 1e-4
"""D-optimality that counts as usual [m^(4/3) rad^(2/3)]."""
_UNKNOWN_REACH, _SIGHT, _PATCH = 1.5, 3.0, 0.1  # [m], [m], [m²]
_RAYS, _PIECE = 48, 2  # rays of a view, cells between two points of one
_FARTHEST = 60.0  # ways count as so long at most [m]


class Circumstances(NamedTuple):
    """What else is told of each world.

    Attributes:
        log_d: (W,) ln of D-optimality now.
        preference: (W,) how much certainty is worth, 0 to 1.
        period: Of the steps [s].
    """

    log_d: NDArray[np.float64]
    preference: NDArray[np.float64]
    period: float


@kernel
def describe(w: int, around: Circumstances, explorers: Explorers, rows: NDArray[np.float32]) -> None:
    """Describe the candidates of a world.

    Args:
        w: World.
        around: Circumstances of all worlds.
        explorers: Of all worlds, after ``advance`` said that a choice is due.
        rows: (K, FEATURES + K) output, see ``NAMES``.
    """
    candidates, ground = explorers.candidates, explorers.drive.ground
    rows[:] = 0.0
    count, seconds = candidates.number[w], explorers.step[w] * around.period
    pockets, areas = unknown_regions(w, ground)
    area, mean_log_d = explorers.mapped[w] * ground.frame[w, 2] ** 2, explorers.sum_log_d[w] / explorers.mapped[w]
    frontiers, nearest = 0, -1
    for k in range(count):
        if candidates.kind[w, k] == FRONTIER:
            frontiers += 1
            nearest = k if nearest < 0 else nearest
    for k in range(count):
        row, is_frontier = rows[k], candidates.kind[w, k] == FRONTIER
        way = min(candidates.way[w, k], _FARTHEST)
        row[0], row[1], row[2], row[3] = 1.0, not is_frontier, way / 3.0, math.log1p(way) / 2.0
        row[4] = min(_detour(w, k, candidates) - candidates.way[w, nearest], _FARTHEST) / 3.0
        size = candidates.size[w, k]
        row[5], row[6], row[7] = k == nearest, min(size, 2.0) / 2.0, min(size, 6.0) / 6.0
        row[8] = is_frontier and size < 0.5
        row[9] = candidates.turn[w, k] / math.pi
        row[14] = k == candidates.pursued[w]
        row[15] = min(max(candidates.between[w, k, k], -_FARTHEST), _FARTHEST) / 3.0
        row[16], row[17] = _remoteness(w, k, candidates)
        if is_frontier:
            _look(w, k, candidates, ground, pockets, areas, row)
        else:
            row[18] = candidates.since[w, k] / 100.0
            row[19] = (around.log_d[w] - candidates.log_d[w, k]) / 3.0
            row[20] = max(row[19], 0.0) * around.preference[w]
        row[21] = (around.log_d[w] - math.log(USUAL_D)) / 3.0
        row[22] = (mean_log_d - math.log(USUAL_D)) / 3.0
        row[23], row[24], row[25] = seconds / 200.0, area / 50.0, frontiers / 10.0
        row[26] = (explorers.step[w] - explorers.grown_at[w]) * around.period / 20.0
        row[27] = around.preference[w]
        for j in range(count):
            between = candidates.between[w, k, j] if j != k else 0.0
            row[FEATURES + j] = min(between, _FARTHEST) / 6.0


@kernel
def _detour(w: int, k: int, candidates: Candidates) -> float:
    """The way to the candidate if it is a frontier, else that by it to the frontier to which it is the shortest."""
    if candidates.kind[w, k] == FRONTIER:
        return float(candidates.way[w, k])
    least = BEYOND
    for j in range(candidates.number[w]):
        if candidates.kind[w, j] == FRONTIER:
            least = min(least, candidates.between[w, k, j])
    return float(candidates.way[w, k] + least)


@kernel
def _remoteness(w: int, k: int, candidates: Candidates) -> tuple[float, float]:
    """Mean way from a candidate to the other frontiers / 6 m, and that to the nearest of them / 3 m."""
    total, others, least = 0.0, 0, 9.0
    for j in range(candidates.number[w]):
        if j != k and candidates.kind[w, j] == FRONTIER and candidates.between[w, k, j] < BEYOND:
            total += candidates.between[w, k, j]
            least = min(least, candidates.between[w, k, j])
            others += 1
    return (total / others / 6.0 if others else 0.0), least / 3.0


@kernel
def _look(
    w: int,
    k: int,
    candidates: Candidates,
    ground: KnownGround,
    pockets: NDArray[np.int32],
    areas: NDArray[np.int64],
    row: NDArray[np.float32],
) -> None:
    """Features 10 to 13: what there is to see at a frontier."""
    rows, columns, side = ground.extent[w, 2], ground.extent[w, 3], ground.frame[w, 2]
    occupancy = ground.occupancy[w, : rows * columns].reshape(rows, columns)
    r, c = candidates.cell[w, k, 0], candidates.cell[w, k, 1]
    row[10] = _unknown_share(occupancy, r, c, int(_UNKNOWN_REACH / side))
    seen = visible_unknown_cells(occupancy, r, c, _SIGHT / side)
    row[11] = math.log1p(seen * side * side / _PATCH) / 4.0
    label = pockets[candidates.edge[w, k, 0], candidates.edge[w, k, 1]]
    if label > 0:
        row[13] = areas[label] >= 0
        row[12] = math.log1p(abs(areas[label]) * side * side / _PATCH) / 4.0


@kernel
def _unknown_share(occupancy: NDArray[np.int8], row: int, column: int, reach: int) -> float:
    """Share of the disc around a cell that is unknown; what lies beyond the map is."""
    cells, unknown = 0, 0
    for r in range(row - reach, row + reach + 1):
        for c in range(column - reach, column + reach + 1):
            if (r - row) ** 2 + (c - column) ** 2 <= reach * reach:
                cells += 1
                inside = 0 <= r < occupancy.shape[0] and 0 <= c < occupancy.shape[1]
                unknown += not inside or occupancy[r, c] < 0
    return unknown / cells


@kernel
def visible_unknown_cells(occupancy: NDArray[np.int8], row: int, column: int, reach: float) -> float:
    """About how many unknown cells no known wall hides from a cell; what lies beyond the map counts as unknown.

    Each of 48 rays stands for a sector: a point at the distance d of it for as many cells as the sector is wide there.

    Args:
        occupancy: (rows, columns).
        row: Of the cell.
        column: Of it.
        reach: Of the view, in cells.
    """
    total = 0.0
    for i in range(_RAYS):
        angle = 2.0 * math.pi * i / _RAYS
        step_r, step_c = math.sin(angle), math.cos(angle)
        for d in range(1, int(reach) + 1, _PIECE):
            r, c = math.floor(row + 0.5 + d * step_r), math.floor(column + 0.5 + d * step_c)
            inside = 0 <= r < occupancy.shape[0] and 0 <= c < occupancy.shape[1]
            if inside and occupancy[r, c] >= 50:
                break
            if not inside or occupancy[r, c] < 0:
                total += 2.0 * math.pi * d / _RAYS * _PIECE
    return total


@kernel
def unknown_regions(w: int, ground: KnownGround) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Return the connected unknown regions of a world's ground.

    Returns:
        (rows, columns) number of the region of each cell, 0 where it is known; the regions' cells (regions + 1,),
        negative for those that reach the edge of what is known, beyond which it goes on.
    """
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    occupancy = ground.occupancy[w, : rows * columns].reshape(rows, columns)
    labels = np.zeros((rows, columns), np.int32)
    queue = np.empty(rows * columns, np.int32)
    areas = np.zeros(rows * columns // 2 + 2, np.int64)
    regions = 0
    for r in range(rows):
        for c in range(columns):
            if occupancy[r, c] < 0 and labels[r, c] == 0:
                regions += 1
                areas[regions] = _flood(occupancy, r, c, regions, labels, queue)
    return labels, areas[: regions + 1]


@kernel
def _flood(
    occupancy: NDArray[np.int8], row: int, column: int, label: int, labels: NDArray[np.int32], queue: NDArray[np.int32]
) -> int:
    """Label the unknown region of a cell; its number of cells, negative if it reaches the edge."""
    rows, columns = occupancy.shape
    queue[0], labels[row, column] = row * columns + column, label
    head, tail, edge = 0, 1, False
    while head < tail:
        r, c = queue[head] // columns, queue[head] % columns
        head += 1
        edge = edge or r == 0 or c == 0 or r == rows - 1 or c == columns - 1
        for dr, dc in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            y, x = r + dr, c + dc
            if 0 <= y < rows and 0 <= x < columns and occupancy[y, x] < 0 and labels[y, x] == 0:
                labels[y, x] = label
                queue[tail] = y * columns + x
                tail += 1
    return -tail if edge else tail
