"""A scan's points in blocks, and where a block falls in a particle's field: the part of the filter that is vectorised.

Points are kept as (blocks, 5, BLOCK): coordinate by coordinate, a block at a time. The loops below run over one block,
in flat arrays and with distances that are known when they are compiled; that is what lets the compiler do several
points at once.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.slam.rbpf.likelihood_field import SECTORS, TILE, TILE_BITS, ParticleField

BLOCK = 32
"""Points in a block."""
BEHIND = 12
"""Sectors from a direction to the first one that counts as facing the same way, 100° to its right (modulo 16)."""
_ROUND_UP = 10.0 * SECTORS + 0.5 + BEHIND
"""Added to a direction in sectors so that cutting off its fraction rounds it; whole turns do not count."""
_SIDE = TILE + 2
# unsigned, so that no index is tested for being negative
X, Y, NORMAL_X, NORMAL_Y, SECTOR, ROWS = (np.uint64(k * BLOCK) for k in range(6))
U, V, AWAY_X, AWAY_Y, FIT, FIT_X, FIT_Y, PULL, WALL_X, WALL_Y, LEVER = (np.uint64(k * BLOCK) for k in range(11))
FACING, WHICH_TILE, PLACE, CELLS = (np.uint64(k * BLOCK) for k in range(4))
NEXT, ROW = np.uint64(BLOCK), np.uint64(3 * BLOCK)
"""From a cell's row among the integers to the next cell's, and to that of the cell above."""
_REALS, _INTEGERS = 11, 12
_ONE, MIDDLE = np.uint64(1), np.uint64(_SIDE + 1)


class PointBlocks(NamedTuple):
    """Points of a scan in the sensor's frame, a block at a time.

    Attributes:
        blocks: (blocks, 5, BLOCK) as ``scan_points.extract_points`` gives them.
        size: How many points there are.
    """

    blocks: NDArray[np.float64]
    size: int


class Workspace(NamedTuple):
    """Room for what is computed of one block of points; rows of ``BLOCK`` numbers, one behind the other.

    Attributes:
        reals: (11 · BLOCK,) rows U, V (place in cells), AWAY_X, AWAY_Y (from the robot, turned into the map), and what
            ``scan_matching`` adds to them.
        integers: (12 · BLOCK,) int32 rows FACING (which sectors a wall may face, 16 bits), WHICH_TILE (in the table),
            PLACE (in the tile), and from CELLS on the 3 × 3 cells around each point.
    """

    reals: NDArray[np.float64]
    integers: NDArray[np.int32]


def empty_workspaces(count: int) -> Workspace:
    """Allocate ``count`` of them: (count, …) arrays, of which every call takes a row."""
    return Workspace(np.zeros((count, _REALS * BLOCK)), np.zeros((count, _INTEGERS * BLOCK), np.int32))


def empty_blocks(points: int) -> NDArray[np.float64]:
    """Blocks for so many points."""
    return np.zeros((-(-points // BLOCK), 5, BLOCK))


def as_blocks(points: NDArray[np.float64]) -> PointBlocks:
    """(n, 5) points as blocks; what is left of the last one is zero."""
    blocks = empty_blocks(max(len(points), 1))
    for i, point in enumerate(points):
        blocks[i // BLOCK, :, i % BLOCK] = point
    return PointBlocks(blocks, len(points))


@leaf
def locate(
    points: NDArray[np.float64],
    block: int,
    count: int,
    pose: NDArray[np.float64],
    cos: float,
    sin: float,
    field: ParticleField,
    work: Workspace,
) -> None:
    """Where a block's points fall, seen from a pose; a point outside the grid faces nothing.

    Args:
        points: The blocks in one row.
        block: Which of them.
        count: Its points.
        pose: (3,).
        cos: Of the pose's heading.
        sin: Of it.
        field: Of the particle.
        work: Of one thread; takes what is found.
    """
    reals, integers, table, origin = work.reals, work.integers, field.table, field.origin
    per_cell = 1.0 / field.resolution
    start_u, start_v = (pose[0] - origin[0]) * per_cell, (pose[1] - origin[1]) * per_cell
    turn = pose[2] * (SECTORS / (2.0 * math.pi)) + _ROUND_UP
    across = np.int32(table.shape[1])
    # the last cell's far edge belongs to nobody: clipping must stay before it
    end_u, end_v = table.shape[1] * TILE - 1e-9, table.shape[0] * TILE - 1e-9
    base = np.uint64(block) * ROWS
    for i in range(np.uint64(count)):
        px = cos * points[base + i] - sin * points[base + i + Y]
        py = sin * points[base + i] + cos * points[base + i + Y]
        u, v = start_u + px * per_cell, start_v + py * per_cell
        inside = (u >= 0.0) & (v >= 0.0) & (u < end_u) & (v < end_v)
        u, v = min(max(u, 0.0), end_u), min(max(v, 0.0), end_v)
        reals[i + U], reals[i + V], reals[i + AWAY_X], reals[i + AWAY_Y] = u, v, px, py
        c, r = np.int32(u), np.int32(v)
        shift = np.int32(turn + points[base + i + SECTOR]) & np.int32(SECTORS - 1)
        mask = (np.int32(0x1FF) << shift) | (np.int32(0x1FF) >> (np.int32(SECTORS) - shift))
        integers[i + FACING] = mask if inside else np.int32(0)
        integers[i + WHICH_TILE] = (r >> np.int32(TILE_BITS)) * across + (c >> np.int32(TILE_BITS))
        integers[i + PLACE] = (r & np.int32(TILE - 1)) * np.int32(_SIDE) + (c & np.int32(TILE - 1))


@inlined
def facing(cell: int, allowed: int) -> float:
    """The value of a cell (int32) if its wall faces one of the ``allowed`` sectors (bits), else 0; without a branch."""
    seen = np.int32(allowed >> np.int32(cell & np.int32(SECTORS - 1))) & np.int32(1)
    return np.float64(np.int32(np.int32(cell >> np.int32(4)) & np.int32(-np.int32(seen))))


@inlined
def corner(names: NDArray[np.int32], integers: NDArray[np.int32], i: int) -> int:
    """Where among all cells the 3 × 3 around the located point i begin; the point's own is the fifth, at ``MIDDLE``."""
    tile = np.int64(names[np.uint64(integers[i + WHICH_TILE])])
    first: int = tile * (_SIDE * _SIDE) + integers[i + PLACE]
    return first


@leaf
def gather_middle(cells: NDArray[np.uint16], names: NDArray[np.int32], count: int, integers: NDArray[np.int32]) -> None:
    """Read the cell that each located point lies in to CELLS; ``names`` is the particle's table in one row."""
    for i in range(np.uint64(count)):
        integers[i + CELLS] = cells[np.uint64(corner(names, integers, i)) + MIDDLE]


@leaf
def gather_around(cells: NDArray[np.uint16], names: NDArray[np.int32], count: int, integers: NDArray[np.int32]) -> None:
    """Read the 3 × 3 cells around each located point to CELLS and on; ``names`` is the particle's table in one row."""
    for i in range(np.uint64(count)):
        first = corner(names, integers, i)
        to = i + CELLS
        for row in range(3):
            k = np.uint64(first + row * _SIDE)
            integers[to] = cells[k]
            integers[to + NEXT] = cells[k + _ONE]
            integers[to + NEXT + NEXT] = cells[k + _ONE + _ONE]
            to += ROW
