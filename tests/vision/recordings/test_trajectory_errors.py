"""Errors of trajectories are those of KITTI's program and of evo, worked out by hand or anew."""

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from lidarena.base.errors import VisionError
from lidarena.vision.recordings.trajectory_errors import (
    absolute_error,
    kitti_errors,
    path_lengths,
    relative_pose_errors,
    trajectory_errors,
)
from lidarena.vision.rigid_motion import motion_of, rotation_of


def straight(count: int, step: float) -> np.ndarray:
    return np.stack([motion_of(np.eye(3), np.array([0.0, 0.0, step * number])) for number in range(count)])


def wandering(seed: int, count: int = 60) -> np.ndarray:
    rng, poses = np.random.default_rng(seed), [np.eye(4)]
    for _ in range(count - 1):
        poses.append(poses[-1] @ motion_of(rotation_of(rng.normal(0, 0.03, 3)), np.array([0.1, 0.0, 1.0])))
    return np.stack(poses)


def test_a_scale_of_1_per_cent_is_an_error_of_1_per_cent() -> None:
    truth, estimate = straight(300, 1.0), straight(300, 1.01)
    found = trajectory_errors(truth, estimate)
    assert found.lengths == (100.0, 200.0) and found.path == 299.0
    # a part of 100 m ends at the first pose beyond, 101 m on, where the estimate is off by 1.01 m
    assert found.translation == pytest.approx(np.mean([1.01 / 100] * 20 + [2.01 / 200] * 10))
    assert found.rotation == 0.0 and found.final == pytest.approx(2.99)


def test_a_turn_at_each_step_is_an_error_of_rotation() -> None:
    truth = straight(120, 1.0)
    estimate = np.stack([motion_of(rotation_of(np.array([0, 0.001 * n, 0])), p[:3, 3]) for n, p in enumerate(truth)])
    assert kitti_errors(truth, estimate, (10.0,), 1)[1] == pytest.approx(0.0011)


def test_errors_do_not_depend_on_where_the_trajectory_begins() -> None:
    truth, estimate = wandering(0), wandering(1)
    shifted = motion_of(rotation_of(np.array([1.0, 0.5, -0.2])), np.array([5.0, 6.0, 7.0])) @ estimate
    one, two = trajectory_errors(truth, estimate), trajectory_errors(truth, shifted)
    assert one.lengths == (10.0, 20.0, 30.0, 40.0, 50.0)
    assert one.translation == pytest.approx(two.translation) and one.ate == pytest.approx(two.ate)
    assert one.final == pytest.approx(two.final)


def test_the_ate_is_the_least_over_all_alignments() -> None:
    truth, estimate = wandering(2), wandering(3)

    def off(x: np.ndarray) -> np.ndarray:
        return (Rotation.from_rotvec(x[:3]).apply(estimate[:, :3, 3]) + x[3:] - truth[:, :3, 3]).ravel()

    best = min(least_squares(off, np.r_[start, 0, 0, 0]).cost for start in np.eye(3))
    assert absolute_error(truth, estimate) == pytest.approx(np.sqrt(2 * best / 60), rel=1e-4)


def test_rpe_takes_the_pose_nearest_to_the_distance() -> None:
    truth, estimate = straight(31, 0.7), straight(31, 0.77)
    # 5 m is nearest to 7 steps of 0.7 m, each off by 0.07 m
    assert np.allclose(relative_pose_errors(truth, estimate, 5.0), 0.49)
    assert len(relative_pose_errors(truth, estimate, 5.0)) == 24
    assert len(relative_pose_errors(truth, estimate, 500.0)) == 0


def test_paths_that_are_too_short_or_uneven_are_told_of() -> None:
    assert np.isnan(trajectory_errors(straight(5, 1.0), straight(5, 1.0)).translation)
    assert path_lengths(straight(4, 0.5)).tolist() == [0.0, 0.5, 1.0, 1.5]
    with pytest.raises(VisionError, match="4 estimated and 5 true poses"):
        trajectory_errors(straight(5, 1.0), straight(4, 1.0))
