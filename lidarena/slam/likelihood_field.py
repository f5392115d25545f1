"""The particles' maps: likelihood fields of the walls they have seen, each wall remembering which way it faces.

A cell holds exp(−d²/2σ²), d the distance of its centre to the nearest end point, in 12 bits, and in 4 bits the
direction of that wall's normal. A point is compared only with walls that face its own way: the two faces of a thin
wall, which lie closer together than the field is wide, never attract each other.

Every particle has its own field, but particles that share a past share the tiles that have not changed since: a field
is a table of tiles, copying a particle copies the table, and a shared tile is copied when it is first written to.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.copying import copy_matrix
from lidarena.world.kernels import inlined, leaf

SIGMA = 0.08
"""Width of the field [m]: wide enough to pull in a pose that is 10 cm off, narrow enough for 5 cm cells."""
FULL = 4095
"""The field's value on a wall."""
SECTORS = 16
"""Directions that a wall may face."""
ROUND_UP = 10.0 * SECTORS + 0.5
"""Added to a direction in sectors so that cutting off its fraction rounds it; whole turns do not count."""
TILE_BITS = 4
TILE = 1 << TILE_BITS
"""Cells along a tile's side. A tile is stored with a rim of one cell that repeats its neighbours', so that the 3 × 3
cells around any of its own are at hand."""
_REACH = 4
"""Cells from an end point up to which it is stamped; 0.2 m is 2.5 σ."""
_SHIFTS = 8
"""Places within a cell, along each axis, for which the stamped Gaussian is kept; they are 6 mm apart."""
CELL = 0.05
"""Side of the cells that the fields are made of [m]; gmapping's δ."""
_FRESH = 0.75
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


class Fields(NamedTuple):
    """Likelihood fields of ``W`` worlds × ``N`` particles over grids of ``A`` × ``B`` tiles.

    Attributes:
        tiles: (W, capacity, TILE + 2, TILE + 2) uint16; tile 0 stays empty.
        table: (W, N, A, B) which tile stands where.
        references: (W, capacity) how many tables name a tile.
        free: (W, capacity) stack of unused tiles.
        free_count: (W,) height of the stack.
    """

    tiles: NDArray[np.uint16]
    table: NDArray[np.int32]
    references: NDArray[np.int32]
    free: NDArray[np.int32]
    free_count: NDArray[np.int64]


