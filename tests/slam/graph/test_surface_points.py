"""Scans as points with normals."""

import numpy as np

from lidarena.slam.graph.surface_points import empty_points, enlarged_points, enter_scan
from tests.slam.graph.test_point_to_line import FAN, room_ranges


def test_points_lie_where_the_beams_ended_and_normals_look_at_the_laser() -> None:
    store = empty_points(1, FAN.beams)
    assert enter_scan(store, 0, room_ranges((0, 0, 0)), FAN, 20.0) == FAN.beams
    np.testing.assert_allclose(store.points[0, 90], [3.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(store.normals[0, 90], [-1.0, 0.0], atol=1e-5)
    np.testing.assert_allclose(store.normals[0, 5], [0.0, 1.0], atol=1e-3)
    assert store.weights[0, 90] > 0.95


def test_what_is_no_return_or_too_far_is_no_point() -> None:
    ranges = np.full(FAN.beams, 2.0, np.float32)
    ranges[:4] = [0.0, np.nan, 25.0, -1.0]
    store = empty_points(1, FAN.beams)
    assert enter_scan(store, 0, ranges, FAN, 20.0) == FAN.beams - 4
    assert (store.weights[0, :4] == 0.0).all()


def test_lone_points_and_clutter_say_little() -> None:
    ranges = np.full(FAN.beams, 2.0, np.float32)
    ranges[50] = 1.0
    store = empty_points(1, FAN.beams)
    enter_scan(store, 0, ranges, FAN, 20.0)
    assert store.weights[0, 50] <= np.float32(0.2) and (store.normals[0, 50] == 0.0).all()


def test_room_for_more_keeps_what_there_is() -> None:
    store = empty_points(1, FAN.beams)
    enter_scan(store, 0, room_ranges((0, 0, 0)), FAN, 20.0)
    more = enlarged_points(store)
    assert more.points.shape == (2, FAN.beams, 2)
    np.testing.assert_array_equal(more.points[0], store.points[0])


def test_walls_far_ahead_of_a_corridor_have_normals() -> None:
    store = empty_points(1, FAN.beams)
    enter_scan(store, 0, room_ranges((0, 0, 0), 40.0, 2.0), FAN, 20.0)
    far = (np.abs(store.points[0, :, 0]) > 6.0) & (np.abs(store.points[0, :, 0]) < 12.0)
    assert far.sum() >= 6
    np.testing.assert_allclose(np.abs(store.normals[0, far, 1]), 1.0, atol=1e-3)
    assert (store.weights[0, far] > 0.9).all() and (store.extents[0, far] > 0.3).all()


def test_surfaces_end_at_a_jump_of_the_range() -> None:
    ranges = np.full(FAN.beams, 4.0, np.float32)
    ranges[:90] = 2.0
    store = empty_points(1, FAN.beams)
    enter_scan(store, 0, ranges, FAN, 20.0)
    for beam in (89, 90):
        outward = store.points[0, beam] / np.linalg.norm(store.points[0, beam])
        assert float(outward @ store.normals[0, beam]) < -0.98
