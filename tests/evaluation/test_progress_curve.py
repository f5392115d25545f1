"""How a measure progressed."""

import numpy as np

from lidarena.evaluation.measures.exploration import COMPLETENESS
from lidarena.evaluation.progress_curve import ProgressCurve, progress_band


def steady(speed: float) -> ProgressCurve:
    times = np.linspace(0, 10, 51)
    curve = ProgressCurve.of(COMPLETENESS, times, speed * times)
    assert curve is not None
    return curve


def test_progress_keeps_the_last_value_and_its_band_contains_the_mean() -> None:
    times = np.array([0.0, 5.0, 10.0, 99.0])
    mean, low, high = progress_band([steady(speed) for speed in (0.02, 0.05, 0.1)], times)
    np.testing.assert_allclose(mean, np.mean([0.02, 0.05, 0.1]) * np.minimum(times, 10), atol=1e-6)
    assert (low <= mean + 1e-12).all() and (mean <= high + 1e-12).all() and low[2] < high[2]


def test_what_is_not_known_has_no_curve() -> None:
    assert ProgressCurve.of(COMPLETENESS, np.arange(3.0), np.array([0.0, np.nan, 1.0])) is None
    assert ProgressCurve.of(COMPLETENESS, np.full(3, np.nan), np.zeros(3)) is None