def empty_fields(worlds: int, particles: int, rows: int, columns: int) -> Fields:
    """Fields that know no wall, for grids of rows × columns cells; memory is taken up only as walls appear."""
    a, b = -(-rows // TILE), -(-columns // TILE)
    capacity = particles * a * b + 1
    fields = Fields(
        np.zeros((worlds, capacity, TILE + 2, TILE + 2), np.uint16),
        np.zeros((worlds, particles, a, b), np.int32),
        np.zeros((worlds, capacity), np.int32),
        np.zeros((worlds, capacity), np.int32),
        np.zeros(worlds, np.int64),
    )
    for w in range(worlds):
        clear_fields(fields, w)
    return fields


def tiles_in_use(fields: Fields) -> int:
    """How many tiles of every world, counted from the first, hold all that any table names."""
    return int(np.flatnonzero(fields.references.any(axis=0)).max(initial=0)) + 1


@leaf
def clear_fields(fields: Fields, w: int) -> None:
    """Forget every wall of world w."""
    capacity = fields.free.shape[1]
    fields.table[w] = 0
    fields.references[w] = 0
    for k in range(capacity - 1):
        fields.free[w, k] = capacity - 1 - k  # low tiles first, so that memory is reused
    fields.free_count[w] = capacity - 1


@leaf
def copy_field(fields: Fields, w: int, source: int, target: int) -> None:
    """Make particle ``target``'s field the same as ``source``'s by sharing its tiles."""
    for a in range(fields.table.shape[2]):
        for b in range(fields.table.shape[3]):
            old, new = fields.table[w, target, a, b], fields.table[w, source, a, b]
            if old != new:
                if old != 0:
                    fields.references[w, old] -= 1
                    if fields.references[w, old] == 0:
                        fields.free[w, fields.free_count[w]] = old
                        fields.free_count[w] += 1
                if new != 0:
                    fields.references[w, new] += 1
                fields.table[w, target, a, b] = new


@leaf
def _own_tile(fields: Fields, w: int, particle: int, a: int, b: int) -> np.int64:
    """Index of the tile at (a, b) after making sure that this particle alone uses it."""
    old = fields.table[w, particle, a, b]
    if old != 0 and fields.references[w, old] == 1:
        return np.int64(old)
    fields.free_count[w] -= 1
    new = fields.free[w, fields.free_count[w]]
    if old != 0:
        fields.references[w, old] -= 1
    copy_matrix(fields.tiles[w, new], fields.tiles[w, old])
    fields.references[w, new] = 1
    fields.table[w, particle, a, b] = new
    return np.int64(new)


@inlined
def facing_mask(sector: int) -> int:
    """The sectors within about 100° of ``sector`` (any integer, taken modulo 16), as 16 bits."""
    shift = (sector + 12) & (SECTORS - 1)
    return ((0x1FF << shift) | (0x1FF >> (SECTORS - shift))) & 0xFFFF


@inlined
def facing(cell: int, allowed: int) -> float:
    """The cell's value if its wall faces one of the ``allowed`` sectors (bits), else 0; without a branch."""
    return np.float64((cell >> 4) & -((allowed >> (cell & 15)) & 1))


@inlined
def field_at(cells: NDArray[np.uint16], table: NDArray[np.int32], column: int, row: int, sector: int) -> float:
    """A field's value in a cell, of walls that face ``sector``; 0 outside the grid.

    Args:
        cells: One world's tiles in one row.
        table: (A, B) one particle's table.
        column: Of the cell.
        row: Of the cell.
        sector: Direction that the point's own wall faces.
    """
    if not (0 <= column < table.shape[1] * TILE and 0 <= row < table.shape[0] * TILE):
        return 0.0
    tile = np.int64(table[np.uint64(row >> TILE_BITS), np.uint64(column >> TILE_BITS)])
    side = TILE + 2
    k = np.uint64((tile * side + (row & (TILE - 1)) + 1) * side + (column & (TILE - 1)) + 1)
    return facing(np.int64(cells[k]), facing_mask(sector)) / FULL


@leaf
def register_points(
    fields: Fields,
    w: int,
    particle: int,
    pose: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    points: NDArray[np.float64],
) -> None:
    """Stamp a scan's points, seen from a pose, into a particle's field where it does not know them yet.

    Args:
        fields: The fields.
        w: World.
        particle: Particle.
        pose: (3,) x, y, theta.
        origin: (2,) lower-left corner of the grid [m].
        resolution: Side of a cell [m]; the stamps are drawn for ``CELL``.
        points: (n, 5) as ``scan_points.extract_points`` gives them.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    turn = pose[2] * (SECTORS / (2.0 * math.pi)) + ROUND_UP
    cells, table = fields.tiles[w].reshape(-1), fields.table[w, particle]
    per_cell = 1.0 / resolution
    start_u, start_v = (pose[0] - origin[0]) * per_cell, (pose[1] - origin[1]) * per_cell
    for i in range(points.shape[0]):
        u = start_u + (cos * points[i, 0] - sin * points[i, 1]) * per_cell
        v = start_v + (sin * points[i, 0] + cos * points[i, 1]) * per_cell
        sector = np.int64(turn + points[i, 4])
        if field_at(cells, table, math.floor(u), math.floor(v), sector) < _FRESH:
            _stamp(fields, cells, w, particle, u, v, sector & (SECTORS - 1))


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
            start = _own_tile(fields, w, particle, a, b) * side * side
            top, left = a * TILE - 1, b * TILE - 1  # the cell that the tile's rim begins with
            for r in range(max(r0, top), min(r1, top + side)):
                line = start + (r - top) * side - left
                for c in range(max(c0, left), min(c1, left + side)):
                    k, value = np.uint64(line + c), bump[np.uint64(r - lowest), np.uint64(c - left_most)]
                    old = cells[k]
                    cells[k] = value | sector if value > (old | 15) else old
