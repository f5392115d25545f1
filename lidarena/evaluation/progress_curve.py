"""How a measure rose or fell while episodes went on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.evaluation.measures.table_columns import Measure

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ProgressCurve:
    """What a measure was when.

    Attributes:
        measure: Which one; its title, unit and scale go on the axis.
        points: Time [s] and value after the reset and each step, (steps + 1, 2) float32.
    """

    measure: Measure
    points: NDArray[np.float32]

    @classmethod
    def of(cls, measure: Measure, times: Floats, values: Floats) -> "ProgressCurve | None":
        """From times and values (steps + 1,); None where one is not known."""
        points = np.column_stack([times, values]).astype(np.float32)
        return cls(measure, points) if np.isfinite(points).all() else None


def progress_band(curves: Sequence[ProgressCurve], times: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the mean at some times, and its pointwise 95% percentile bootstrap band.

    An episode that has ended keeps the value that it ended with.

    Args:
        curves: Of one policy in one environment.
        times: Ascending, shape (T,) [s].

    Returns:
        Mean, lower and upper bound, each of shape (T,).
    """
    places = [np.searchsorted(curve.points[:, 0], times, side="right") - 1 for curve in curves]
    values = np.array([one.points[np.maximum(place, 0), 1] for one, place in zip(curves, places, strict=True)])
    rows = np.random.default_rng(0).integers(0, len(values), (1000, len(values)))
    weights = np.apply_along_axis(np.bincount, 1, rows, minlength=len(values)) / len(values)
    low, high = np.quantile(weights @ values, [0.025, 0.975], axis=0)
    return values.mean(axis=0), low, high
