"""Scan after scan: what wheels get wrong is mended, and what cannot be matched is told."""

import numpy as np

from lidarena.slam.graph.front_end import FrontEnd
from lidarena.slam.planar import between
from tests.slam.graph.test_point_to_line import FAN, room_ranges


def test_a_turn_that_slips_by_thirty_degrees_is_mended() -> None:
    front = FrontEnd(FAN)
    front.add(np.zeros(3), room_ranges((0.5, 0.3, 0.0)))
    for k in range(1, 5):
        front.add(np.array([0.0, 0.0, 0.2 * k]), room_ranges((0.5, 0.3, 0.2 * k)))
    front.add(np.array([0.0, 0.0, 0.8 + 0.52]), room_ranges((0.5, 0.3, 0.8)))
    np.testing.assert_allclose(between(front.poses[0], front.poses[-1]), [0.0, 0.0, 0.8], atol=0.02)
    assert not any(front.held)


def test_keyframes_are_spaced_by_way_and_turn() -> None:
    front = FrontEnd(FAN)
    kept = [front.add(np.array([x, 0.0, 0.0]), room_ranges((x, 0.0, 0.0))) for x in (0.0, 0.1, 0.2, 0.3, 0.4)]
    assert kept == [True, False, False, True, False] and front.keyframes == [0, 3]
    assert front.add(np.array([0.4, 0.0, 0.2]), room_ranges((0.4, 0.0, 0.2)))


def test_a_scan_of_another_place_is_not_believed() -> None:
    front = FrontEnd(FAN)
    front.add(np.zeros(3), room_ranges((0.0, 0.0, 0.0), 20.0, 20.0))
    front.add(np.array([0.1, 0.0, 0.0]), room_ranges((0.0, 0.0, 0.0), 4.0, 4.0))
    assert front.held == [False, True]
    np.testing.assert_allclose(front.poses[1], [0.1, 0.0, 0.0])


def test_the_heading_does_not_drift_along_a_corridor() -> None:
    front = FrontEnd(FAN)
    for k in range(60):
        x = -12.0 + 0.2 * k
        ranges = room_ranges((x, 0.25, 0.0), 60.0, 2.0)
        noise = np.random.default_rng(k).normal(0.0, 0.01, FAN.beams)
        front.add(np.array([0.2 * k, 0.0, -0.01 * k]), (ranges + noise).astype(np.float32))
    assert abs(front.poses[-1][2]) < 0.01


def test_without_wheels_the_way_goes_on_as_before() -> None:
    front = FrontEnd(FAN)
    for k in range(12):
        pose = (-1.5 + 0.2 * k, 0.3, 0.05 * k)
        front.add(np.zeros(3), room_ranges(pose), unsure=k > 0)
    first, last = np.array([-1.5, 0.3, 0.0]), np.array([0.7, 0.3, 0.55])
    np.testing.assert_allclose(between(front.poses[0], front.poses[-1]), between(first, last), atol=0.03)


def test_only_keyframes_are_stored() -> None:
    front = FrontEnd(FAN)
    for _ in range(300):
        front.add(np.zeros(3), room_ranges((0.0, 0.0, 0.0)))
    assert front.keyframes == [0] and len(front.store.points) == 256 and front.count == 300


def test_wheels_that_count_backwards_as_forwards_are_mended() -> None:
    front = FrontEnd(FAN)
    for k in range(8):
        front.add(np.array([0.3 * k, 0.0, 0.0]), room_ranges((1.0 - 0.3 * k, 0.3, 0.1), 6.0, 14.0))
    moved = [-2.1 * np.cos(0.1), 2.1 * np.sin(0.1), 0.0]
    np.testing.assert_allclose(between(front.poses[0], front.poses[-1]), moved, atol=0.03)
    assert min(front.shares[1:]) > 0.5
