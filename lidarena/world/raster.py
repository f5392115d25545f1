"""Rasterised floor plans: which cells are solid, and how far each cell's centre is from the nearest surface."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

CLEARANCE_CAP = 1.0
"""Clearances are exact up to here [m]; larger ones are reported as this."""
_MORE = 1.0 + 1e-6
"""Squares of distances are compared with so much to spare that rounding decides nothing."""


class Raster(NamedTuple):
    """A floor plan on a grid ``[row, column]``, row 0 at the smallest y.

    Attributes:
        solid: bool; the cell's centre lies in a solid part.
        clearance: float32 [m]; distance of the cell's centre to the nearest surface, at most ``CLEARANCE_CAP``.
        origin: (2,) [m]; lower-left corner of cell [0, 0].
        resolution: Side of a cell [m].
    """

    solid: NDArray[np.bool_]
    clearance: NDArray[np.float32]
    origin: NDArray[np.float64]
    resolution: float


def rasterize(
    edges: NDArray[np.float64],
    circles: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    shape: tuple[int, int],
    winding_outside: int = 0,
) -> Raster:
    """Rasterise oriented edges and circles.

    Args:
        edges: ``(E, 4)``, solid on the left.
        circles: ``(C, 3)`` as x, y, radius.
        origin: (2,) lower-left corner of cell [0, 0].
        resolution: Side of a cell [m].
        shape: (rows, columns).
        winding_outside: Winding number of free space (see ``Floorplan``).
    """
    winding = np.zeros((shape[0], shape[1] + 1), dtype=np.int32)
    _count_crossings(edges, origin[0], origin[1], resolution, winding)
    squares = np.full(shape, CLEARANCE_CAP**2)
    xs, ys = (origin[axis] + (np.arange(shape[1 - axis]) + 0.5) * resolution for axis in (0, 1))
    _edge_distances(edges, xs, ys, squares)
    clearance = np.sqrt(squares).astype(np.float32)
    solid = np.cumsum(winding[:, :-1], axis=1) != winding_outside
    _add_circles(circles, origin[0], origin[1], resolution, solid, clearance)
    return Raster(solid, clearance, origin, resolution)


@leaf
def _count_crossings(
    edges: NDArray[np.float64], x0: float, y0: float, resolution: float, winding: NDArray[np.int32]
) -> None:
    """Add each edge's crossings of the rows' centre lines to ``winding`` (rows, columns + 1), to be summed by row."""
    rows, columns = winding.shape[0], winding.shape[1] - 1
    for k in range(edges.shape[0]):
        x1, y1, x2, y2 = edges[k]
        if y1 == y2:
            continue
        sign = 1 if y2 < y1 else -1  # walking down has the solid part to the right: winding + 1 from there on
        low, high = min(y1, y2), max(y1, y2)
        first = max(0, math.ceil((low - y0) / resolution - 0.5))
        last = min(rows - 1, math.ceil((high - y0) / resolution - 0.5) - 1)
        for row in range(first, last + 1):
            y = y0 + (row + 0.5) * resolution
            x = x1 + (y - y1) / (y2 - y1) * (x2 - x1)
            column = math.ceil((x - x0) / resolution - 0.5)
            winding[row, min(max(column, 0), columns)] += sign


@leaf
def _edge_distances(
    edges: NDArray[np.float64], xs: NDArray[np.float64], ys: NDArray[np.float64], squares: NDArray[np.float64]
) -> None:
    """Lower ``squares`` (rows, columns) to the squared distance of each cell's centre to the edges.

    Args:
        edges: (E, 4).
        xs: (columns,) of the centres [m].
        ys: (rows,) of the centres [m].
        squares: Output; exact up to the square of ``CLEARANCE_CAP``.
    """
    rows, columns = squares.shape
    spacing = xs[1] - xs[0] if columns > 1 else CLEARANCE_CAP
    for k in range(edges.shape[0]):
        x1, y1, x2, y2 = edges[k]
        ex, ey = x2 - x1, y2 - y1
        squared = max(ex * ex + ey * ey, 1e-300)
        share = 1.0 / squared
        r0, r1 = _centres_near(min(y1, y2) - CLEARANCE_CAP, max(y1, y2) + CLEARANCE_CAP, ys[0], spacing, rows)
        c0, c1 = _centres_near(min(x1, x2) - CLEARANCE_CAP, max(x1, x2) + CLEARANCE_CAP, xs[0], spacing, columns)
        for row in range(r0, r1):
            py = ys[row] - y1
            for column in range(c0, c1):  # without branches, so that the compiler takes several cells at once
                px = xs[column] - x1
                along, across = px * ex + py * ey, px * ey - py * ex
                beyond = max(max(-along, along - squared), 0.0)
                away = (across * across + beyond * beyond) * share
                squares[row, column] = min(away, squares[row, column])


@inlined
def _centres_near(low: float, high: float, first: float, spacing: float, count: int) -> tuple[int, int]:
    """First and last + 1 of ``count`` centres from ``low`` to ``high``, or one more on either side."""
    return max(int((low - first) / spacing), 0), min(int((high - first) / spacing) + 2, count)


@leaf
def _add_circles(
    circles: NDArray[np.float64],
    x0: float,
    y0: float,
    resolution: float,
    solid: NDArray[np.bool_],
    clearance: NDArray[np.float32],
) -> None:
    """Make cells within circles ``solid`` and lower ``clearance`` to the distance from their rims."""
    rows, columns = clearance.shape
    for k in range(circles.shape[0]):
        cx, cy, radius = circles[k]
        reach = radius + CLEARANCE_CAP
        r0, r1 = max(0, int((cy - reach - y0) / resolution)), min(rows - 1, int((cy + reach - y0) / resolution))
        c0, c1 = max(0, int((cx - reach - x0) / resolution)), min(columns - 1, int((cx + reach - x0) / resolution))
        for row in range(r0, r1 + 1):
            dy = y0 + (row + 0.5) * resolution - cy
            for column in range(c0, c1 + 1):
                dx = x0 + (column + 0.5) * resolution - cx
                farthest = radius + clearance[row, column]
                if dx * dx + dy * dy > _MORE * farthest * farthest:
                    continue
                gap = math.hypot(dx, dy) - radius
                solid[row, column] |= gap < 0.0
                clearance[row, column] = min(clearance[row, column], abs(gap))
