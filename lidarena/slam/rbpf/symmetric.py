"""Symmetric 3×3 matrices as six numbers xx, xy, xt, yy, yt, tt: the compiler keeps them in registers."""

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined

Symmetric: TypeAlias = tuple[float, float, float, float, float, float]
Vector: TypeAlias = tuple[float, float, float]


@inlined
def load(m: NDArray[np.float64], added: float) -> Symmetric:
    """The numbers of an array (3, 3), with ``added`` on the diagonal."""
    return m[0, 0] + added, m[0, 1], m[0, 2], m[1, 1] + added, m[1, 2], m[2, 2] + added


@inlined
def determinant(m: Symmetric) -> float:
    """Determinant, at least 1e-300."""
    a, b, c, d, e, f = m
    value: float = max(a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d), 1e-300)
    return value


@inlined
def inverse(m: Symmetric) -> Symmetric:
    """Inverse of a positive definite matrix."""
    a, b, c, d, e, f = m
    k = 1.0 / determinant(m)
    return (
        (d * f - e * e) * k,
        (c * e - b * f) * k,
        (b * e - c * d) * k,
        (a * f - c * c) * k,
        (b * c - a * e) * k,
        (a * d - b * b) * k,
    )


@inlined
def times(m: Symmetric, v: Vector) -> Vector:
    """M · v."""
    a, b, c, d, e, f = m
    return a * v[0] + b * v[1] + c * v[2], b * v[0] + d * v[1] + e * v[2], c * v[0] + e * v[1] + f * v[2]


@inlined
def rotated(m: Symmetric, theta: float) -> Symmetric:
    """Information of a motion in the frame of heading ``theta``, expressed in the world's frame."""
    cos, sin = math.cos(theta), math.sin(theta)
    a, b, c, d, e, f = m
    return (
        cos * cos * a - 2.0 * cos * sin * b + sin * sin * d,
        cos * sin * (a - d) + (cos * cos - sin * sin) * b,
        cos * c - sin * e,
        sin * sin * a + 2.0 * cos * sin * b + cos * cos * d,
        sin * c + cos * e,
        f,
    )
