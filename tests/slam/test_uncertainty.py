import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.uncertainty import (
    COVARIANCE_FLOOR,
    a_optimality,
    d_optimality,
    e_optimality,
    pose_moments,
    predictive_scale,
    score_entropy,
    weight_entropy,
)

ENTRIES = st.lists(st.floats(-2, 2), min_size=9, max_size=9)


@settings(deadline=None)
@given(ENTRIES)
def test_criteria_are_means_of_the_eigenvalues(entries: list[float]) -> None:
    root = np.array(entries).reshape(3, 3)
    covariance = root @ root.T + 0.01 * np.eye(3)
    values = np.linalg.eigvalsh(covariance)
    assert d_optimality(covariance) == pytest.approx(math.exp(np.log(values).mean()), rel=1e-6)
    assert a_optimality(covariance) == pytest.approx(values.mean())
    assert e_optimality(covariance) == pytest.approx(values.max())
    assert d_optimality(covariance) <= a_optimality(covariance) + 1e-9 <= e_optimality(covariance) + 1e-8


def test_entropy_is_greatest_for_equal_weights_and_zero_for_one() -> None:
    assert weight_entropy(np.full(30, 1 / 30)) == pytest.approx(math.log(30))
    assert weight_entropy(np.array([1.0, 0.0, 0.0])) == 0.0


def test_headings_are_averaged_on_the_circle() -> None:
    particles = np.array([[0, 0, math.pi - 0.1], [2, 0, -math.pi + 0.1]])
    mean, covariance = np.zeros(3), np.zeros((3, 3))
    pose_moments(particles, np.array([0.5, 0.5]), mean, covariance)
    assert mean[:2] == pytest.approx((1, 0))
    assert abs(mean[2]) == pytest.approx(math.pi)
    assert covariance[2, 2] == pytest.approx(0.01 + COVARIANCE_FLOOR[2])
    assert covariance[0, 2] == pytest.approx(0.1)


@settings(deadline=None)
@given(st.lists(st.floats(-1e4, -1e-3), min_size=2, max_size=50))
def test_gmappings_entropy_is_that_of_the_normalised_log_likelihoods(scores: list[float]) -> None:
    shares = np.array(scores) / np.sum(scores)
    value = score_entropy(np.array(scores))
    assert value == pytest.approx(-np.sum(shares * np.log(shares)), rel=1e-9)
    assert 0.0 <= value <= math.log(len(scores)) + 1e-9
    assert score_entropy(np.zeros(len(scores))) == pytest.approx(math.log(len(scores)))


def test_coinciding_particles_are_certain_but_not_singular() -> None:
    mean, covariance = np.zeros(3), np.zeros((3, 3))
    pose_moments(np.tile([1.0, 2.0, 3.0], (30, 1)), np.full(30, 1 / 30), mean, covariance)
    assert covariance == pytest.approx(np.diag(COVARIANCE_FLOOR))
    assert d_optimality(covariance) > 0


@pytest.mark.parametrize("count", [12, 30])
def test_the_pose_is_as_far_from_drawn_poses_as_their_scaled_covariance_says(count: int) -> None:
    """The error's NEES is 3 in the mean where truth and poses are drawn from one Gaussian, and more without scaling."""
    rng, weights, nees = np.random.default_rng(0), np.full(count, 1.0 / count), []
    for _ in range(4000):
        poses, truth = 0.01 * rng.normal(size=(count, 3)), 0.01 * rng.normal(size=3)
        mean, covariance = np.zeros(3), np.zeros((3, 3))
        pose_moments(poses, weights, mean, covariance)
        nees.append((truth - mean) @ np.linalg.solve(covariance - np.diag(COVARIANCE_FLOOR), truth - mean))
    assert np.mean(nees) > 3.6
    assert np.mean(nees) / predictive_scale(weights) == pytest.approx(3.0, abs=0.3)


def test_few_poses_say_little_and_a_single_one_nothing_false() -> None:
    weights = np.array([[0.25, 0.25, 0.25, 0.25], [1.0, 0.0, 0.0, 0.0]])
    np.testing.assert_allclose(predictive_scale(weights), [5.0, 2.0])
