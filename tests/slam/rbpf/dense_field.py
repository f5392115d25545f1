"""A particle's tiled field as one array."""

import numpy as np

from lidarena.slam.rbpf.likelihood_field import TILE, Fields


def dense(fields: Fields, particle: int) -> np.ndarray:
    """A particle's field as one array, and the rims checked against it."""
    a_count, b_count = fields.table.shape[2:]
    whole = np.zeros((a_count * TILE + 2, b_count * TILE + 2), np.uint16)
    for a in range(a_count):
        for b in range(b_count):
            tile = fields.tiles[0, fields.table[0, particle, a, b]]
            whole[a * TILE + 1 : (a + 1) * TILE + 1, b * TILE + 1 : (b + 1) * TILE + 1] = tile[1:-1, 1:-1]
    for a in range(a_count):
        for b in range(b_count):
            tile = fields.tiles[0, fields.table[0, particle, a, b]]
            assert np.array_equal(tile, whole[a * TILE : (a + 1) * TILE + 2, b * TILE : (b + 1) * TILE + 2])
    return whole[1:-1, 1:-1]
