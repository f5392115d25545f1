"""Measures over the path driven instead of over time: waiting and turning on the spot neither help nor harm them."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def geometric_mean_over_path(values: Floats, path: Floats) -> float:
    """Return the geometric mean of a quantity over the metres driven, exp(Σ ln x_k Δs_k / Σ Δs_k).

    Args:
        values: x_k, of each step (n,); they need not be positive where nothing was driven.
        path: Length of the path at the beginning and after each step (n + 1,) [m].

    Returns:
        The mean; NaN if nothing was driven or a length is not known, 0 where an x_k is 0.
    """
    driven = np.diff(path)
    if not np.isfinite(driven).all() or len(driven) != len(values) or not driven.sum() > 0.0:
        return float("nan")
    moved = driven > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.exp(np.average(np.log(values[moved]), weights=driven[moved])))


def path_at(share: float, explored: Floats, path: Floats) -> float:
    """Return the length of the path at which a share was explored for the first time [m]; NaN if it never was.

    Args:
        share: Of what there is to explore.
        explored: Completeness at the beginning and after each step (n + 1,).
        path: Length of the path at the same times (n + 1,) [m].
    """
    there = explored >= share
    return float(path[there.argmax()]) if there.any() else float("nan")


def explored_over_path(explored: Floats, path: Floats, horizon: float) -> float:
    """Return the area under the curve of completeness over path, from no path to ``horizon``, over ``horizon``.

    1 were all known from the start. What was explored in the end counts on to the horizon, so it makes no difference
    whether a policy that is done stops or drives on.

    Args:
        explored: Completeness at the beginning and after each step (n + 1,).
        path: Length of the path at the same times (n + 1,), never falling [m].
        horizon: Where the area ends [m].
    """
    if not (np.isfinite(explored).all() and np.isfinite(path).all() and horizon > 0.0):
        return float("nan")
    inside = path < horizon
    end = np.interp(horizon, path, explored)
    return float(np.trapezoid(np.append(explored[inside], end), np.append(path[inside], horizon)) / horizon)
