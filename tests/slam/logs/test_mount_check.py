"""On which side of the robot a laser sits."""

import numpy as np
import pytest

from lidarena.slam.logs.mount_check import checked_mount, measured_offset
from lidarena.slam.planar import compose


def driven(n: int = 600) -> np.ndarray:
    rng = np.random.default_rng(0)
    motions = np.stack([np.full(n, 0.01), np.zeros(n), np.repeat(rng.choice([-0.1, 0.1], n // 10), 10)], axis=1)
    poses = [np.zeros(3)]
    for motion in motions:
        poses.append(compose(poses[-1], motion))
    return np.array(poses)


@pytest.mark.parametrize("ahead", [-0.3, -0.04, 0.0, 0.04, 0.3])
def test_the_offset_is_measured(ahead: float) -> None:
    robot = driven()
    laser = compose(robot, np.array([ahead, 0.0, 0.0]))
    noise = np.random.default_rng(1).normal(0.0, [0.002, 0.002, 0.001], laser.shape)
    assert measured_offset(robot, laser + noise) == pytest.approx(ahead, abs=0.01)


def test_a_laser_on_the_wrong_side_is_put_right_and_told() -> None:
    robot = driven()
    laser = compose(robot, np.array([-0.05, 0.0, 0.0]))
    mount, told = checked_mount(np.array([0.05, 0.0, 0.0]), robot, laser)
    np.testing.assert_allclose(mount, [-0.05, 0.0, 0.0])
    assert told is not None and "0.05 m ahead of the robot's centre" in told and "0.05 m behind it is taken" in told


@pytest.mark.parametrize("mount", [(0.0, 0.0, 0.0), (0.05, 0.0, 0.0), (0.2, 0.0, 0.0), (0.05, 0.2, 0.0), (-0.05, 0, 1)])
def test_other_mounts_are_left_alone(mount: tuple[float, float, float]) -> None:
    robot, told_by_log = driven(), np.array(mount)
    laser = compose(robot, np.array([0.04, 0.0, 0.0]))
    kept, told = checked_mount(told_by_log, robot, laser)
    np.testing.assert_array_equal(kept, told_by_log)
    assert told is None


def test_a_robot_that_hardly_turns_tells_nothing() -> None:
    straight = np.stack([0.1 * np.arange(100.0), np.zeros(100), np.zeros(100)], axis=1)
    assert measured_offset(straight, straight) is None
