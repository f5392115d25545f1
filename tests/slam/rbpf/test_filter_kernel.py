"""The particle filter's single steps: prediction, covariance of the motion, drawing, choosing points and the best."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import seed_stream
from lidarena.slam.planar import compose
from lidarena.slam.rbpf.filter_kernel import _best_particle, _choose, _draw, predict
from lidarena.slam.rbpf.particle_filter_state import FilterParameters, FilterState, empty_scratch, empty_state
from lidarena.slam.uncertainty import COVARIANCE_FLOOR, compound_covariance, pose_moments
from lidarena.world.odometry import deviations

STEP = st.tuples(st.floats(-0.4, 0.4), st.floats(-0.1, 0.1), st.floats(-0.5, 0.5))


def still(particles: int, **settings_: float) -> tuple[FilterState, FilterParameters]:
    parameters = FilterParameters(particles=particles, history=4, **settings_)  # type: ignore[arg-type]
    return empty_state(1, 16, 16, 4, parameters), parameters


def propagated(motion: np.ndarray, covariance: np.ndarray, reading: np.ndarray, variances: np.ndarray) -> np.ndarray:
    """J Σ Jᵀ + G diag(variances) Gᵀ."""
    cos, sin = math.cos(motion[2]), math.sin(motion[2])
    dx, dy = reading[:2]
    jacobian = np.array([[1, 0, -sin * dx - cos * dy], [0, 1, cos * dx - sin * dy], [0, 0, 1]])
    turn = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    return jacobian @ covariance @ jacobian.T + turn @ np.diag(variances) @ turn.T


@settings(max_examples=40, deadline=None)
@given(st.lists(STEP, min_size=1, max_size=6), st.floats(0.0, 0.3))
def test_the_covariance_of_a_motion_is_propagated_by_its_jacobian(steps: list[tuple[float, ...]], v: float) -> None:
    motion, found, expected = np.zeros(3), np.zeros((3, 3)), np.zeros((3, 3))
    for k, step in enumerate(steps):
        reading, variances = np.array(step), np.array([v, 0.01 * k, 0.02])
        expected = propagated(motion, expected, reading, variances)
        compound_covariance(motion, found, reading[0], reading[1], *variances.tolist())
        motion = compose(motion, reading)
    np.testing.assert_allclose(found, expected, atol=1e-12)
    np.testing.assert_allclose(found, found.T, atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.lists(STEP, min_size=1, max_size=6))
def test_motions_are_added_up_as_the_wheels_tell_them(steps: list[tuple[float, ...]]) -> None:
    state, parameters = still(2)
    stream, motion, covariance = seed_stream(np.random.default_rng(0)), np.zeros(3), np.zeros((3, 3))
    for step in steps:
        reading = np.array(step)
        predict(0, 0.2, reading, parameters, stream, state)
        variances = np.square(deviations(parameters.noise, *step))
        covariance = propagated(motion, covariance, reading, variances)
        motion = compose(motion, reading)
    np.testing.assert_allclose(state.motion[0], motion, atol=1e-12)
    np.testing.assert_allclose(state.motion_covariance[0], covariance, atol=1e-12)
    table = np.array(steps)
    way, turns = np.hypot(table[:, 0], table[:, 1]).sum(), np.abs(table[:, 2]).sum()
    assert state.since[0] == pytest.approx((way, turns, 0.2 * len(steps)))


def test_predicted_particles_scatter_as_the_covariance_of_the_motion_says() -> None:
    state, parameters = still(6000)
    stream = seed_stream(np.random.default_rng(4))
    for _ in range(8):
        predict(0, 0.2, np.array([0.1, 0.0, 0.03]), parameters, stream, state)
    mean, covariance = np.zeros(3), np.zeros((3, 3))
    pose_moments(state.particles[0], state.weights[0], mean, covariance)
    assert mean == pytest.approx(state.motion[0], abs=5e-3)
    expected = state.motion_covariance[0]
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert (np.abs(covariance - expected) / scale).max() < 0.08


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.floats(-3.0, 3.0), st.integers(1, 40))
def test_the_moments_are_numpys(seed: int, heading: float, count: int) -> None:
    rng = np.random.default_rng(seed)
    poses = rng.normal((3.0, -2.0, heading), (0.5, 0.2, 0.1), (count, 3))
    weights = rng.dirichlet(np.ones(count))
    mean, covariance = np.zeros(3), np.zeros((3, 3))
    pose_moments(poses, weights, mean, covariance)
    assert mean[:2] == pytest.approx(weights @ poses[:, :2])
    assert mean[2] == pytest.approx(np.angle(weights @ np.exp(1j * poses[:, 2])))
    away = poses - mean
    away[:, 2] = np.angle(np.exp(1j * away[:, 2]))
    np.testing.assert_allclose(covariance, (weights[:, None] * away).T @ away + np.diag(COVARIANCE_FLOOR), atol=1e-9)


def test_drawn_poses_have_the_covariance_of_their_information() -> None:
    root = np.array([[9.0, 0.0, 0.0], [3.0, 7.0, 0.0], [-2.0, 4.0, 12.0]])
    m = root @ root.T
    information = (m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2])
    stream, drawn = seed_stream(np.random.default_rng(2)), np.tile([1.0, 2.0, 0.5], (8000, 1))
    for pose in drawn:
        _draw(pose, information, stream)
    expected = np.linalg.inv(m)
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert (np.abs(np.cov(drawn.T) - expected) / scale).max() < 0.05
    assert np.abs(drawn.mean(axis=0) - (1.0, 2.0, 0.5)).max() < 0.01


@settings(max_examples=40, deadline=None)
@given(st.lists(st.booleans(), min_size=1, max_size=90), st.integers(1, 40))
def test_the_points_that_are_matched_are_spread_evenly_over_those_with_a_normal(flat: list[bool], wanted: int) -> None:
    parameters = FilterParameters(particles=2)
    scratch = empty_scratch(
        1, 16, 96, 3.5, 0.05, parameters._replace(matcher=parameters.matcher._replace(points=wanted))
    )
    numbers = np.arange(96.0 * 5).reshape(-1, 32, 5).transpose(0, 2, 1)
    scratch.points[0, : len(numbers)] = numbers
    scratch.flat[0, : len(flat)] = flat
    usable = np.flatnonzero(flat)
    count = _choose(0, len(flat), wanted, scratch)
    assert count == min(wanted, len(usable))
    rows = scratch.chosen[0].transpose(0, 2, 1).reshape(-1, 5)[:count]
    expected = usable[np.arange(count) * len(usable) // max(count, 1)]
    np.testing.assert_array_equal(rows, (5.0 * expected)[:, None] + np.arange(5.0))
    assert len(set(expected.tolist())) == count


@pytest.mark.parametrize(
    ("weights", "parents", "best"),
    [
        ([0.2, 0.5, 0.3], [0, 0, 0], 1),  # only descendants of the published particle: the likeliest
        ([0.2, 0.5, 0.3], [0, 1, 0], 2),  # its likeliest descendant, since the best is not three times as likely
        ([0.2, 0.7, 0.1], [0, 1, 1], 1),  # … and here it is
        ([0.1, 0.3, 0.6], [1, 2, 2], 2),  # no descendant is left
    ],
)
def test_the_published_past_is_left_only_for_a_much_likelier_one(
    weights: list[float], parents: list[int], best: int
) -> None:
    state, parameters = still(3)
    state.weights[0], state.node_parents[0, 1] = weights, parents
    state.published[0, 0] = 0
    assert _best_particle(0, 1, 1, parameters, state) == best
    assert _best_particle(0, 1, 0, parameters, state) == int(np.argmax(weights))  # the first scan of all
