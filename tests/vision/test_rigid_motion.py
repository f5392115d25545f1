"""Rotation vectors and matrices are each other's inverse; the fit of two clouds finds the motion."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from lidarena.vision.rigid_motion import fit_motion, inverse, motion_of, moved, orthonormal, rotation_of, vector_of

PART = st.floats(-1.7, 1.7)


@given(PART, PART, PART)
def test_a_rotation_is_scipys(x: float, y: float, z: float) -> None:
    vector = np.array([x, y, z])
    assert np.allclose(rotation_of(vector), Rotation.from_rotvec(vector).as_matrix(), atol=1e-12)
    assert np.allclose(vector_of(rotation_of(vector)), vector, atol=1e-6)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, -1, 0), (0.6, 0, 0.8), (-0.6, 0.8, 0), (1 / 3, -2 / 3, 2 / 3)])
def test_half_a_turn_keeps_its_axis(axis: tuple[float, float, float]) -> None:
    turned = rotation_of(math.pi * np.array(axis))
    found = vector_of(turned)
    assert np.isclose(np.linalg.norm(found), math.pi) and np.allclose(rotation_of(found), turned, atol=1e-9)


def test_no_rotation_is_the_zero_vector() -> None:
    assert np.array_equal(vector_of(np.eye(3)), np.zeros(3))
    assert np.allclose(vector_of(rotation_of(np.array([1e-8, 0.0, 0.0]))), [1e-8, 0, 0], atol=1e-15)


@given(PART, PART, PART)
def test_there_and_back_is_nowhere(x: float, y: float, z: float) -> None:
    motion = motion_of(rotation_of(np.array([x, y, z])), np.array([z, x, 1.0]))
    assert np.allclose(inverse(motion) @ motion, np.eye(4), atol=1e-12)


def test_the_fit_finds_the_motion_of_a_cloud() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(20, 3))
    motion = motion_of(rotation_of(np.array([0.3, -0.2, 2.0])), np.array([1.0, 2.0, 3.0]))
    assert np.allclose(fit_motion(points, moved(motion, points)), motion, atol=1e-9)
    spoilt = moved(motion, points)
    spoilt[0] += 5.0
    weights = np.r_[0.0, np.ones(19)]
    assert np.allclose(fit_motion(points, spoilt, weights), motion, atol=1e-9)
    assert not np.allclose(fit_motion(points, spoilt), motion, atol=1e-3)


def test_a_mirrored_cloud_gives_a_rotation_all_the_same() -> None:
    points = np.random.default_rng(1).normal(size=(12, 3))
    assert np.isclose(np.linalg.det(fit_motion(points, points * [1, 1, -1])[:3, :3]), 1.0)
    assert np.isclose(np.linalg.det(orthonormal(np.diag([1.01, 0.99, 1.0]))), 1.0)
