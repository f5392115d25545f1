"""Compute is counted: more of anything costs more, and SIFT more than corners."""

import pytest

from lidarena.envs.seabed.compute import detection_cost, effort_cost
from lidarena.vision.features import FeatureOptions
from lidarena.vision.odometry import Effort


def test_more_work_costs_more() -> None:
    tracks = FeatureOptions(kind="tracks")
    costs = [effort_cost(tracks, Effort(*work)) for work in ((0, 0, 0), (100, 0, 0), (100, 90, 0), (100, 90, 1))]
    assert costs[0] == 0.0 and costs == sorted(set(costs))


def test_sift_costs_more_than_corners_and_large_pictures_more_than_small_ones() -> None:
    sift, tracks = (detection_cost(FeatureOptions(kind=kind), 600, 400) for kind in ("sift", "tracks"))
    assert sift > 2.0 * tracks > 0.0
    small, large = (detection_cost(FeatureOptions(), *size) for size in ((600, 400), (800, 600)))
    assert large == pytest.approx(2.0 * small)
