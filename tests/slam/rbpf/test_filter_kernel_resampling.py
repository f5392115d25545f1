"""Systematic resampling: as many copies as a particle's weight is worth, and maps that go with their particles."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import seed_stream
from lidarena.slam.rbpf.filter_kernel import _normalise, _resample
from lidarena.slam.rbpf.particle_filter_state import FilterParameters, FilterState, empty_state
from tests.slam.rbpf.dense_field import dense
from tests.slam.rbpf.test_likelihood_field import register

WEIGHTS = st.lists(st.floats(0.0, 1.0), min_size=2, max_size=9).filter(lambda weights: sum(weights) > 0.1)


def particles(weights: np.ndarray) -> FilterState:
    """A filter whose particle i stands at (i, 2 i, 0)."""
    state = empty_state(1, 32, 32, 4, FilterParameters(particles=len(weights), history=2))
    state.weights[0] = weights / weights.sum()
    state.particles[0] = np.arange(len(weights))[:, None] * (1.0, 2.0, 0.0)
    state.anchors[0] = state.particles[0] + 0.25
    state.log_weights[0], state.scores[0] = -1.0, -5.0
    return state


def resample(state: FilterState, seed: int) -> np.ndarray:
    """Resample and count each particle's copies."""
    n = state.weights.shape[1]
    _resample(0, seed_stream(np.random.default_rng(seed)), np.full(n, 77, np.int64), state)
    return np.bincount(state.ancestors[0], minlength=n)


@settings(max_examples=40, deadline=None)
@given(WEIGHTS, st.integers(0, 10**6))
def test_a_particle_has_as_many_copies_as_its_weight_says_to_the_nearest_whole(weights: list[float], seed: int) -> None:
    state = particles(np.array(weights))
    wanted = state.weights[0] * len(weights)
    copies = resample(state, seed)
    assert copies.sum() == len(weights)
    assert (copies >= np.floor(wanted - 1e-9)).all() and (copies <= np.ceil(wanted + 1e-9)).all()


@settings(max_examples=40, deadline=None)
@given(WEIGHTS, st.integers(0, 10**6))
def test_survivors_stay_and_copies_are_their_likes(weights: list[float], seed: int) -> None:
    state = particles(np.array(weights))
    before = state.particles[0].copy()
    copies = resample(state, seed)
    ancestors = state.ancestors[0]
    assert all(ancestors[i] == i for i in np.flatnonzero(copies))
    np.testing.assert_array_equal(state.particles[0], before[ancestors])
    np.testing.assert_array_equal(state.anchors[0], before[ancestors] + 0.25)
    assert not state.log_weights.any() and not state.scores.any()
    np.testing.assert_allclose(state.weights[0], 1.0 / len(weights))


def test_on_average_the_copies_are_the_weights() -> None:
    weights = np.array([0.02, 0.31, 0.17, 0.05, 0.45])
    counts = np.mean([resample(particles(weights), seed) for seed in range(1500)], axis=0)
    np.testing.assert_allclose(counts, 5 * weights, atol=0.06)


def test_a_dead_particle_takes_its_ancestors_map_and_nobody_else_changes() -> None:
    state = particles(np.array([0.0, 0.6, 0.0, 0.4]))
    for i in range(4):
        register(state.fields, i, 0.3 + 0.3 * i, 0.7, i)
    before = [dense(state.fields, i).copy() for i in range(4)]
    copies = resample(state, 3)
    assert copies[0] == copies[2] == 0
    for i, ancestor in enumerate(state.ancestors[0]):
        assert np.array_equal(dense(state.fields, i), before[ancestor])
    register(state.fields, 0, 1.2, 1.2, 3)  # a copy that learns something keeps it to itself
    for i in (1, 2, 3):
        assert np.array_equal(dense(state.fields, i), before[state.ancestors[0, i]])


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-800.0, 5.0), min_size=2, max_size=12))
def test_weights_are_the_softmax_of_the_log_weights(logs: list[float]) -> None:
    state = particles(np.ones(len(logs)))
    state.log_weights[0] = logs
    _normalise(0, state)
    shares = np.exp(np.array(logs) - max(logs))
    shares /= shares.sum()
    np.testing.assert_allclose(state.weights[0], shares, atol=1e-15)
    positive = shares[shares > 0]
    assert state.criteria[0, 1] == pytest.approx(-np.sum(positive * np.log(positive)), abs=1e-12)
    assert state.criteria[0, 2] == pytest.approx(1.0 / np.sum(shares**2))
    assert 1.0 - 1e-9 <= state.criteria[0, 2] <= len(logs) + 1e-9
    assert state.log_weights[0].max() == 0.0 and state.criteria[0, 3] == pytest.approx(math.log(len(logs)))
