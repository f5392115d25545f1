"""Flights keep to their lanes, speed and depth, and are their generator's."""

import numpy as np

from lidarena.envs.seabed.flights import LANE, SPACING, fly, survey_area, survey_lanes


def test_a_flight_follows_the_lanes_at_its_speed() -> None:
    found = fly(np.random.default_rng(0), 3001, 25.0, 0.5, 5.0)
    path = np.linalg.norm(np.diff(found.planar[:, :2], axis=0), axis=1).sum()
    assert 0.6 * 60 < path < 1.05 * 60
    x_min, y_min, x_max, y_max = survey_area(60.0)
    assert (found.planar[:, 0] > x_min - 1).all() and (found.planar[:, 0] < x_max + 1).all()
    assert (found.planar[:, 1] > y_min - 1).all() and (found.planar[:, 1] < y_max + 1).all()
    assert abs(found.poses[:, 2, 3] - 5.0).max() < 0.4 and found.poses[:, 2, 3].std() > 0.01


def test_the_camera_looks_down_and_trembles() -> None:
    poses = fly(np.random.default_rng(1), 500, 25.0, 0.5, 5.0).poses
    tilt = np.degrees(np.arccos(-poses[:, 2, 2]))
    assert 0.2 < tilt.max() < 10.0
    steps = np.degrees(np.abs(np.diff(tilt)))
    assert steps.max() < 60.0  # smooth: less than a degree a frame
    assert np.abs(np.diff(tilt)).max() < 0.5


def test_a_seed_is_a_flight() -> None:
    one, two, other = (fly(np.random.default_rng(seed), 100, 25.0, 0.5, 5.0) for seed in (3, 3, 4))
    assert np.array_equal(one.poses, two.poses) and np.array_equal(one.attitudes, two.attitudes)
    assert not np.array_equal(one.poses, other.poses)
    assert np.array_equal(one.positions[0], np.zeros(3))


def test_lanes_go_to_and_fro() -> None:
    corners = survey_lanes(50.0)
    assert corners[:5].tolist() == [[0, 0], [LANE, 0], [LANE, SPACING], [0, SPACING], [0, 2 * SPACING]]
    assert survey_area(10.0) == (-1.0, -1.0, LANE + 1.0, 1.0)
