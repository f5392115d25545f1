"""Warehouses: rows of racks, solid or on thin posts with pallets between them, aisles, and an open end."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.random_plans.options import draw_size
from lidarena.world.random_plans.pieces import LEG, Box, Circle

OPTIONS = {"aisle": (0.8, 4.0), "rack": (0.4, 2.0), "posts": (0.0, 1.0)}
"""Least width of an aisle [m]; depth of a rack [m]; share of the racks that stand on posts."""
_AISLE, _RACK, _POSTS = 1.2, 0.8, 0.5
_LEAST_AISLE = 0.8
"""Width of the aisles of halls that are too narrow for wider ones [m]."""
_WALL = 0.1
_BAY = 1.4
"""Longest distance between the posts of a rack [m]."""
_STORED = 0.45
"""Chance that something stands on the floor between the posts."""
_BESIDE = 0.07
"""From that to the posts' middles [m]: no robot fits in between."""


def random_warehouse(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a hall with rows of racks; every aisle can be left at both ends.

    Raises:
        MapError: No rack fits between two aisles.
    """
    width, height = draw_size(rng, options)
    narrow, rack = min(width, height) - 2.0 * _WALL, options.get("rack", _RACK)
    aisle = options.get("aisle", max(min(_AISLE, 0.5 * (narrow - rack)), _LEAST_AISLE))
    if narrow < 2.0 * aisle + rack - 1e-9:
        raise MapError(
            f"a warehouse of {width:g} m x {height:g} m has no room for a rack of {rack:g} m between aisles of "
            f"{aisle:g} m; smaller ones, or a larger plan, are needed"
        )
    upright = bool(rng.random() < 0.5)
    long, across = (height, width) if upright else (width, height)
    boxes, posts = _racks(rng, (long, across), (aisle, rack), options.get("posts", _POSTS))
    if upright:
        boxes, posts = boxes[:, [1, 0, 3, 2]], posts[:, [1, 0, 2]]
    half = 0.5 * _WALL
    corners = [(half, half), (width - half, half), (width - half, height - half), (half, height - half)]
    walls = [(*a, *b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    polygons = [np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]) for x0, y0, x1, y1 in boxes]
    middle = 0.5 * (_WALL + aisle)
    start = (middle, middle, float(rng.uniform(-np.pi, np.pi)))
    return Floorplan.from_shapes(name, (0.0, 0.0, width, height), walls, polygons, posts, _WALL, start)


def _racks(
    rng: np.random.Generator, size: tuple[float, float], widths: tuple[float, float], posts: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Boxes (n, 4) x0, y0, x1, y1 and posts (n, 3) x, y, radius of racks along x [m]."""
    (long, across), (aisle, rack) = size, widths
    inner = across - 2.0 * _WALL
    rows = max(int((inner - aisle) / (aisle + rack)), 1)
    step = (inner - rows * rack) / (rows + 1) + rack
    low, high = _WALL + aisle, long - _WALL - aisle * float(rng.uniform(1.0, 2.0))
    boxes: list[Box] = []
    legs: list[Circle] = []
    for row in range(rows):
        y = _WALL + (row + 1) * step - rack
        for x0, x1 in _pieces(rng, low, max(high, low + 0.5), aisle):
            if rng.random() < posts:
                standing, stored = _standing(rng, (x0, x1), y, rack)
                legs += standing
                boxes += stored
            else:
                boxes.append((x0, y, x1, y + rack))
    return np.array(boxes).reshape(-1, 4), np.array(legs).reshape(-1, 3)


def _pieces(rng: np.random.Generator, low: float, high: float, aisle: float) -> list[tuple[float, float]]:
    """A row in one piece, or in two with a cross aisle between them where it is long."""
    if high - low < 3.0 * aisle or rng.random() < 0.4:
        return [(low, high)]
    cut = float(rng.uniform(low + aisle, high - 2.0 * aisle))
    return [(low, cut), (cut + aisle, high)]


def _standing(
    rng: np.random.Generator, ends: tuple[float, float], y: float, rack: float
) -> tuple[list[Circle], list[Box]]:
    """Posts of a rack on both its sides, and what is stored on the floor of some of its bays."""
    radius, bays = float(rng.uniform(*LEG)), max(math.ceil((ends[1] - ends[0]) / _BAY), 1)
    xs = np.linspace(*ends, bays + 1).tolist()
    posts = [(x, side, radius) for x in xs for side in (y + radius, y + rack - radius)]
    full = rng.random(bays) < _STORED
    stored = [
        (a + _BESIDE, y + LEG[1], b - _BESIDE, y + rack - LEG[1])
        for a, b, one in zip(xs[:-1], xs[1:], full.tolist(), strict=True)
        if one
    ]
    return posts, stored
