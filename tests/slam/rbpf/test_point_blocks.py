"""Blocks of points one by one: where each falls, what it faces, and which cells are around it."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.rbpf.likelihood_field import SECTORS, TILE, ParticleField, empty_fields
from lidarena.slam.rbpf.point_blocks import (
    AWAY_X,
    AWAY_Y,
    BLOCK,
    CELLS,
    FACING,
    NEXT,
    PLACE,
    ROW,
    WHICH_TILE,
    U,
    V,
    Workspace,
    as_blocks,
    empty_workspaces,
    facing,
    gather_around,
    gather_middle,
    locate,
)
from tests.slam.rbpf.dense_field import dense
from tests.slam.rbpf.test_likelihood_field import register

A, B, RES = 3, 4, 0.05  # tiles up and across
SEED = st.integers(0, 10**6)
POSE = st.tuples(st.floats(-0.5, 4.0), st.floats(-0.5, 3.0), st.floats(-6.0, 6.0))


def random_points(seed: int, count: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    normal = rng.uniform(-math.pi, math.pi, count)
    place = rng.uniform(-1.5, 1.5, (count, 2))
    sector = normal * SECTORS / (2 * math.pi)
    return np.column_stack([place, np.cos(normal), np.sin(normal), sector])


@settings(max_examples=30, deadline=None)
@given(SEED, st.integers(0, 100))
def test_blocks_hold_every_point_once_and_zeros_behind_them(seed: int, count: int) -> None:
    points = random_points(seed, count)
    blocks, kept = as_blocks(points)
    assert kept == count
    assert blocks.shape == (max(math.ceil(count / BLOCK), 1), 5, BLOCK)
    rows = blocks.transpose(0, 2, 1).reshape(-1, 5)
    np.testing.assert_array_equal(rows[:count], points)
    assert not rows[count:].any()


def located(points: np.ndarray, block: int, pose: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray, int]:
    work = Workspace(*(rows[0] for rows in empty_workspaces(1)))
    field = ParticleField(np.zeros(0, np.uint16), np.zeros((A, B), np.int32), origin, RES)
    count = min(BLOCK, len(points) - block * BLOCK)
    numbers = as_blocks(points).blocks.reshape(-1)
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    locate(numbers, block, count, pose, cos, sin, field, work)
    return work.reals, work.integers, count


@settings(max_examples=40, deadline=None)
@given(SEED, st.integers(1, 90), POSE, st.integers(0, 2))
def test_each_point_falls_where_the_pose_puts_it(seed: int, count: int, at: tuple[float, ...], block: int) -> None:
    points, pose, origin = random_points(seed, count), np.array(at), np.array([0.2, -0.3])
    block = min(block, (count - 1) // BLOCK)
    reals, integers, here = located(points, block, pose, origin)
    for i in range(here):
        x, y, _, _, sector = points[block * BLOCK + i]
        px, py = x * math.cos(pose[2]) - y * math.sin(pose[2]), x * math.sin(pose[2]) + y * math.cos(pose[2])
        u, v = (pose[0] + px - origin[0]) / RES, (pose[1] + py - origin[1]) / RES
        np.testing.assert_allclose((reals[int(AWAY_X) + i], reals[int(AWAY_Y) + i]), (px, py), atol=1e-12)
        allowed = integers[int(FACING) + i]
        if not (0 <= u < B * TILE and 0 <= v < A * TILE):
            assert allowed == 0 or min(abs(u), abs(v), abs(u - B * TILE), abs(v - A * TILE)) < 1e-6
            continue
        assert math.isclose(reals[int(U) + i], u, abs_tol=1e-9) and math.isclose(reals[int(V) + i], v, abs_tol=1e-9)
        column, row = int(reals[int(U) + i]), int(reals[int(V) + i])
        assert integers[int(WHICH_TILE) + i] == row // TILE * B + column // TILE
        assert integers[int(PLACE) + i] == row % TILE * (TILE + 2) + column % TILE
        towards = sector + pose[2] * SECTORS / (2 * math.pi) + 0.5
        if abs(towards - round(towards)) > 1e-9:
            near = {(math.floor(towards) + k) % SECTORS for k in range(-4, 5)}
            assert {k for k in range(SECTORS) if allowed >> k & 1} == near


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**16 - 1), st.integers(0, 2**16 - 1))
def test_a_wall_counts_only_if_it_faces_an_allowed_sector(cell: int, allowed: int) -> None:
    expected = cell >> 4 if allowed >> (cell & 15) & 1 else 0
    assert facing(np.int32(cell), np.int32(allowed)) == expected


@settings(max_examples=20, deadline=None)
@given(SEED, st.integers(1, BLOCK), POSE)
def test_the_cells_around_a_point_are_read_across_tiles(seed: int, count: int, at: tuple[float, ...]) -> None:
    fields, rng = empty_fields(1, 1, A * TILE, B * TILE), np.random.default_rng(seed)
    for _ in range(8):
        register(fields, 0, rng.uniform(0, B * TILE * RES), rng.uniform(0, A * TILE * RES), int(rng.integers(16)))
    whole = np.pad(dense(fields, 0), 1)
    reals, integers, here = located(random_points(seed, count), 0, np.array(at), np.zeros(2))
    cells, names = fields.tiles[0].reshape(-1), fields.table[0, 0].reshape(-1)
    windows = []
    for i in range(here):
        row, column = int(reals[int(V) + i]), int(reals[int(U) + i])
        windows.append(whole[row : row + 3, column : column + 3])
    gather_around(cells, names, here, integers)
    for i, window in enumerate(windows):
        first = int(CELLS) + i
        found = [[integers[first + int(ROW) * r + int(NEXT) * c] for c in range(3)] for r in range(3)]
        np.testing.assert_array_equal(found, window)
    gather_middle(cells, names, here, integers)
    assert integers[int(CELLS) : int(CELLS) + here].tolist() == [int(window[1, 1]) for window in windows]
