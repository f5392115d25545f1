"""Particles that share tiles against particles that each own a map: nothing ever leaks from one to another."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lidarena.slam.rbpf.likelihood_field import FULL, SECTORS, Fields, copy_field, empty_fields, own_tile, tiles_in_use
from lidarena.slam.rbpf.point_blocks import Workspace, as_blocks, empty_workspaces
from lidarena.slam.rbpf.registration import register_points
from tests.slam.rbpf.dense_field import dense
from tests.slam.rbpf.test_likelihood_field import register

PARTICLES = 4
PLACE = st.tuples(st.floats(0.02, 2.3), st.floats(0.02, 2.3), st.integers(0, 15))
WRITE = st.tuples(st.just("write"), st.integers(0, PARTICLES - 1), PLACE)
COPY = st.tuples(st.just("copy"), st.integers(0, PARTICLES - 1), st.integers(0, PARTICLES - 1))


def copied(fields: Fields) -> Fields:
    return Fields(*(array.copy() for array in fields))


@settings(max_examples=25, deadline=None)
@given(st.lists(st.one_of(WRITE, COPY), min_size=1, max_size=25))
def test_sharing_is_invisible(operations: list[tuple]) -> None:
    shared = empty_fields(1, PARTICLES, 48, 48)
    alone = [empty_fields(1, 1, 48, 48) for _ in range(PARTICLES)]
    for kind, first, second in operations:
        if kind == "write":
            register(shared, first, *second)
            register(alone[first], 0, *second)
        else:
            copy_field(shared, 0, first, second)
            alone[second] = copied(alone[first])
    for particle in range(PARTICLES):
        assert np.array_equal(dense(shared, particle), dense(alone[particle], 0))
    assert not shared.tiles[0, 0].any()  # the empty tile that all begin with stays empty


@settings(max_examples=25, deadline=None)
@given(st.lists(st.one_of(WRITE, COPY), max_size=20), st.integers(0, PARTICLES - 1), st.integers(0, 8))
def test_a_tile_that_is_owned_is_named_by_nobody_else(operations: list[tuple], particle: int, place: int) -> None:
    fields = empty_fields(1, PARTICLES, 48, 48)
    for kind, first, second in operations:
        if kind == "write":
            register(fields, first, *second)
        else:
            copy_field(fields, 0, first, second)
    before = [dense(fields, i).copy() for i in range(PARTICLES)]
    a, b = divmod(place, 3)
    tile = own_tile(fields, 0, particle, a, b)
    assert tile != 0 and (fields.table[0] == tile).sum() == 1 and fields.references[0, tile] == 1
    assert own_tile(fields, 0, particle, a, b) == tile
    assert tile < tiles_in_use(fields)
    for i in range(PARTICLES):
        assert np.array_equal(dense(fields, i), before[i])


def test_worlds_share_nothing() -> None:
    fields = empty_fields(2, 2, 32, 32)
    register(fields, 0, 0.7, 0.7, 2)
    assert not fields.tiles[1].any() and not fields.table[1].any() and not fields.references[1].any()


POSE = st.tuples(st.floats(0.8, 1.6), st.floats(0.8, 1.6), st.floats(-3.1, 3.1))


@settings(max_examples=60, deadline=None)
@given(POSE, st.floats(0.0, 0.6), st.floats(-3.1, 3.1), st.floats(-3.1, 3.1))
@example((1.5625, 0.95, 0.0), 0.0, 0.0, 0.0)
def test_a_point_is_stamped_where_it_is_seen_and_faces_where_it_faces(
    pose: tuple[float, float, float], away: float, bearing: float, normal: float
) -> None:
    fields, work = empty_fields(1, 1, 48, 48), Workspace(*(rows[0] for rows in empty_workspaces(1)))
    sector = normal * SECTORS / (2 * math.pi)
    point = [away * math.cos(bearing), away * math.sin(bearing), math.cos(normal), math.sin(normal), sector]
    arguments = (np.array(pose), np.zeros(2), 0.05, as_blocks(np.array([point])), work)
    register_points(fields, 0, 0, *arguments)
    field = dense(fields, 0)
    x, y = pose[0] + away * math.cos(bearing + pose[2]), pose[1] + away * math.sin(bearing + pose[2])
    row, column = math.floor(y / 0.05), math.floor(x / 0.05)
    if min(abs(place / 0.05 - round(place / 0.05)) for place in (x, y)) > 1e-6:  # not on a border of cells
        assert field[row, column] >> 4 == (field >> 4).max() > 0.9 * FULL * math.exp(-0.5 * (0.036 / 0.08) ** 2)
    facing = (sector + pose[2] * SECTORS / (2 * math.pi) + 0.5) % SECTORS
    if abs(facing - round(facing)) > 1e-6:
        assert set((field[field > 15] & 15).tolist()) == {math.floor(facing)}
    known = field.copy()
    register_points(fields, 0, 0, *arguments)  # a wall that is known is not stamped again
    assert np.array_equal(dense(fields, 0), known)


def test_more_tiles_than_there_could_be_are_never_needed() -> None:
    fields, rng = empty_fields(1, 3, 32, 32), np.random.default_rng(0)
    for _ in range(150):
        register(fields, int(rng.integers(3)), *rng.uniform(0.05, 1.5, 2), int(rng.integers(16)))
    assert fields.free_count[0] >= 0 and len(np.unique(fields.table[0])) <= fields.free.shape[1]
    assert fields.tiles.shape[1] == pytest.approx(3 * 4 + 1)
