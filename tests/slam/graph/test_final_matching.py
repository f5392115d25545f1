"""Scans that are no nodes are brought to where they were taken."""

import numpy as np

from lidarena.slam.graph.final_matching import match_with_nodes
from tests.slam.graph.test_point_to_line import FAN, room_ranges, scans

NODES = np.array([[0.0, 0.0, 0.0], [0.4, 0.1, 0.3], [0.8, -0.1, -0.2]])
STORE = scans(*[(float(x), float(y), float(t)) for x, y, t in NODES], (0.0, 0.0, 0.0))


def matched(ranges: np.ndarray, poses: np.ndarray) -> np.ndarray:
    moved = poses.copy()
    match_with_nodes(STORE, FAN, 3, ranges, 20.0, moved, NODES, np.arange(3))
    return moved


def test_they_are_moved_to_where_they_were_taken() -> None:
    truth = np.array([[0.2, 0.1, 0.1], [0.6, 0.0, -0.1]])
    ranges = np.stack([room_ranges((float(x), float(y), float(t))) for x, y, t in truth])
    moved = matched(ranges, truth + np.array([0.04, -0.03, 0.02]))
    assert np.abs(moved - truth).max() < 0.005


def test_what_fits_nothing_or_is_far_from_all_nodes_stays() -> None:
    poses = np.array([[0.2, 0.1, 0.1], [9.0, 9.0, 0.0], [0.1, 0.0, 3.0]])
    ranges = np.stack([np.zeros(FAN.beams, np.float32), room_ranges((0.0, 0.0, 0.0)), room_ranges((0.1, 0.0, 0.0))])
    np.testing.assert_array_equal(matched(ranges, poses), poses)
