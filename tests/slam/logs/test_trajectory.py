import math
from pathlib import Path

import numpy as np
import pytest

from lidarena.slam.logs.trajectory import (
    Trajectory,
    in_order,
    interpolated,
    load_tum,
    save_kitti,
    save_tum,
    spread_correction,
)
from lidarena.slam.planar import compose


def walk(n: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    poses = [rng.normal(size=3)]
    for motion in rng.normal(0, 0.2, (n - 1, 3)):
        poses.append(compose(poses[-1], motion))
    return np.array(poses)


@pytest.mark.parametrize("seed", range(5))
def test_corrected_poses_stay_and_a_rigid_correction_moves_all_alike(seed: int) -> None:
    odometry = walk(60, seed)
    readings = np.sort(np.random.default_rng(seed).choice(60, 9, replace=False))
    corrected = walk(9, seed + 100)
    spread = spread_correction(odometry, readings, corrected)
    np.testing.assert_allclose(spread[readings, :2], corrected[:, :2], atol=1e-9)
    shift = np.array([3.0, -1.0, 2.0])
    moved = compose(np.broadcast_to(shift, odometry.shape), odometry)
    rigid = spread_correction(odometry, readings, moved[readings])
    np.testing.assert_allclose(rigid[:, :2], moved[:, :2], atol=1e-9)


def test_a_gap_is_spread_evenly_over_the_way() -> None:
    odometry = np.column_stack([np.arange(5.0), np.zeros((5, 2))])
    spread = spread_correction(odometry, np.array([0, 4]), np.array([[0.0, 0, 0], [5.0, 0, 0]]))
    np.testing.assert_allclose(spread[:, 0], [0, 1.25, 2.5, 3.75, 5], atol=1e-6)


def test_a_robot_at_rest_gets_finite_poses() -> None:
    assert np.isfinite(spread_correction(np.zeros((7, 3)), np.array([1, 4]), walk(2, 0))).all()
    assert len(spread_correction(np.zeros((1, 3)), np.array([0]), walk(1, 0))) == 1


def test_a_file_reads_back(tmp_path: Path) -> None:
    trajectory = in_order(1e9 + np.array([3.0, 1.0, 2.0, 2.0]), walk(4, 3))
    assert trajectory.times.tolist() == [1e9 + 1, 1e9 + 2, 1e9 + 2, 1e9 + 3]
    again = load_tum(save_tum(tmp_path / "a.tum", trajectory))
    assert isinstance(again, Trajectory)
    np.testing.assert_allclose(again.times, trajectory.times)
    np.testing.assert_allclose(again.poses, trajectory.poses, atol=1e-6)


def test_turns_are_interpolated_on_the_circle() -> None:
    poses = np.array([[0.0, 0.0, 3.0], [1.0, 0.0, -3.0]])
    half = interpolated(np.array([0.0, 1.0]), poses, np.array([0.5]))
    np.testing.assert_allclose([half[0, 0], abs(half[0, 2])], [0.5, math.pi])


def test_kittis_matrices_turn_and_shift(tmp_path: Path) -> None:
    poses = np.array([[1.0, 2.0, math.pi / 2], [0.0, -1.0, 0.0]])
    table = np.loadtxt(save_kitti(tmp_path / "a.kitti", Trajectory(np.arange(2.0), poses)))
    np.testing.assert_allclose(table[0], [0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 0], atol=1e-9)
    np.testing.assert_allclose(table[1], [1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0], atol=1e-9)
