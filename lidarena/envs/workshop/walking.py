"""Walking about a floor: shortest ways to every location as fields of directions, and how two keep their distance."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from lidarena.base.jit import inlined, kernel, leaf
from lidarena.planning.grid.way_lengths import way_lengths
from lidarena.world.floorplan import Floorplan

Floats = NDArray[np.float64]

RESOLUTION = 0.1
"""Side of a cell [m]."""
SLACK = 0.05
"""Room between a body on its way and the nearest wall [m]."""
TICK = 0.1
"""Time step of the walks [s]."""
NEARBY = 0.3
"""From here on one walks straight to the point itself [m]."""
_AHEAD = 25
"""Cells along the shortest way among which the last visible one gives the direction."""


class WalkGrid(NamedTuple):
    """Shortest ways over a floor to ``F`` points."""

    free: NDArray[np.bool_]
    """(rows, columns) where a body's centre may be"""
    toward: NDArray[np.float32]
    """(F, rows, columns, 2) unit vectors along the way; of a cell that is not free, out of it"""
    lengths: NDArray[np.float32]
    """(F, rows, columns) of the ways, of a cell that is not free from the nearest one [m]; infinite without a way"""
    points: Floats
    """(F, 2) [m]"""
    x: float
    """Of the lower-left corner [m]"""
    y: float
    """Of the lower-left corner [m]"""


def make_walk_grid(plan: Floorplan, points: Floats, radius: float) -> WalkGrid:
    """Find the shortest ways of a disc to each of some points.

    Args:
        plan: The floor.
        points: (F, 2) [m].
        radius: Of the disc [m].
    """
    raster = plan.raster(RESOLUTION)
    free = ~raster.solid & (raster.clearance >= radius + SLACK)
    x, y = raster.origin.tolist()
    nearest = distance_transform_edt(~free, return_distances=False, return_indices=True).astype(np.int64)
    toward = np.zeros((len(points), *free.shape, 2), np.float32)
    lengths = np.full((len(points), *free.shape), np.inf, np.float32)
    for number, point in enumerate(points):
        row, column = cell_of(point[1], y, free.shape[0]), cell_of(point[0], x, free.shape[1])
        ways = way_lengths(free, row, column) if free[row, column] else np.full(free.shape, np.inf)
        _aim(free, ways, nearest, np.array([row, column]), toward[number])
        lengths[number] = ways[nearest[0], nearest[1]] * RESOLUTION  # who was pushed off the ways returns to them
    return WalkGrid(free, toward, lengths, np.ascontiguousarray(points), x, y)


def cell_of(coordinate: float, origin: float, count: int) -> int:
    """The row or column of a coordinate [m], at most the last one."""
    return min(max(int((coordinate - origin) / RESOLUTION), 0), count - 1)


@kernel
def _aim(
    free: NDArray[np.bool_],
    ways: Floats,
    nearest: NDArray[np.int64],
    goal: NDArray[np.int64],
    toward: NDArray[np.float32],
) -> None:
    """Fill ``toward`` (rows, columns, 2): to the goal (2,) where it is seen, else along falling ``ways``.

    Ways in eight directions are bent where the floor is open, and many are equally long.
    """
    rows, columns = free.shape
    for r in range(rows):
        for c in range(columns):
            tr, tc = r, c
            if not free[r, c]:
                tr, tc = nearest[0, r, c], nearest[1, r, c]
            elif ways[r, c] < np.inf and _sees(free, r, c, goal[0], goal[1]):
                tr, tc = goal[0], goal[1]
            elif ways[r, c] < np.inf:
                nr, nc = r, c
                for k in range(_AHEAD):
                    nr, nc = _descend(ways, nr, nc)
                    if k > 0 and not _sees(free, r, c, nr, nc):
                        break
                    tr, tc = nr, nc
            away = math.hypot(tr - r, tc - c)
            if away > 0.0:
                toward[r, c, 0] = (tc - c) / away
                toward[r, c, 1] = (tr - r) / away


@leaf
def _descend(ways: Floats, row: int, column: int) -> tuple[int, int]:
    """The neighbour from which the way is shortest."""
    best_r, best_c = row, column
    for r in range(max(row - 1, 0), min(row + 2, ways.shape[0])):
        for c in range(max(column - 1, 0), min(column + 2, ways.shape[1])):
            if ways[r, c] < ways[best_r, best_c]:
                best_r, best_c = r, c
    return best_r, best_c


@leaf
def _sees(free: NDArray[np.bool_], r0: int, c0: int, r1: int, c1: int) -> bool:
    """Whether all cells on the line between two cells are free."""
    steps = 2 * max(abs(r1 - r0), abs(c1 - c0))
    for k in range(1, steps):
        r = int(r0 + (r1 - r0) * k / steps + 0.5)
        c = int(c0 + (c1 - c0) * k / steps + 0.5)
        if not free[r, c]:
            return False
    return True


@inlined
def is_free(grid: WalkGrid, x: float, y: float) -> bool:
    """Whether a body's centre may be at a place."""
    row, column = int((y - grid.y) / RESOLUTION), int((x - grid.x) / RESOLUTION)
    return bool(0 <= row < grid.free.shape[0] and 0 <= column < grid.free.shape[1] and grid.free[row, column])


