"""Continuous actions from -1 to 1, and the rounding of whoever computed them."""

import numpy as np
from numpy.typing import NDArray

ROUNDING = 1e-6
"""So far beyond its bound an action counts as the bound: some eight times the rounding of float32 at 1, which a wrapper
that rescales actions leaves behind."""


def within_bounds(numbers: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return actions with those beyond a bound by no more than ``ROUNDING`` put on it; None if others are, or NaN."""
    size = np.abs(numbers)
    if (size <= 1.0).all():
        return numbers
    return numbers.clip(-1.0, 1.0) if (size <= 1.0 + ROUNDING).all() else None
