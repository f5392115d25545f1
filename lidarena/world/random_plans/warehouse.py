"""Warehouses: rows of racks, solid or on thin posts, with aisles between them and an open end."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.random_plans.options import draw_size

OPTIONS = {"aisle": (0.8, 4.0), "rack": (0.4, 2.0), "posts": (0.0, 1.0)}
"""Least width of an aisle [m]; depth of a rack [m]; share of the racks that stand on posts."""
_AISLE, _RACK, _POSTS = 1.2, 0.8, 0.4
_WALL = 0.1
_POST = (0.02, 0.03)
"""Radius of a post [m]."""
_BAY = 1.1
"""Longest distance between the posts of a rack [m]."""
_PALLET = (0.5, 0.9)
"""Sides of the pallets at the open end [m]."""


def random_warehouse(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a hall with rows of racks; every aisle can be left at both ends.

    Raises:
        MapError: No rack fits between two aisles.
    """
    width, height = draw_size(rng, options)
    aisle, rack = options.get("aisle", _AISLE), options.get("rack", _RACK)
    if min(width, height) - 2.0 * _WALL < 2.0 * aisle + rack:
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
    boxes: list[tuple[float, float, float, float]] = []
    legs: list[tuple[float, float, float]] = []
    for row in range(rows):
        y = _WALL + (row + 1) * step - rack
        for x0, x1 in _pieces(rng, low, max(high, low + 0.5), aisle):
            if rng.random() < posts:
                legs += _standing(rng, x0, x1, y, rack)
            elif rng.random() < 0.9:
                boxes.append((x0, y, x1, y + rack))
            else:
                deep = float(rng.uniform(*_PALLET))
                boxes.append((x0, y, min(x0 + deep, x1), y + min(deep, rack)))
    return np.array(boxes).reshape(-1, 4), np.array(legs).reshape(-1, 3)


def _pieces(rng: np.random.Generator, low: float, high: float, aisle: float) -> list[tuple[float, float]]:
    """A row in one piece, or in two with a cross aisle between them where it is long."""
    if high - low < 3.0 * aisle or rng.random() < 0.4:
        return [(low, high)]
    cut = float(rng.uniform(low + aisle, high - 2.0 * aisle))
    return [(low, cut), (cut + aisle, high)]


def _standing(
    rng: np.random.Generator, x0: float, x1: float, y: float, rack: float
) -> list[tuple[float, float, float]]:
    """Posts of a rack on both its sides."""
    radius, bays = float(rng.uniform(*_POST)), max(math.ceil((x1 - x0) / _BAY), 1)
    return [(float(x), side, radius) for x in np.linspace(x0, x1, bays + 1) for side in (y + radius, y + rack - radius)]
