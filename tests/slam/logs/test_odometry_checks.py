"""What no robot can have driven is found and taken out; what it can have driven is left to the bit."""

import numpy as np
import pytest

from lidarena.slam.logs.odometry_checks import checked_odometry
from lidarena.slam.planar import between, compose

STEPS = np.column_stack([np.full(400, 0.05), np.zeros(400), 0.02 * np.sin(np.arange(400) / 15)])
WAY = np.tile([5.0, 3.0, 0.4], (401, 1))
for _k, _step in enumerate(STEPS):
    WAY[_k + 1] = compose(WAY[_k], _step)
TIMES = 1e9 + 0.1 * np.arange(401)


def test_plausible_odometry_is_left_alone() -> None:
    found = checked_odometry(TIMES, WAY)
    np.testing.assert_array_equal(found.poses, WAY)
    assert not found.unsure.any() and not found.notes


def test_odometry_that_never_moves_is_told() -> None:
    found = checked_odometry(TIMES, np.zeros((401, 3)))
    assert found.unsure[1:].all() and "never moved" in found.notes[0]


def test_lines_of_zeros_are_put_between_their_neighbours() -> None:
    poses = WAY.copy()
    poses[200] = poses[300:304] = 0.0
    found = checked_odometry(TIMES, poses)
    np.testing.assert_allclose(found.poses, WAY, atol=5e-3)
    assert not found.unsure.any() and found.notes == (
        "5 odometry readings are far off those around them; they were put between these",
    )


def test_after_a_reset_the_way_goes_on_and_the_place_is_marked() -> None:
    poses = WAY.copy()
    poses[200:] = between(np.broadcast_to(WAY[200], (201, 3)), WAY[200:])
    found = checked_odometry(TIMES, poses)
    assert np.flatnonzero(found.unsure).tolist() == [200]
    np.testing.assert_allclose(found.poses[:200], WAY[:200])
    np.testing.assert_allclose(between(found.poses[200:-1], found.poses[201:]), STEPS[200:], atol=1e-9)
    np.testing.assert_allclose(found.poses[200], WAY[199])


def test_a_jump_of_five_metres_is_marked_and_taken_out() -> None:
    poses = WAY.copy()
    poses[100:, 0] += 5.0
    found = checked_odometry(TIMES, poses)
    assert np.flatnonzero(found.unsure).tolist() == [100]
    assert "jumps by 5." in found.notes[0] and "reading 101" in found.notes[0]
    np.testing.assert_allclose(between(found.poses[100:-1], found.poses[101:]), STEPS[100:], atol=1e-9)


def test_a_robot_that_was_carried_about_is_likely_torn() -> None:
    poses = WAY.copy()
    for place in (50, 120, 200, 280, 350):
        poses[place:, :2] += (7.0, -3.0)
    found = checked_odometry(TIMES, poses)
    assert found.unsure.sum() == 5 and "2 more jumps" in found.notes[-1]


@pytest.mark.parametrize("units", [(100.0, 100.0, 1.0), (1000.0, 1000.0, 1.0), (1.0, 1.0, 180.0 / np.pi)])
def test_odometry_in_other_units_is_left_out_and_told(units: tuple[float, float, float]) -> None:
    turns = np.cumsum(np.random.default_rng(0).normal(0.0, 0.2, 400))
    way = np.column_stack([np.cumsum(0.1 * np.cos(turns)), np.cumsum(0.1 * np.sin(turns)), turns])
    times = 0.2 * np.arange(400)
    assert not checked_odometry(times, way).notes
    checked = checked_odometry(times, way * units)
    assert checked.unsure[1:].all() and not checked.unsure[0]
    assert np.ptp(checked.poses, axis=0).max() == 0.0
    assert "is it in metres and radians?" in checked.notes[0]
