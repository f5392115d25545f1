"""The particles' maps: likelihood fields of the walls they have seen, each wall remembering which way it faces.

A cell holds exp(−d²/2σ²), d the distance of its centre to the nearest end point, in 12 bits, and in 4 bits the
direction of that wall's normal. A point is compared only with walls that face its own way: the two faces of a thin
wall, which lie closer together than the field is wide, never attract each other.

Every particle has its own field, but particles that share a past share the tiles that have not changed since: a field
is a table of tiles, copying a particle copies the table, and a shared tile is copied when it is first written to.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.slam.rbpf.copying import copy_matrix

SIGMA = 0.08
"""Width of the field [m]: wide enough to pull in a pose that is 10 cm off, narrow enough for 5 cm cells."""
FULL = 4095
"""The field's value on a wall."""
SECTORS = 16
"""Directions that a wall may face."""
TILE_BITS = 4
TILE = 1 << TILE_BITS
"""Cells along a tile's side. A tile is stored with a rim of one cell that repeats its neighbours', so that the 3 × 3
cells around any of its own are at hand."""
CELL = 0.05
"""Side of the cells that the fields are made of [m]; gmapping's δ."""


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


class ParticleField(NamedTuple):
    """One particle's field, as its points are compared with it.

    Attributes:
        cells: (capacity · (TILE + 2)²,) the world's tiles in one row.
        table: (A, B) the particle's table of them.
        origin: (2,) the grid's lower-left corner [m].
        resolution: Side of a cell [m].
    """

    cells: NDArray[np.uint16]
    table: NDArray[np.int32]
    origin: NDArray[np.float64]
    resolution: float


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


@inlined
def field_of(fields: Fields, w: int, particle: int, origin: NDArray[np.float64], resolution: float) -> ParticleField:
    """The field of one particle, on a grid with its lower-left corner at ``origin`` (2,) and cells that large [m]."""
    return ParticleField(fields.tiles[w].reshape(-1), fields.table[w, particle], origin, resolution)


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
def own_tile(fields: Fields, w: int, particle: int, a: int, b: int) -> np.int64:
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
