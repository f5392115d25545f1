"""The picture of the map around the robot, pixel by pixel."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.envs.exploration.observations import PICTURE, PICTURE_CELL, crop_maps

ROWS, COLUMNS, CELL = 50, 70, 0.05
POSE = st.tuples(st.floats(-1.0, 4.0), st.floats(-1.0, 3.5), st.floats(-math.pi, math.pi))


def patches(seed: int) -> np.ndarray:
    return np.kron(np.random.default_rng(seed).choice([-1, 0, 0, 100], (10, 14)), np.ones((5, 5))).astype(np.int8)


def picture(occupancy: np.ndarray, pose: tuple[float, float, float], origin: tuple[float, float]) -> np.ndarray:
    drawn = np.full((1, 3, PICTURE, PICTURE), 7, np.uint8)
    crop_maps(occupancy[None], np.array([origin]), np.array([pose]), drawn)
    return drawn[0]


def slow_pixel(
    occupancy: np.ndarray, pose: tuple[float, float, float], origin: tuple[float, float], i: int, j: int
) -> list[int]:
    """Wall, free, unknown of pixel (i, j): row 0 lies ahead, column 0 to the left."""
    ahead, left = ((PICTURE / 2 - 0.5 - k) * PICTURE_CELL for k in (i, j))
    x = pose[0] + ahead * math.cos(pose[2]) - left * math.sin(pose[2]) - origin[0]
    y = pose[1] + ahead * math.sin(pose[2]) + left * math.cos(pose[2]) - origin[1]
    held = []
    for dx, dy in ((-1, -1), (1, -1), (-1, 1), (1, 1)):
        c, r = math.floor((x + dx * CELL / 2) / CELL), math.floor((y + dy * CELL / 2) / CELL)
        held.append(int(occupancy[r, c]) if 0 <= r < ROWS and 0 <= c < COLUMNS else -1)
    return [255, 0, 0] if 100 in held else [0, 255, 0] if 0 in held else [0, 0, 255]


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), POSE)
def test_each_pixel_shows_the_cells_that_it_holds(seed: int, pose: tuple[float, float, float]) -> None:
    occupancy, origin = patches(seed), (0.3, -0.2)
    drawn = picture(occupancy, pose, origin)
    expected = [[slow_pixel(occupancy, pose, origin, i, j) for j in range(PICTURE)] for i in range(PICTURE)]
    differing = (drawn.transpose(1, 2, 0) != np.array(expected)).any(axis=2)
    assert differing.sum() <= 2  # a pixel that lies on the border of a cell to the last bit
    assert (drawn.astype(int).sum(axis=0) == 255).all()  # each pixel is one of the three


def test_what_lies_ahead_is_above_and_what_lies_left_is_left() -> None:
    occupancy = np.zeros((ROWS, COLUMNS), np.int8)
    occupancy[24:26, 60:62] = 100  # at x = 3.05, y = 1.25
    for heading, (row, column) in {
        0.0: (20, 31),
        math.pi / 2: (31, 42),
        math.pi: (42, 31),
        -math.pi / 2: (31, 20),
    }.items():
        wall = np.argwhere(picture(occupancy, (1.95, 1.25, heading), (0.0, 0.0))[0] == 255)
        assert np.abs(wall - (row, column)).max() <= 2, heading


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), POSE, st.floats(-80, 80), st.floats(-80, 80))
def test_where_the_map_lies_does_not_matter(
    seed: int, pose: tuple[float, float, float], east: float, north: float
) -> None:
    occupancy = patches(seed)
    here = picture(occupancy, pose, (0.0, 0.0))
    there = picture(occupancy, (pose[0] + east, pose[1] + north, pose[2]), (east, north))
    assert (here != there).any(axis=0).mean() < 0.01  # but for roundings


def test_worlds_are_drawn_by_themselves() -> None:
    maps = np.stack([patches(1), patches(2)])
    poses, origins = np.array([[1.0, 1.0, 0.3], [2.0, 0.5, -2.0]]), np.array([[0.0, 0.0], [0.5, 0.1]])
    drawn = np.zeros((2, 3, PICTURE, PICTURE), np.uint8)
    crop_maps(maps, origins, poses, drawn)
    for w in (0, 1):
        assert np.array_equal(drawn[w], picture(maps[w], tuple(poses[w].tolist()), tuple(origins[w].tolist())))
