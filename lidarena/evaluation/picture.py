"""What an episode's picture is to the evaluation, which lays the pictures of all policies side by side."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Bounds = tuple[float, float, float, float]
"""x_min, x_max, y_min, y_max."""
PLACES = ("x (m)", "y (m)")
"""Titles of the axes of a picture of places."""


class Picture(Protocol):
    """What a family draws of an episode. It is pickled, since the episode runs in another process.

    A picture whose axes are no places has an attribute ``axis_titles`` beside: of x and of y.
    """

    def bounds(self) -> Bounds:
        """x_min, x_max, y_min, y_max of what is drawn [m]."""

    def draw(self, axes: "Axes") -> None:
        """Draw onto matplotlib's axes, in metres; what has a label is explained in the legend."""


def axis_titles(picture: Picture | None) -> tuple[str, str]:
    """Titles of the axes of a picture."""
    across, up = getattr(picture, "axis_titles", PLACES)
    return across, up


def bounds_around(points: Iterable[NDArray[np.float64]]) -> Bounds:
    """x_min, x_max, y_min, y_max of groups of points, each (n, 2)."""
    every = np.vstack([group.reshape(-1, 2) for group in points])
    (x_min, y_min), (x_max, y_max) = every.min(axis=0), every.max(axis=0)
    return float(x_min), float(x_max), float(y_min), float(y_max)
