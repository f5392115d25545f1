"""Means with intervals: the seeded bootstrap, shares of successes, and paired differences.

Every table of this project quotes a mean with a 95% interval over episodes. The intervals are

- for a measured quantity: the bias-corrected and accelerated bootstrap (BCa; Efron, "Better bootstrap confidence
  intervals", JASA 82, 1987) of `scipy.stats.bootstrap`;
- for a share (success, collision): Wilson's score interval, of `scipy.stats.binomtest`, since resampling ten
  successes out of ten can only ever give ten out of ten, an interval of no width;
- for two policies on the same seeds: the same bootstrap on the differences, episode by episode, and Newcombe's
  paired interval for the difference of two shares.
"""

import math
import warnings
from collections.abc import Callable
from functools import lru_cache
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

Floats = NDArray[np.float64]
Statistic = Callable[[Floats], Floats]
"""Takes samples along the last axis and returns one number for each."""

RESAMPLES = 10_000
LEVEL = 0.95
LEAST_SAMPLES = 5
"""Below this, resampling knows too little of the scatter: the "95%" of two samples hold the mean half of the time."""


_MANY = 1000
"""Above so many samples the resamples are not counted once for all: that would take more than 80 MB."""


class Interval(NamedTuple):
    """A mean (or another statistic) and its confidence interval; the bounds are NaN where there is none."""

    mean: float
    low: float
    high: float


def mean(samples: Floats) -> Floats:
    """Return the arithmetic mean along the last axis."""
    result: Floats = np.mean(samples, axis=-1)
    return result


def geometric_mean(samples: ArrayLike) -> Floats:
    """Return exp(mean ln x) along the last axis: 0 where a sample is 0, NaN where one is negative."""
    with np.errstate(divide="ignore", invalid="ignore"):
        result: Floats = np.exp(np.mean(np.log(np.asarray(samples, dtype=np.float64)), axis=-1))
    return result


def interquartile_mean(samples: Floats) -> Floats:
    """Return the mean of the middle half along the last axis (IQM; Agarwal et al., NeurIPS 2021).

    A quarter of the samples is dropped at either end, rounded down, as `scipy.stats.trim_mean` does.
    """
    ordered = np.sort(samples, axis=-1)
    cut = ordered.shape[-1] // 4
    return mean(ordered[..., cut : ordered.shape[-1] - cut])


def bootstrap(
    samples: ArrayLike,
    statistic: Statistic = mean,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
    level: float = LEVEL,
    method: Literal["bca", "percentile"] = "bca",
) -> Interval:
    """Return a statistic of independent samples and its bootstrap interval.

    Args:
        samples: The sample, shape (n,). NaNs, the mark of "not measured", are left out.
        statistic: What is estimated; works along the last axis.
        seed: Of the resampling; equal seeds give equal intervals.
        resamples: How often the sample is drawn anew.
        level: Of the interval, such as 0.95.
        method: BCa, or the plain percentiles of the resampled statistics.

    Returns:
        The statistic and its bounds. All NaN for no sample; bounds NaN below `LEAST_SAMPLES`; bounds equal to the value
        where all samples are the same.
    """
    values = np.asarray(samples, dtype=np.float64)
    values = values[~np.isnan(values)]
    if values.size == 0:
        return Interval(np.nan, np.nan, np.nan)
    estimate = float(statistic(values))
    if values.size < LEAST_SAMPLES:
        return Interval(estimate, np.nan, np.nan)
    if np.all(values == values[0]):
        return Interval(estimate, estimate, estimate)
    for way in ("BCa", "percentile") if method == "bca" else ("percentile",):
        with warnings.catch_warnings(), np.errstate(divide="ignore", invalid="ignore"):
            warnings.simplefilter("ignore", stats.DegenerateDataWarning)  # the bounds are NaN then
            rounded = _without_rounding(statistic, values)
            drawn: Any = _resampled_means(values, rounded, seed, resamples) if statistic is mean else None
            found = stats.bootstrap(
                (values,),
                rounded,
                n_resamples=resamples if drawn is None else 0,
                bootstrap_result=drawn,
                vectorized=True,
                confidence_level=level,
                method=way,
                rng=np.random.default_rng(seed),
            ).confidence_interval
        if np.isfinite(found).all():
            break
    return Interval(estimate, float(found.low), float(found.high))


class _Resampled(NamedTuple):
    """What SciPy takes over of a bootstrap that was drawn before."""

    bootstrap_distribution: Floats


def _resampled_means(values: Floats, rounded: Callable[..., Floats], seed: int, resamples: int) -> _Resampled | None:
    """The means of the resamples that SciPy would draw; None for samples too large for it.

    Which episodes are drawn depends on how many there are and the seed alone, so a comparison counts them once, and
    each of its hundreds of means is a product of matrices.
    """
    if values.size > _MANY:
        return None
    means = _counts_of_resamples(values.size, seed, resamples) @ values / values.size
    return _Resampled(rounded(means[:, None]))


