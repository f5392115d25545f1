"""The tiled, shared fields against one plain array a particle."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.likelihood_field import (
    FULL,
    SECTORS,
    SIGMA,
    TILE,
    Fields,
    clear_fields,
    copy_field,
    empty_fields,
    field_at,
    register_points,
)

ORIGIN, POSE = np.zeros(2), np.zeros(3)


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


def nearest_eighth(value: float) -> float:
    """The middle of the eighth of a cell that holds ``value``."""
    return (math.floor((value + 0.5) * 8) + 0.5) / 8 - 0.5


def stamp_oracle(whole: np.ndarray, x: float, y: float, sector: int) -> None:
    u, v = x * (1 / 0.05) - 0.5, y * (1 / 0.05) - 0.5
    column, row = math.floor(u + 0.5), math.floor(v + 0.5)
    near_u, near_v = nearest_eighth(u), nearest_eighth(v)
    for r in range(max(row - 4, 0), min(row + 5, whole.shape[0])):
        for c in range(max(column - 4, 0), min(column + 5, whole.shape[1])):
            value = round(FULL * math.exp(-0.5 * ((c - near_u) ** 2 + (r - near_v) ** 2) * (0.05 / SIGMA) ** 2))
            if value > whole[r, c] >> 4:
                whole[r, c] = value << 4 | sector


def point(x: float, y: float, sector: int) -> np.ndarray:
    angle = sector * 2 * math.pi / SECTORS
    return np.array([[x, y, math.cos(angle), math.sin(angle), float(sector)]])


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.floats(0.01, 2.3), st.floats(0.01, 1.5), st.integers(0, 15)), max_size=15))
def test_tiles_hold_what_one_array_would(stamps: list[tuple[float, float, int]]) -> None:
    fields = empty_fields(1, 2, 32, 48)
    whole = np.zeros((32, 48), np.uint16)
    for x, y, sector in stamps:
        column, row = math.floor(x * (1 / 0.05)), math.floor(y * (1 / 0.05))
        apart = (int(whole[row, column] & 15) - sector) % 16
        known = whole[row, column] >> 4 if min(apart, 16 - apart) <= 4 else 0
        if known / FULL < 0.75:
            stamp_oracle(whole, x, y, sector)
        register_points(fields, 0, 0, POSE, ORIGIN, 0.05, point(x, y, sector))
    assert np.array_equal(dense(fields, 0), whole)
    assert not dense(fields, 1).any()


def test_copies_share_tiles_until_one_writes() -> None:
    fields = empty_fields(1, 3, 48, 48)
    register_points(fields, 0, 0, POSE, ORIGIN, 0.05, point(1.0, 1.0, 0))
    copy_field(fields, 0, 0, 1)
    before = fields.free_count[0]
    assert np.array_equal(dense(fields, 0), dense(fields, 1))
    original = dense(fields, 0).copy()
    register_points(fields, 0, 1, POSE, ORIGIN, 0.05, point(1.2, 1.0, 0))
    assert np.array_equal(dense(fields, 0), original)
    assert not np.array_equal(dense(fields, 1), original)
    assert fields.free_count[0] < before
    copy_field(fields, 0, 2, 0)
    copy_field(fields, 0, 2, 1)
    assert fields.free_count[0] == fields.free.shape[1] - 1  # every tile is free again


def test_references_count_the_tables_that_name_a_tile() -> None:
    rng = np.random.default_rng(0)
    fields = empty_fields(1, 5, 64, 64)
    for _ in range(60):
        x, y = rng.uniform(0.2, 3.0, 2)
        register_points(fields, 0, int(rng.integers(5)), POSE, ORIGIN, 0.05, point(x, y, int(rng.integers(16))))
        copy_field(fields, 0, int(rng.integers(5)), int(rng.integers(5)))
    named = np.bincount(fields.table[0].ravel(), minlength=fields.references.shape[1])
    assert np.array_equal(named[1:], fields.references[0, 1:])
    assert fields.free_count[0] + (named[1:] > 0).sum() == fields.free.shape[1] - 1
    clear_fields(fields, 0)
    assert not dense(fields, 3).any()


def test_a_wall_is_invisible_from_behind() -> None:
    fields = empty_fields(1, 1, 32, 32)
    register_points(fields, 0, 0, POSE, ORIGIN, 0.05, point(0.775, 0.775, 4))
    cells, table = fields.tiles[0].reshape(-1), fields.table[0, 0]
    assert field_at(cells, table, 15, 15, 4) == pytest.approx(1.0, abs=5e-3)
    assert field_at(cells, table, 15, 15, 6) > 0.9
    assert field_at(cells, table, 15, 15, 12) == 0.0
    assert field_at(cells, table, -3, 15, 4) == field_at(cells, table, 400, 15, 4) == 0.0
