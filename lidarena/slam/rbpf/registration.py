"""Entering a scan into a particle's likelihood field: the points where it knows no wall yet are stamped."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.rbpf.likelihood_field import CELL, FULL, SECTORS, SIGMA, TILE, TILE_BITS, Fields, field_of, own_tile
from lidarena.slam.rbpf.point_blocks import (
    BLOCK,
    CELLS,
    FACING,
    MIDDLE,
    PointBlocks,
    U,
    V,
    Workspace,
    corner,
    facing,
    gather_middle,
    locate,
)

_REACH = 4
"""Cells from an end point up to which it is stamped; 0.2 m is 2.5 σ."""
_SHIFTS = 8
"""Places within a cell, along each axis, for which the stamped Gaussian is kept; they are 6 mm apart."""
_FRESH = 0.75 * FULL
"""A point is stamped where the field is lower: no wall is known within about 6 cm of the middle of the
point's cell."""


def _bumps() -> NDArray[np.uint16]:
    """Stamps (row shift, column shift, row, column): the Gaussian in the upper 12 bits, 4 left for a direction."""
    shift = (np.arange(_SHIFTS) + 0.5) / _SHIFTS - 0.5
    away = np.arange(-_REACH, _REACH + 1)[None, :] - shift[:, None]
    line = np.exp(-0.5 * (away * CELL / SIGMA) ** 2)
    bump = FULL * line[:, None, :, None] * line[None, :, None, :]
    return (np.round(bump).astype(np.uint16) << 4).astype(np.uint16)


_BUMPS = _bumps()


@leaf
def register_points(
    fields: Fields,
    w: int,
    particle: int,
    pose: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    points: PointBlocks,
    work: Workspace,
) -> None:
    """Stamp a scan's points, seen from a pose, into a particle's field where it does not know them yet.

    Args:
        fields: The fields.
        w: World.
        particle: Particle.
        pose: (3,) x, y, theta.
        origin: (2,) lower-left corner of the grid [m].
        resolution: Side of a cell [m]; the stamps are drawn for ``CELL``.
        points: The scan's.
        work: Work space.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    turn = pose[2] * (SECTORS / (2.0 * math.pi)) + 10.0 * SECTORS + 0.5
    field = field_of(fields, w, particle, origin, resolution)
    cells, names, numbers = field.cells, field.table.reshape(-1), points.blocks.reshape(-1)
    reals, integers = work.reals, work.integers
    for block in range((points.size + BLOCK - 1) // BLOCK):
        here = min(BLOCK, points.size - block * BLOCK)
        locate(numbers, block, here, pose, cos, sin, field, work)
        gather_middle(cells, names, here, integers)
        for k in range(here):
            i = np.uint64(k)
            allowed = integers[i + FACING]
            if allowed == 0 or facing(integers[i + CELLS], allowed) >= _FRESH:
                continue
            # what was read may be out of date by now: the last stamp reached this cell, too
            if facing(np.int32(cells[np.uint64(corner(names, integers, i)) + MIDDLE]), allowed) < _FRESH:
                sector = np.int64(turn + points.blocks[block, 4, k]) & (SECTORS - 1)
                _stamp(fields, cells, w, particle, reals[i + U], reals[i + V], sector)


@leaf
def _stamp(
    fields: Fields,
    cells: NDArray[np.uint16],
    w: int,
    particle: int,
    u: float,
    v: float,
    sector: int,
) -> None:
    """Raise the cells around (u, v), also where a tile's rim repeats them, to the Gaussian of their distance to it.

    ``cells`` is world w's tiles in one row; the Gaussian is looked up at the nearest of ``_SHIFTS``² places in a cell.
    """
    a_count, b_count = fields.table.shape[2], fields.table.shape[3]
    column, row = math.floor(u), math.floor(v)
    if not (0 <= column < b_count * TILE and 0 <= row < a_count * TILE):
        return
    bump = _BUMPS[np.int64((v - row) * _SHIFTS), np.int64((u - column) * _SHIFTS)]
    left_most, lowest = column - _REACH, row - _REACH
    c0, c1 = max(left_most, 0), min(column + _REACH + 1, b_count * TILE)
    r0, r1 = max(lowest, 0), min(row + _REACH + 1, a_count * TILE)
    side = TILE + 2
    for a in range(max((r0 - 1) >> TILE_BITS, 0), min((r1 >> TILE_BITS) + 1, a_count)):
        for b in range(max((c0 - 1) >> TILE_BITS, 0), min((c1 >> TILE_BITS) + 1, b_count)):
            start = own_tile(fields, w, particle, a, b) * side * side
            top, left = a * TILE - 1, b * TILE - 1  # the cell that the tile's rim begins with
            for r in range(max(r0, top), min(r1, top + side)):
                line = start + (r - top) * side - left
                for c in range(max(c0, left), min(c1, left + side)):
                    k, value = np.uint64(line + c), bump[np.uint64(r - lowest), np.uint64(c - left_most)]
                    old = cells[k]
                    cells[k] = value | sector if value > (old | 15) else old
