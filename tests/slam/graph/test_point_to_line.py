"""Points to lines: two scans of one room show where one was taken, seen from the other."""

import math

import numpy as np
import pytest

from lidarena.slam.graph.point_to_line import add_pair, align, solve3
from lidarena.slam.graph.surface_points import BeamFan, SurfacePoints, empty_points, enter_scan

FAN = BeamFan(-math.pi / 2, math.radians(1.0), 181)


def room_ranges(pose: tuple[float, float, float], width: float = 6.0, height: float = 4.0) -> np.ndarray:
    """What a laser in an empty room of this size around the origin measures."""
    angles = pose[2] + FAN.first + FAN.step * np.arange(FAN.beams)
    cos, sin = np.cos(angles), np.sin(angles)
    with np.errstate(divide="ignore", invalid="ignore"):
        across = np.where(cos > 0, (width / 2 - pose[0]) / cos, (-width / 2 - pose[0]) / cos)
        along = np.where(sin > 0, (height / 2 - pose[1]) / sin, (-height / 2 - pose[1]) / sin)
    along = np.where(sin == 0.0, np.inf, along)
    return np.minimum(across, along).astype(np.float32)


def scans(*poses: tuple[float, float, float]) -> SurfacePoints:
    store = empty_points(len(poses), FAN.beams)
    for s, pose in enumerate(poses):
        enter_scan(store, s, room_ranges(pose), FAN, 20.0)
    return store


def system_of(store: SurfacePoints, motion: list[float]) -> np.ndarray:
    system = np.zeros(12)
    add_pair(store, FAN, 1, 0, np.array(motion), 0.3, 1, system)
    return system


def test_the_true_motion_asks_for_no_step() -> None:
    step = np.empty(3)
    solve3(system_of(scans((0, 0, 0), (0.3, 0.1, 0.1)), [0.3, 0.1, 0.1]), np.zeros(3), step)
    assert np.abs(step).max() < 1e-3


def test_the_gradient_points_back() -> None:
    system = system_of(scans((0, 0, 0), (0, 0, 0)), [0.05, -0.03, 0.0])
    assert system[6] > 0.0 > system[7]


@pytest.mark.parametrize("wrong", [(0.1, 0.1, 0.0), (-0.15, 0.05, 0.1), (0.0, -0.1, -0.15)])
def test_a_scan_is_brought_back_to_where_it_was_taken(wrong: tuple[float, float, float]) -> None:
    true = np.array([0.4, -0.2, 0.3])
    store = scans((0, 0, 0), (0.2, 0.1, 0.2), tuple(true))
    pose = true + wrong
    others, poses = np.array([0, 1]), np.array([[0, 0, 0], [0.2, 0.1, 0.2]], float)
    rounds = np.array([0.3, 0.3, 0.3, 0.2, 0.2, 0.1, 0.1, 0.1])
    align(store, FAN, 2, others, poses, pose, np.full(3, 1e-6), rounds, 1, np.zeros(16))
    assert np.abs(pose - true).max() < 0.005


def test_what_the_other_laser_cannot_see_says_nothing() -> None:
    system = system_of(scans((0, 0, 0), (0, 0, math.pi)), [0.0, 0.0, math.pi])
    assert system[11] <= 8.0  # but for the beams at both ends of the half turn


def test_the_back_of_a_wall_is_another_wall() -> None:
    store = scans((0, 0, 0), (0, 0, 0))
    store.normals[1] *= -1.0
    assert system_of(store, [0.0, 0.0, 0.0])[10] == 0.0


def test_solving_agrees_with_numpy() -> None:
    rng = np.random.default_rng(0)
    root = rng.normal(size=(3, 3))
    matrix, gradient, prior = root @ root.T, rng.normal(size=3), np.array([0.1, 0.2, 0.3])
    step = np.empty(3)
    solve3(np.array([*matrix[np.triu_indices(3)], *gradient, 0, 0, 0]), prior, step)
    np.testing.assert_allclose(step, np.linalg.solve(matrix + np.diag(prior), -gradient))
