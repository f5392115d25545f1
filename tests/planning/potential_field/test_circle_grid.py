import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import MapError
from lidarena.planning.potential_field.circle_grid import astar_path, grid_path
from lidarena.planning.potential_field.field_scene import make_scene
from tests.planning.potential_field.circle_scenes import clearance, length, scattered


def test_an_empty_room_is_crossed_straight():
    path = astar_path([], (0, 0), (30, 30))
    assert path[0].tolist() == [0, 0] and path[-1].tolist() == [30, 30]
    assert length(path) == pytest.approx(math.dist((0, 0), (30, 30)), rel=0.03)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.1, 1.0]), st.sampled_from([0.0, 1.0]))
def test_a_grid_path_is_free_all_along(seed, scale, radius):
    circles, start, goal = (c * scale for c in scattered(np.random.default_rng(seed), 40))
    path = astar_path(circles, start, goal, radius * scale)
    if len(path):
        assert path[0].tolist() == start.tolist() and path[-1].tolist() == goal.tolist()
        assert clearance(path, circles, radius * scale, spacing=0.02 * scale) > 0


def test_a_wall_with_a_gap_is_passed_and_without_it_is_not():
    wall = np.array([(20.0, y, 1.0) for y in np.arange(0.5, 40, 1.0) if not 18 < y < 23])
    bounds = (0, 0, 40, 40)
    path = astar_path(wall, (5, 5), (35, 5), 1.0, bounds)
    assert len(path) and clearance(path, wall, 1.0, bounds) > 0
    assert np.abs(path[np.argmin(np.abs(path[:, 0] - 20)), 1] - 20.5) < 3
    closed = np.array([(20.0, y, 1.0) for y in np.arange(0.5, 40, 1.0)])
    assert astar_path(closed, (5, 5), (35, 5), 1.0, bounds).shape == (0, 2)


def test_finer_grids_find_narrower_gaps():
    posts = np.array([(20.0, y, 0.9) for y in np.arange(-60, 100, 2.4)])
    scene = make_scene(posts, (0, 0), (40, 0), 0.0, (-10, -60, 90, 99))
    assert len(grid_path(scene, 0.5)) == 0 < len(grid_path(scene, 0.125))
    assert len(astar_path(posts, (0, 0), (40, 0), 0.0, (-10, -60, 90, 99)))


def test_clearance_can_be_worth_a_detour():
    circles = [(20.0, 3.0, 2.0), (20.0, -3.0, 2.0), (20, 20, 3.0)]
    scene = make_scene(circles, (0, 0), (40, 0))
    short, wide = grid_path(scene, 0.5), grid_path(scene, 0.5, 4.0, 20.0)
    assert length(short) < length(wide) and clearance(short, circles) < clearance(wide, circles)


def test_a_start_without_room_on_the_grid_has_no_path():
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    tight = np.column_stack([0.3 * np.cos(angles), 0.3 * np.sin(angles), np.full(12, 0.25)])
    assert astar_path(tight, (0, 0), (30, 0)).shape == (0, 2)


def test_bad_scenes_are_refused():
    with pytest.raises(MapError, match=r"goal .* inside"):
        astar_path([(5, 5, 1)], (0, 0), (5, 5))
