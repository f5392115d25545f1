"""Scenes of circles: what grows, by how much, and how large a room is held to be."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import MapError
from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.field_scene import FieldScene, make_scene
from tests.planning.potential_field.circle_scenes import scattered


def scenes(seed: int, robot: float, room: bool) -> FieldScene:
    rng = np.random.default_rng(seed)
    circles, start, goal = scattered(rng, 12)
    return make_scene(circles, start, goal, robot, (0, 0, 100, 100) if room else None)


def gaps(scene: FieldScene, point: np.ndarray) -> np.ndarray:
    """From a point to every disc and then to the four walls, written out."""
    discs = [float(np.hypot(point[0] - x, point[1] - y)) - radius for x, y, radius in scene.discs]
    x0, y0, x1, y1 = scene.walls
    return np.array([*discs, point[0] - x0, point[1] - y0, x1 - point[0], y1 - point[1]])


SEED, ROBOT = st.integers(0, 10**6), st.sampled_from([0.0, 0.5, 2.0])


@settings(max_examples=60, deadline=None)
@given(SEED, ROBOT, st.booleans())
def test_obstacles_grow_by_the_robot_and_the_room_shrinks_by_it(seed: int, robot: float, room: bool) -> None:
    point, grown = scenes(seed, 0.0, room), scenes(seed, robot, room)
    np.testing.assert_allclose(grown.discs - point.discs, [[0.0, 0.0, robot]] * len(point.discs), atol=1e-12)
    if room:
        np.testing.assert_array_equal(grown.walls, [robot, robot, 100 - robot, 100 - robot])
    else:
        assert np.isinf(grown.walls).all()
    assert grown.goal_gap == pytest.approx(gaps(grown, grown.goal).min())


@settings(max_examples=60, deadline=None)
@given(SEED, ROBOT, st.booleans(), st.floats(0.0, 12.0))
def test_a_clearance_is_kept_from_all_but_what_start_or_goal_is_nearer_to(
    seed: int, robot: float, room: bool, clearance: float
) -> None:
    scene = scenes(seed, robot, room)
    discs, walls = scene.keeping(clearance)
    drawn_in = np.abs(walls - scene.walls) if room else np.full(4, clearance)  # no walls to keep away from
    grown = np.concatenate([discs[:, 2] - scene.discs[:, 2], drawn_in])
    room_there = np.minimum(gaps(scene, scene.start), gaps(scene, scene.goal))
    far = room_there * 0.999 > clearance
    np.testing.assert_allclose(grown[far], clearance, atol=1e-12)
    assert (grown[~far] <= room_there[~far]).all() and (grown[~far] > 0.99 * room_there[~far]).all()
    np.testing.assert_array_equal(discs[:, :2], scene.discs[:, :2])


@settings(max_examples=60, deadline=None)
@given(SEED, ROBOT, st.floats(0.0, 12.0))
def test_start_and_goal_stay_free_whatever_is_kept(seed: int, robot: float, clearance: float) -> None:
    scene = scenes(seed, robot, True)
    kept = scene.narrowed(scene.keeping(clearance))
    for point in (kept.start, kept.goal):
        assert segment_is_free(*point, *point, kept.discs, kept.walls, np.zeros(1, np.int64))
    np.testing.assert_array_equal(kept.start, scene.start)
    np.testing.assert_array_equal(kept.goal, scene.goal)


def test_what_a_robot_touches_does_not_grow() -> None:
    """A start in the corner of its room, as Yang et al.'s, has no clearance from two walls and keeps none."""
    scene = make_scene([(5, 5, 1)], (0, 0), (9, 3), 0.0, (0, 0, 10, 10))
    discs, walls = scene.keeping(2.0)
    assert walls.tolist() == [0.0, 0.0, 10 - 0.999, 10 - 2.0]
    assert discs[0, 2] == 3.0


@pytest.mark.parametrize("side", [100.0, 31.7, 31.5, 10.0, 316.0, 317.0, 0.1])
def test_a_room_is_measured_by_its_longer_side(side: float) -> None:
    ends = (0.1 * side, 0.1 * side), (0.15 * side, 0.2 * side)
    for bounds in ((0, 0, side, 0.3 * side), (0, 0, 0.3 * side, side)):
        for radius in (0.0, 0.02 * side):  # that is what a large robot leaves of the room
            assert make_scene([], *ends, radius, bounds).scale == pytest.approx(side / 100)


def test_a_small_robot_in_a_large_hall_is_measured_itself() -> None:
    hall = (0, 0, 1000, 1000)
    scales = [make_scene([], (100, 100), (900, 900), radius, hall).scale for radius in (0.1, 0.5, 1.0, 2.0)]
    assert scales == pytest.approx([1.0, 5.0, 10.0, 10.0])


def test_lengths_have_no_step_where_the_decade_of_the_side_changes() -> None:
    ends = (10, 10), (300, 300)
    below, above = (make_scene([], *ends, 0.0, (0, 0, side, side)).scale for side in (316.2, 316.3))
    assert 1.0 < above / below < 1.001


def test_without_a_room_what_there_is_is_measured() -> None:
    assert make_scene([], (0, 0), (90, 3)).scale == pytest.approx(0.9)
    assert make_scene([(170, 0, 5)], (0, 0), (90, 3)).scale == pytest.approx(1.7)
    assert make_scene([(400, 0, 5)], (0, 0), (90, 3)).scale == pytest.approx(0.9)  # too far away to matter
    assert make_scene([], (3, 3), (3, 3)).scale == 1.0


def test_no_circles_are_allowed_in_any_form() -> None:
    for nothing in ([], np.empty((0, 3)), ()):
        scene = make_scene(nothing, (0, 0), (1, 1))
        assert scene.discs.shape == (0, 3) and scene.goal_gap == np.inf


def test_the_callers_circles_stay_as_they_are() -> None:
    circles = np.array([(5.0, 5.0, 1.0)])
    make_scene(circles, (0, 0), (9, 9), 0.7).keeping(1.0)
    assert circles.tolist() == [[5.0, 5.0, 1.0]]


def test_columns_that_were_turned_into_rows_are_laid_out_for_the_kernels() -> None:
    rows = np.array([(5.0, 5.0, 1.0), (8.0, 2.0, 0.5)])
    turned = np.array([rows[:, 0], rows[:, 1], rows[:, 2]]).T  # else kernels are compiled anew, for ten seconds
    found = make_scene(turned, (0, 0), (9, 9))
    assert found.discs.tolist() == rows.tolist() and found.discs.flags.c_contiguous


def test_a_start_that_touches_an_obstacle_is_said_to_touch_it() -> None:
    with pytest.raises(MapError, match=r"the start \(4, 5\) touches the obstacle at \(5, 5\)"):
        make_scene([(5, 5, 1)], (4, 5), (9, 9))
