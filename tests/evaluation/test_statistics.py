"""The intervals: against scipy, against stored values, and whether they cover what they claim to cover."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import stats

from lidarena.evaluation.statistics import (
    LEAST_SAMPLES,
    bootstrap,
    geometric_mean,
    interquartile_mean,
    mean,
    paired_difference,
    paired_share_difference,
    share_interval,
)


@pytest.mark.parametrize("method", ["bca", "percentile"])
@pytest.mark.parametrize("size", [13, 57])  # few enough samples tie by rounding, which scipy does not see
def test_bootstrap_agrees_with_scipy(method: str, size: int) -> None:
    sample = np.random.default_rng(size).gamma(2.0, size=size)
    ours = bootstrap(sample, seed=7, resamples=2000, method=method)  # type: ignore[arg-type]
    theirs = stats.bootstrap((sample,), np.mean, n_resamples=2000, method=method, rng=np.random.default_rng(7))
    assert ours.mean == pytest.approx(sample.mean())
    np.testing.assert_allclose(ours[1:], theirs.confidence_interval, rtol=1e-9)


def test_bootstrap_of_a_skewed_statistic_agrees_with_scipy() -> None:
    sample = np.random.default_rng(3).lognormal(size=25)
    ours = bootstrap(sample, geometric_mean, seed=1, resamples=2000)
    theirs = stats.bootstrap((sample,), stats.gmean, n_resamples=2000, rng=np.random.default_rng(1))
    np.testing.assert_allclose(ours[1:], theirs.confidence_interval, rtol=1e-9)


def test_bootstrap_stored_values() -> None:
    # Guards the random stream: a change here changes every published table.
    interval = bootstrap([1.0, 2.0, 4.0, 8.0, 16.0, 3.0, 5.0, 7.0], seed=0)
    assert interval == pytest.approx((5.75, 3.5, 10.248055753), abs=1e-8)


@pytest.mark.parametrize(("draw", "truth"), [("standard_normal", 0.0), ("standard_exponential", 1.0)])
def test_bootstrap_covers_the_truth_about_as_often_as_it_says(draw: str, truth: float) -> None:
    rng = np.random.default_rng(11)
    inside = 0
    for trial in range(400):
        interval = bootstrap(getattr(rng, draw)(30), seed=trial, resamples=1000)
        inside += interval.low <= truth <= interval.high
    # The bootstrap is known to be a little short with thirty samples; 0.90 is what the literature reports.
    assert 0.89 <= inside / 400 <= 0.98


@given(hnp.arrays(float, st.integers(5, 20), elements=st.floats(-1e6, 1e6)), st.integers(0, 10))
def test_bootstrap_bounds_lie_within_the_sample_and_repeat(sample: np.ndarray, seed: int) -> None:
    first, second = (bootstrap(sample, seed=seed, resamples=200) for _ in range(2))
    assert first == second
    slack = 1e-9 * (1 + np.abs(sample).max())
    assert sample.min() - slack <= first.low <= first.high <= sample.max() + slack


@given(st.floats(0.1, 100), st.floats(-50, 50))
def test_bootstrap_follows_a_change_of_units(scale: float, shift: float) -> None:
    sample = np.array([1.0, 2.0, 4.0, 9.0, 3.0])
    plain, changed = bootstrap(sample, resamples=200), bootstrap(scale * sample + shift, resamples=200)
    np.testing.assert_allclose(np.array(plain) * scale + shift, changed, rtol=1e-6, atol=1e-6)


def test_bootstrap_of_few_or_equal_samples() -> None:
    assert np.isnan(bootstrap([])).all()
    for count in range(1, LEAST_SAMPLES):
        few = bootstrap(np.arange(count) + 1.0)
        assert few.mean == (count + 1) / 2 and np.isnan(few[1:]).all()
    assert bootstrap([2.0] * 5) == (2.0, 2.0, 2.0)
    assert bootstrap([1.0, np.nan, 3.0, 5.0, 4.0, 9.0]) == bootstrap([1.0, 3.0, 5.0, 4.0, 9.0])


def test_share_interval_has_width_where_the_bootstrap_has_none() -> None:
    interval = share_interval(np.ones(10))
    assert interval.mean == 1.0 and interval.high == pytest.approx(1.0)
    assert interval.low == pytest.approx(0.7225, abs=1e-4)  # the textbook's value for 10 of 10
    assert np.isnan(share_interval([])).all()


@given(st.integers(1, 60), st.data())
def test_share_interval_agrees_with_scipy(n: int, data: st.DataObject) -> None:
    hits = data.draw(st.integers(0, n))
    theirs = stats.binomtest(hits, n).proportion_ci(method="wilson")
    np.testing.assert_allclose(share_interval([1.0] * hits + [0.0] * (n - hits))[1:], theirs, atol=1e-12)


def test_paired_difference_sees_through_the_difficulty_of_the_seeds() -> None:
    rng = np.random.default_rng(0)
    difficulty = 100 * rng.standard_normal(20)
    better, worse = difficulty + 1 + 0.1 * rng.standard_normal(20), difficulty
    difference = paired_difference(better, worse)
    assert 0.9 < difference.low < difference.mean < difference.high < 1.1
    apart = bootstrap(better)
    assert apart.high - apart.low > 50


def test_paired_difference_needs_pairs() -> None:
    with pytest.raises(ValueError, match="not 2 and 3"):
        paired_difference([1.0, 2.0], [1.0, 2.0, 3.0])


def test_means() -> None:
    sample = np.array([[1.0, 10.0, 100.0, 1000.0], [0.0, 1.0, 1.0, 1.0]])
    np.testing.assert_allclose(mean(sample), [277.75, 0.75])
    np.testing.assert_allclose(geometric_mean(sample), [10**1.5, 0.0])
    assert np.isnan(geometric_mean([-1.0, 1.0]))
    np.testing.assert_allclose(interquartile_mean(sample), [55.0, 1.0])
    assert interquartile_mean(np.arange(11.0) ** 2) == pytest.approx(stats.trim_mean(np.arange(11.0) ** 2, 0.25))


def test_paired_share_difference_covers_the_truth() -> None:
    rng = np.random.default_rng(5)
    inside = 0
    for _ in range(1000):
        luck = rng.random(25)  # shared by both, so that the outcomes are correlated
        first, second = (luck + 0.3 * rng.random(25) < share for share in (0.9, 0.7))
        interval = paired_share_difference(first, second)
        inside += interval.low <= 0.2 <= interval.high
    assert 0.93 <= inside / 1000 <= 0.995


@given(st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=30))
def test_paired_share_difference_lies_in_its_interval_and_changes_sign_with_the_order(pairs: list[tuple]) -> None:
    first, second = np.array(pairs, dtype=float).T
    there, back = paired_share_difference(first, second), paired_share_difference(second, first)
    assert -1 - 1e-9 <= there.low <= there.mean <= there.high <= 1 + 1e-9
    assert there.low < there.high
    np.testing.assert_allclose(there, (-back.mean, -back.high, -back.low), atol=1e-12)


def test_paired_share_difference_of_few_episodes_is_uncertain() -> None:
    assert paired_share_difference([1.0, 1.0], [0.0, 0.0]).low < 0.1
    assert paired_share_difference(np.ones(20), np.zeros(20)).low > 0.6


@pytest.mark.parametrize("size", [6, 40, 999, 1001])
def test_the_mean_is_resampled_as_any_other_statistic_is(size: int) -> None:
    sample = np.random.default_rng(size).gamma(2.0, 3.0, size)
    quick, plain = bootstrap(sample, seed=4), bootstrap(sample, lambda drawn: np.mean(drawn, axis=-1), seed=4)
    np.testing.assert_allclose(quick, plain, rtol=1e-9)