@leaf
def way_length(grid: WalkGrid, field: int, x: float, y: float) -> float:
    """Length of the way from a place to a point [m]."""
    row = min(max(int((y - grid.y) / RESOLUTION), 0), grid.free.shape[0] - 1)
    column = min(max(int((x - grid.x) / RESOLUTION), 0), grid.free.shape[1] - 1)
    straight = math.hypot(grid.points[field, 0] - x, grid.points[field, 1] - y)
    return max(float(grid.lengths[field, row, column]) if straight > NEARBY else 0.0, straight)


@leaf
def direction(grid: WalkGrid, field: int, x: float, y: float) -> tuple[float, float]:
    """Unit vector along the way from a place to a point; (0, 0) where there is no way, or one is there."""
    dx, dy = grid.points[field, 0] - x, grid.points[field, 1] - y
    straight = math.hypot(dx, dy)
    if straight < NEARBY:
        return (dx / straight, dy / straight) if straight > 1e-9 else (0.0, 0.0)
    row = min(max(int((y - grid.y) / RESOLUTION), 0), grid.free.shape[0] - 1)
    column = min(max(int((x - grid.x) / RESOLUTION), 0), grid.free.shape[1] - 1)
    return float(grid.toward[field, row, column, 0]), float(grid.toward[field, row, column, 1])


@leaf
def sidestep(
    grid: WalkGrid, place: Floats, other: Floats, wanted: Floats, step: float, keep: float, side: int
) -> tuple[float, float, int]:
    """The direction nearest to a wanted one in which a step keeps the distance from the other.

    Args:
        grid: The floor.
        place: (2,) of the body [m].
        other: (2,) of the other body [m].
        wanted: (2,) unit vector.
        step: Length [m].
        keep: Distance between the centres that must not be undercut, unless the step leads away [m].
        side: On which it passes the other: 1 left, -1 right, 0 not decided.

    Returns:
        x and y of a unit vector, (0, 0) if there is no such step, and the side.
    """
    now = math.hypot(place[0] - other[0], place[1] - other[1])
    x, y = place[0] + step * wanted[0], place[1] + step * wanted[1]
    gap = math.hypot(x - other[0], y - other[1])
    if gap >= keep or gap > now:
        return wanted[0], wanted[1], 0 if now > keep + 4.0 * step else side
    if side == 0:  # pass where the other is not
        cross = wanted[0] * (other[1] - place[1]) - wanted[1] * (other[0] - place[0])
        side = -1 if cross > 0.0 else 1
    for turn in (0.35, 0.7, 1.05, 1.4, 1.75, 2.1):
        angle = turn * side
        dx = wanted[0] * math.cos(angle) - wanted[1] * math.sin(angle)
        dy = wanted[0] * math.sin(angle) + wanted[1] * math.cos(angle)
        x, y = place[0] + step * dx, place[1] + step * dy
        gap = math.hypot(x - other[0], y - other[1])
        if (gap >= keep or gap > now) and is_free(grid, x, y):
            return dx, dy, side
    return 0.0, 0.0, -side


@leaf
def flee(grid: WalkGrid, place: Floats, other: Floats, step: float) -> tuple[float, float]:
    """The direction of a step that gives way to the other; (0, 0) where there is none."""
    dx, dy = place[0] - other[0], place[1] - other[1]
    now = math.hypot(dx, dy)
    if now < 1e-9:
        dx, dy, now = 1.0, 0.0, 1.0
    for turn in (0.0, 0.6, -0.6, 1.2, -1.2, 1.5, -1.5):
        cos, sin = math.cos(turn), math.sin(turn)
        x, y = (dx * cos - dy * sin) / now, (dx * sin + dy * cos) / now
        if is_free(grid, place[0] + step * x, place[1] + step * y):
            return x, y
    return 0.0, 0.0


@kernel
def walking_time(grid: WalkGrid, start: int, goal: int, other: Floats, step: float, keep: float, limit: float) -> float:
    """How long it takes to walk from one point to another past somebody who stands still [s].

    Args:
        grid: The floor.
        start: Number of the first point.
        goal: Number of the last point.
        other: (2,) of the one who stands there [m]; NaN for nobody.
        step: Walked in a ``TICK`` [m].
        keep: Distance of the centres to be kept [m].
        limit: Infinite if it takes longer than this [s].
    """
    place, wanted = np.empty(2), np.empty(2)
    place[0], place[1] = grid.points[start, 0], grid.points[start, 1]
    side, alone = 0, math.isnan(other[0])
    ticks = 0
    while True:
        away = math.hypot(grid.points[goal, 0] - place[0], grid.points[goal, 1] - place[1])
        if away <= step:
            return TICK * (ticks + away / step)
        dx, dy = direction(grid, goal, place[0], place[1])
        if not alone:
            wanted[0], wanted[1] = dx, dy
            dx, dy, side = sidestep(grid, place, other, wanted, step, keep, side)
        place[0] += step * dx
        place[1] += step * dy
        ticks += 1
        if ticks * TICK > limit or (dx == 0.0 and dy == 0.0 and alone):
            return np.inf
