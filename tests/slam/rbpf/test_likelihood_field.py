"""The tiled, shared fields against one plain array a particle."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.rbpf.likelihood_field import (
    FULL,
    SECTORS,
    SIGMA,
    Fields,
    ParticleField,
    clear_fields,
    copy_field,
    empty_fields,
)
from lidarena.slam.rbpf.point_blocks import (
    CELLS,
    FACING,
    PointBlocks,
    Workspace,
    as_blocks,
    empty_workspaces,
    facing,
    gather_middle,
    locate,
)
from lidarena.slam.rbpf.registration import register_points
from tests.slam.rbpf.dense_field import dense

ORIGIN, POSE = np.zeros(2), np.zeros(3)
WORK = Workspace(*(rows[0] for rows in empty_workspaces(1)))


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


def point(x: float, y: float, sector: int) -> PointBlocks:
    angle = sector * 2 * math.pi / SECTORS
    return as_blocks(np.array([[x, y, math.cos(angle), math.sin(angle), float(sector)]]))


def register(fields: Fields, particle: int, x: float, y: float, sector: int) -> None:
    register_points(fields, 0, particle, POSE, ORIGIN, 0.05, point(x, y, sector), WORK)


def seen_at(fields: Fields, x: float, y: float, sector: int) -> float:
    """The field's value in the cell at (x, y), of walls that face ``sector``."""
    field = ParticleField(fields.tiles[0].reshape(-1), fields.table[0, 0], ORIGIN, 0.05)
    locate(point(x, y, sector).blocks.reshape(-1), 0, 1, POSE, 1.0, 0.0, field, WORK)
    gather_middle(field.cells, field.table.reshape(-1), 1, WORK.integers)
    return facing(WORK.integers[CELLS], WORK.integers[FACING]) / FULL


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
        register(fields, 0, x, y, sector)
    assert np.array_equal(dense(fields, 0), whole)
    assert not dense(fields, 1).any()


def test_copies_share_tiles_until_one_writes() -> None:
    fields = empty_fields(1, 3, 48, 48)
    register(fields, 0, 1.0, 1.0, 0)
    copy_field(fields, 0, 0, 1)
    before = fields.free_count[0]
    assert np.array_equal(dense(fields, 0), dense(fields, 1))
    original = dense(fields, 0).copy()
    register(fields, 1, 1.2, 1.0, 0)
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
        register(fields, int(rng.integers(5)), x, y, int(rng.integers(16)))
        copy_field(fields, 0, int(rng.integers(5)), int(rng.integers(5)))
    named = np.bincount(fields.table[0].ravel(), minlength=fields.references.shape[1])
    assert np.array_equal(named[1:], fields.references[0, 1:])
    assert fields.free_count[0] + (named[1:] > 0).sum() == fields.free.shape[1] - 1
    clear_fields(fields, 0)
    assert not dense(fields, 3).any()
