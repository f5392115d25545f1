"""Angles and velocities from other instruments: Bobkov et al.'s replacement, and the weighing of both."""

import numpy as np

from lidarena.vision.navigation import adjoint, fuse_angles, replace_angles, replace_translation
from lidarena.vision.rigid_motion import inverse, motion_of, rotation_of, vector_of
from tests.vision.scenes import pose_at, some_motion


def test_replacement_is_the_printed_formula() -> None:
    """In rows, M = [[R, 0], [t, 1]] from the world to the camera: t_cor = t_vis R_vis^-1 R_cor."""
    pose, attitude = pose_at(3.0), pose_at(3.0, heading=0.2)[:3, :3]
    seen, put = inverse(pose), inverse(replace_angles(pose, attitude))
    rows = [one[:3, :3].T for one in (seen, put)]
    assert np.allclose(put[:3, 3], seen[:3, 3] @ np.linalg.inv(rows[0]) @ rows[1])
    assert np.allclose(rows[1], attitude) and np.allclose(inverse(put)[:3, 3], pose[:3, 3])


def test_the_adjoint_moves_a_small_motion_past_a_pose() -> None:
    pose, small = pose_at(3.0), 1e-6 * np.arange(1.0, 7.0)
    after = adjoint(pose) @ small
    one = pose @ motion_of(rotation_of(small[:3]), small[3:])
    two = motion_of(rotation_of(after[:3]), after[3:]) @ pose
    assert np.allclose(one, two, atol=1e-10)


def test_a_sure_pose_is_left_alone_and_an_unsure_one_follows_the_measurement() -> None:
    pose, attitude = pose_at(3.0), rotation_of(np.array([0.01, -0.02, 0.03])) @ pose_at(3.0)[:3, :3]
    sure, _ = fuse_angles(pose, 1e-12 * np.eye(6), attitude, 0.01)
    assert np.allclose(sure, pose, atol=1e-8)
    unsure, left = fuse_angles(pose, np.diag([1.0] * 3 + [1e-12] * 3), attitude, 0.01)
    assert np.abs(vector_of(unsure[:3, :3] @ attitude.T)).max() < 1e-4
    assert np.isclose(left[0, 0], 0.01**2, rtol=0.01)


def test_the_position_follows_where_it_hangs_on_the_angles() -> None:
    """A pose that turned by w about a point 5 m below has moved by 5 w, and the correction takes that back."""
    lever = np.zeros((6, 3))
    lever[:3], lever[3:] = np.eye(3), np.array([[0, 5.0, 0], [-5.0, 0, 0], [0, 0, 0]])
    truth, turn = motion_of(np.eye(3), np.zeros(3)), np.array([0.0, 0.02, 0.0])
    pose = motion_of(rotation_of(turn), lever[3:] @ turn)
    found, _ = fuse_angles(pose, lever @ lever.T, truth[:3, :3], 1e-4)
    assert np.abs(found - truth).max() < 2e-3


def test_the_log_gives_the_displacement() -> None:
    moved = replace_translation(some_motion(), np.array([0.1, -0.7, 0.02]))
    assert np.allclose(inverse(moved)[:3, 3], [0.1, -0.7, 0.02])
    assert np.array_equal(moved[:3, :3], some_motion()[:3, :3])