@lru_cache(maxsize=2)
def _counts_of_resamples(size: int, seed: int, resamples: int) -> Floats:
    """How often each of ``size`` samples is in each resample (resamples, size)."""
    drawn = np.random.default_rng(seed).integers(0, size, (resamples, size))
    drawn += size * np.arange(resamples)[:, None]
    return np.bincount(drawn.ravel(), minlength=resamples * size).reshape(resamples, size).astype(np.float64)


def _without_rounding(statistic: Statistic, values: Floats) -> Callable[..., Floats]:
    """The statistic rounded to far less than the samples' spread.

    BCa counts the replicates below the estimate; sums in another order are the same number and have to tie with it.
    """
    tie = max(1e-11 * float(np.ptp(values)), 1e-14 * float(np.abs(values).max()), 1e-290)
    digits = -math.floor(math.log10(tie))

    def rounded(samples: Floats, axis: int = -1) -> Floats:
        result: Floats = np.round(statistic(np.moveaxis(samples, axis, -1)), digits)
        return result

    return rounded


def share_interval(outcomes: ArrayLike, *, level: float = LEVEL) -> Interval:
    """Return a share of successes and Wilson's score interval (JASA 22, 1927).

    Args:
        outcomes: One 0 or 1 an episode, shape (n,); NaNs are left out.
        level: Of the interval.

    Returns:
        The share and its bounds in [0, 1]; all NaN for no outcome.
    """
    values = np.asarray(outcomes, dtype=np.float64)
    values = values[~np.isnan(values)]
    if values.size == 0:
        return Interval(np.nan, np.nan, np.nan)
    hits = round(float(np.sum(values)))
    bounds = stats.binomtest(hits, values.size).proportion_ci(level, method="wilson")
    return Interval(hits / values.size, float(bounds.low), float(bounds.high))


def paired_difference(first: ArrayLike, second: ArrayLike, *, seed: int = 0, level: float = LEVEL) -> Interval:
    """Return the mean of ``first - second`` and its bootstrap interval, pair by pair.

    Episode k of both must have had the same seed; then the difficulty of that episode cancels, and the interval
    is narrower than two separate ones would suggest.

    Args:
        first: Values of one policy, shape (n,).
        second: Values of the other on the same seeds, shape (n,). A pair with a NaN is left out.
        seed: Of the resampling.
        level: Of the interval.

    Raises:
        ValueError: If the two are of unequal length.
    """
    left, right = _pairs(first, second)
    return bootstrap(left - right, seed=seed, level=level)


def paired_share_difference(first: ArrayLike, second: ArrayLike, *, level: float = LEVEL) -> Interval:
    """Return the difference of two shares on the same seeds, and Newcombe's interval (Stat. Med. 17, 1998, method 10).

    It is built from the two Wilson intervals and the correlation of the outcomes, so it has a width even where all
    pairs are alike.

    Args:
        first: One 0 or 1 an episode, shape (n,).
        second: The other's on the same seeds, shape (n,). A pair with a NaN is left out.
        level: Of the interval.

    Raises:
        ValueError: If the two are of unequal length.
    """
    left, right = _pairs(first, second)
    p, p_low, p_high = share_interval(left, level=level)
    q, q_low, q_high = share_interval(right, level=level)
    down, up = np.array([p - p_low, q_high - q]), np.array([p_high - p, q - q_low])
    mixed = 2 * _newcombe_correlation(left, right)
    low = p - q - np.sqrt(np.sum(down**2) - mixed * np.prod(down))
    high = p - q + np.sqrt(np.sum(up**2) - mixed * np.prod(up))
    return Interval(p - q, float(low), float(high))


def _newcombe_correlation(left: Floats, right: Floats) -> float:
    """The phi coefficient of two binary samples, with Newcombe's correction towards zero; 0 where there is none."""
    n = left.size
    both, neither = float(left @ right), float((1 - left) @ (1 - right))
    only_left, only_right = float(left @ (1 - right)), float((1 - left) @ right)
    scale = left.sum() * (n - left.sum()) * right.sum() * (n - right.sum())
    product = both * neither - only_left * only_right
    corrected = max(product - n / 2, 0.0) if product > 0 else product
    return float(corrected / np.sqrt(scale)) if scale > 0 else 0.0


def _pairs(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
    """The pairs in which both are measured."""
    left, right = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
    if left.shape != right.shape:
        raise ValueError(f"paired values must be as many on both sides, not {left.size} and {right.size}")
    known = ~(np.isnan(left) | np.isnan(right))
    return left[known], right[known]
