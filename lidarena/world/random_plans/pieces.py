"""Pieces of furniture: what stands about the origin, on legs of 3 to 6 cm or solid, free-standing or against a wall."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

LEG = (0.015, 0.03)
"""Radius of a leg [m]: 3 to 6 cm thick."""
_SEAT = 0.42
"""Distance between the legs of a chair [m]."""

Circle = tuple[float, float, float]
Box = tuple[float, float, float, float]


class Piece(NamedTuple):
    """Things that stand together.

    Attributes:
        circles: x, y, radius [m].
        boxes: x0, y0, x1, y1 of solid rectangles [m].
    """

    circles: Sequence[Circle]
    boxes: Sequence[Box]

    @property
    def extent(self) -> Box:
        """x0, y0, x1, y1 of the rectangle around it [m]."""
        rims = [(x - radius, y - radius, x + radius, y + radius) for x, y, radius in self.circles]
        x0, y0, x1, y1 = zip(*rims, *self.boxes, strict=True)
        return min(x0), min(y0), max(x1), max(y1)

    @property
    def radius(self) -> float:
        """Of the smallest disc about the origin that holds it [m]."""
        reach = [math.hypot(x, y) + radius for x, y, radius in self.circles]
        reach += [math.hypot(max(-x0, x1), max(-y0, y1)) for x0, y0, x1, y1 in self.boxes]
        return max(reach)

    def placed(
        self, x: float, y: float, direction: tuple[float, float]
    ) -> tuple[list[Circle], list[NDArray[np.float64]]]:
        """Circles and corners (4, 2) with the origin at (x, y) and the x axis in a direction, a unit vector."""
        cos, sin = direction
        circles = [(x + u * cos - v * sin, y + u * sin + v * cos, radius) for u, v, radius in self.circles]
        spin = np.array([(cos, sin), (-sin, cos)])
        return circles, [
            np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]) @ spin + (x, y) for x0, y0, x1, y1 in self.boxes
        ]


Drawing = Callable[[np.random.Generator], Piece]


def table(rng: np.random.Generator) -> Piece:
    """A table on four legs; at each of its sides a chair, more or less pulled out, in half of the cases."""
    length, depth = float(rng.uniform(0.8, 1.4)), float(rng.uniform(0.6, 0.9))
    circles = _legs(rng, 0.0, 0.0, length, depth)
    for side in (1.0, -1.0):
        if rng.random() < 0.5:
            circles += _legs(rng, 0.0, side * (0.5 * depth + float(rng.uniform(0.1, 0.3))), _SEAT, _SEAT)
    return Piece(circles, ())


def round_table(rng: np.random.Generator) -> Piece:
    """A table on one foot with two to four chairs around it."""
    circles = [(0.0, 0.0, float(rng.uniform(0.03, 0.2)))]
    away, seats = float(rng.uniform(0.65, 0.8)), int(rng.integers(2, 5))
    for k in range(seats):
        angle = 2.0 * math.pi * k / seats
        chair_at = away * math.cos(angle), away * math.sin(angle)
        circles += Piece(_legs(rng, 0.0, 0.0, _SEAT, _SEAT), ()).placed(*chair_at, (math.cos(angle), math.sin(angle)))[
            0
        ]
    return Piece(circles, ())


def chair(rng: np.random.Generator) -> Piece:
    """Four legs."""
    return Piece(_legs(rng, 0.0, 0.0, _SEAT, _SEAT), ())


def pillar(rng: np.random.Generator) -> Piece:
    """Something round: a bin, a plant, a column."""
    return Piece([(0.0, 0.0, float(rng.uniform(0.08, 0.3)))], ())


def crate(rng: np.random.Generator) -> Piece:
    """A solid box: a chest, an armchair."""
    return _box(float(rng.uniform(0.4, 1.0)), float(rng.uniform(0.3, 0.7)))


def sofa(rng: np.random.Generator) -> Piece:
    """A long solid box, and half of the time a low table on legs before it."""
    length, depth = float(rng.uniform(1.4, 2.0)), float(rng.uniform(0.7, 0.9))
    if rng.random() < 0.5:
        return _box(length, depth)
    shift = 0.55  # both about the middle of the two
    couch = (-0.5 * length, -shift - 0.5 * depth, 0.5 * length, -shift + 0.5 * depth)
    return Piece(_legs(rng, 0.0, shift, 0.9, 0.5), (couch,))


def cupboard(rng: np.random.Generator) -> Piece:
    """A solid box against a wall, which is y = 0; as all that follows."""
    return _against_wall(float(rng.uniform(0.6, 1.6)), float(rng.uniform(0.3, 0.5)))


def bed(rng: np.random.Generator) -> Piece:
    """A solid box that reaches far into the room."""
    return _against_wall(float(rng.uniform(0.9, 1.6)), float(rng.uniform(1.9, 2.1)))


def desk(rng: np.random.Generator) -> Piece:
    """A table on four legs, mostly with a chair before it."""
    length, depth = float(rng.uniform(1.0, 1.5)), float(rng.uniform(0.55, 0.75))
    circles = _legs(rng, 0.0, 0.5 * depth + LEG[1], length, depth)
    if rng.random() < 0.7:
        circles += _legs(rng, 0.0, depth + float(rng.uniform(0.1, 0.35)), _SEAT, _SEAT)
    return Piece(circles, ())


STANDING: tuple[Drawing, ...] = (table, round_table, chair, pillar, crate, sofa)
"""What stands free."""
AT_WALLS: tuple[Drawing, ...] = (cupboard, bed, desk)
"""What stands with its back to a wall."""


def _legs(rng: np.random.Generator, x: float, y: float, length: float, depth: float) -> list[Circle]:
    radius, half_length, half_depth = float(rng.uniform(*LEG)), 0.5 * length, 0.5 * depth
    return [(x + u, y + v, radius) for u in (-half_length, half_length) for v in (-half_depth, half_depth)]


def _box(length: float, depth: float) -> Piece:
    return Piece((), ((-0.5 * length, -0.5 * depth, 0.5 * length, 0.5 * depth),))


def _against_wall(length: float, depth: float) -> Piece:
    return Piece((), ((-0.5 * length, 0.0, 0.5 * length, depth),))
