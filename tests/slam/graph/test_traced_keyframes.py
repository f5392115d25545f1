"""Keyframes that have moved leave the same map as keyframes that were there from the beginning."""

import numpy as np
import pytest

from lidarena.slam.estimator import MapGrid, ScanSpec
from lidarena.slam.graph.traced_keyframes import TracedKeyframes

ANGLES = np.arange(90) * (2 * np.pi / 90)
SPEC = ScanSpec(ANGLES, 3.5, 0.01)
GRID = MapGrid(np.array([-4.0, -4.0]), 0.05, (160, 160))


@pytest.mark.parametrize("seed", range(3))
def test_a_map_does_not_remember_where_its_scans_were(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scans = rng.uniform(0.5, 4.0, (6, len(ANGLES))).astype(np.float32)
    before, after = rng.uniform(-1.0, 1.0, (2, 6, 3))
    moved, fresh = TracedKeyframes(GRID, SPEC), TracedKeyframes(GRID, SPEC)
    for scan, first, last in zip(scans, before, after, strict=True):
        moved.add(scan, first)
        fresh.add(scan, last)
    assert (moved.occupancy != fresh.occupancy).any()
    moved.move(after)
    np.testing.assert_array_equal(moved.occupancy, fresh.occupancy)


def test_what_hardly_moved_is_left_alone() -> None:
    traced = TracedKeyframes(GRID, SPEC)
    traced.add(np.full(len(ANGLES), 2.0, np.float32), np.zeros(3))
    shown = traced.occupancy.copy()
    traced.move(np.array([[0.004, -0.004, 0.001]]))
    np.testing.assert_array_equal(traced.occupancy, shown)
