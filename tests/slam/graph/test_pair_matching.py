"""Pairs matched together are matched as each alone."""

import numpy as np

from lidarena.slam.graph.pair_matching import PAIR_COLUMNS, match_pairs
from lidarena.slam.graph.point_to_line import add_pair
from tests.slam.graph.test_point_to_line import FAN, scans


def test_pairs_are_matched_as_each_alone() -> None:
    store = scans((0, 0, 0), (0.2, 0.1, 0.1), (0.3, 0.0, 0.2))
    pairs, motions = np.array([[0, 1], [1, 2]]), np.array([[0.2, 0.1, 0.1], [0.1, -0.1, 0.1]])
    systems = np.zeros((2, PAIR_COLUMNS))
    match_pairs(store, FAN, pairs, motions, 0.3, 1, systems)
    for pair, motion, system in zip(pairs, motions, systems, strict=True):
        alone = np.zeros(PAIR_COLUMNS)
        add_pair(store, FAN, pair[1], pair[0], motion, 0.3, 1, alone)
        np.testing.assert_array_equal(system, alone)
