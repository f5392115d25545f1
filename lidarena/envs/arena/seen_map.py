"""The map that a robot keeps of what its lidar has met: one hit a cell, and what it costs to come near it.

Unknown is free. A hit is forgotten when two beams have passed it since it was met last, so that what has moved on does
not stay in the map.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.planning.grid.known_ways import DEAREST

CELLS = 200
"""Along the longer side of a room."""
BLOCKED = 50
"""From this cost on a cell is too near to a hit for the robot: a way leads through only for want of any other, since
what lies beside hits, and how the cells lie, is not known exactly."""
_NEAR = 3
"""Cost of cells beside those: ways keep off hits where that costs little."""
_CORE = 0.7
"""Share of the robot's radius within which a hit is as good as a wall."""
_BESIDE = 3.0
"""Cells beside the robot's radius that are dearer."""
_TRUST = 2
"""Beams that pass a hit before it is forgotten."""
_ASIDE, _BEYOND = 0.5, 2.0
"""A beam passes a hit if it is no farther from it than this and goes on for as much behind it [cells]."""


class SeenMap(NamedTuple):
    """The maps of ``W`` worlds, of N × N cells each.

    Attributes:
        points: (W, N, N, 2) the hit in each cell [m], where there is one.
        trust: (W, N, N) beams that must pass a hit before it is forgotten; 0 without one.
        counts: (W, N, N, 3) hits within each of ``reach`` of a cell's middle.
        cost: (W, N, N) of each cell for ways, 1 to 255.
        reach: (W, 3) from a hit, within which cells are dearer, too near, and as good as walls [m].
        origin: (W, 2) lower-left corner [m].
        cell: (W,) side of a cell [m].
    """

    points: NDArray[np.float32]
    trust: NDArray[np.uint8]
    counts: NDArray[np.int16]
    cost: NDArray[np.uint8]
    reach: NDArray[np.float64]
    origin: NDArray[np.float64]
    cell: NDArray[np.float64]


def empty_maps(worlds: int) -> SeenMap:
    """Maps in which nothing was seen."""
    shape = (worlds, CELLS, CELLS)
    return SeenMap(
        np.zeros((*shape, 2), np.float32),
        np.zeros(shape, np.uint8),
        np.zeros((*shape, 3), np.int16),
        np.ones(shape, np.uint8),
        np.zeros((worlds, 3)),
        np.zeros((worlds, 2)),
        np.ones(worlds),
    )


def forget(world: int, bounds: NDArray[np.float64], radius: float, seen: SeenMap) -> None:
    """Begin one world's map anew.

    Args:
        world: Which one.
        bounds: (4,) of the room, which the cells cover [m].
        radius: Of the robot [m].
        seen: Changed.
    """
    seen.trust[world], seen.counts[world], seen.cost[world] = 0, 0, 1
    cell = max(bounds[2] - bounds[0], bounds[3] - bounds[1]) / CELLS
    seen.cell[world], seen.origin[world] = cell, bounds[:2]
    seen.reach[world] = radius + _BESIDE * cell, radius, _CORE * radius


@inlined
def cell_of(x: float, y: float, world: int, seen: SeenMap) -> tuple[int, int]:
    """The row and column of a point, which may lie off the grid."""
    cell = seen.cell[world]
    return math.floor((y - seen.origin[world, 1]) / cell), math.floor((x - seen.origin[world, 0]) / cell)


@inlined
def nearest_cell(x: float, y: float, world: int, seen: SeenMap) -> int:
    """The cell, row · N + column, of a point, or the nearest one to a point off the grid."""
    row, column = cell_of(x, y, world, seen)
    rows, columns = seen.cost.shape[1:]
    return int(min(max(row, 0), rows - 1) * columns + min(max(column, 0), columns - 1))


@inlined
def _cost_of(counts: NDArray[np.int16]) -> int:
    if counts[2] > 0:
        return DEAREST
    if counts[1] > 0:
        return BLOCKED
    return _NEAR if counts[0] > 0 else 1


@leaf
def _stamp(world: int, row: int, column: int, by: int, seen: SeenMap) -> None:
    """Count a cell's hit, or stop counting it, in all cells that it makes dearer."""
    x, y = np.float64(seen.points[world, row, column, 0]), np.float64(seen.points[world, row, column, 1])
    cell, reach = seen.cell[world], seen.reach[world]
    around = math.ceil(reach[0] / cell)
    for r in range(max(row - around, 0), min(row + around + 1, seen.cost.shape[1])):
        dy = seen.origin[world, 1] + (r + 0.5) * cell - y
        for c in range(max(column - around, 0), min(column + around + 1, seen.cost.shape[2])):
            dx = seen.origin[world, 0] + (c + 0.5) * cell - x
            squared = dx * dx + dy * dy
            for tier in range(3):
                if squared >= reach[tier] * reach[tier] and (tier < 2 or r != row or c != column):
                    continue  # the hit's own cell is as good as a wall, however small the robot is
                seen.counts[world, r, c, tier] += by
            seen.cost[world, r, c] = _cost_of(seen.counts[world, r, c])


@leaf
def note_hit(world: int, x: float, y: float, seen: SeenMap) -> None:
    """Remember what a beam has met, unless there is a hit in its cell."""
    row, column = cell_of(x, y, world, seen)
    if row < 0 or column < 0 or row >= seen.cost.shape[1] or column >= seen.cost.shape[2]:
        return
    if seen.trust[world, row, column] == 0:
        seen.points[world, row, column, 0], seen.points[world, row, column, 1] = x, y
        _stamp(world, row, column, 1, seen)
    seen.trust[world, row, column] = _TRUST


@leaf
def note_free(world: int, x: float, y: float, cos: float, sin: float, length: float, seen: SeenMap) -> None:
    """Trust the hits less that a beam has passed, and forget those that too many have.

    Args:
        world: Whose map.
        x: Where the beam begins [m].
        y: Where it begins [m].
        cos: Of its direction.
        sin: Of its direction.
        length: After which it met something, or ended [m].
        seen: Changed.
    """
    cell = seen.cell[world]
    free = length - _BEYOND * cell
    before = (-1, -1)
    for k in range(1, math.ceil(free / cell)):
        row, column = cell_of(x + k * cell * cos, y + k * cell * sin, world, seen)
        if row < 0 or column < 0 or row >= seen.cost.shape[1] or column >= seen.cost.shape[2]:
            return
        if seen.trust[world, row, column] == 0 or (row, column) == before:
            continue
        before = (row, column)
        dx, dy = seen.points[world, row, column, 0] - x, seen.points[world, row, column, 1] - y
        if abs(cos * dy - sin * dx) < _ASIDE * cell and 0.0 < cos * dx + sin * dy < free:
            seen.trust[world, row, column] -= 1
            if seen.trust[world, row, column] == 0:
                _stamp(world, row, column, -1, seen)


@leaf
def is_clear(world: int, ax: float, ay: float, bx: float, by: float, most: int, seen: SeenMap) -> bool:
    """Whether no cell on the straight line from a to b costs more than ``most``, but for that of a."""
    cell = seen.cell[world]
    dx, dy = bx - ax, by - ay
    pieces = math.ceil(2.0 * math.sqrt(dx * dx + dy * dy) / cell)
    own = nearest_cell(ax, ay, world, seen)
    columns = seen.cost.shape[2]
    for k in range(1, pieces + 1):
        share = k / pieces
        here = nearest_cell(ax + share * dx, ay + share * dy, world, seen)
        if here != own and seen.cost[world, here // columns, here % columns] > most:
            return False
    return True
