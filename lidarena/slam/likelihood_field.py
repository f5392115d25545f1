"""A particle's map: the likelihood field of the walls it has seen, each wall remembering which way it faces.

A cell holds exp(−d²/2σ²), d the distance of its centre to the nearest end point, in 12 bits, and in 4 bits the direction of
that wall's normal. A point is compared only with walls that face its own way: the two faces of a thin wall, which lie
closer together than the field is wide, never attract each other.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

SIGMA = 0.08
"""Width of the field [m]: wide enough to pull in a pose that is 10 cm off, narrow enough for 5 cm cells."""
FULL = 4095
"""The field's value on a wall."""
SECTORS = 16
"""Directions that a wall may face."""
ROUND_UP = 10.0 * SECTORS + 0.5
"""Added to a direction in sectors so that cutting off its fraction rounds it; whole turns do not count."""
_REACH = 4
"""Cells from an end point up to which it is stamped; 0.2 m is 2.5 σ."""
_FRESH = 0.75
"""A point is stamped where the field is lower: no wall is known within about 6 cm."""


@njit(cache=True, nogil=True, forceinline=True)
def facing(cell: int, sector: int) -> float:
    """The cell's value if its wall faces within about 100° of ``sector`` (≥ 0, taken modulo 16), else 0."""
    return np.float64(cell >> 4 if ((cell + 4 - sector) & 15) <= 8 else 0)


@njit(cache=True, nogil=True)
def field_at(field: NDArray[np.uint16], u: float, v: float, sector: int) -> float:
    """Field (rows, columns) at column ``u``, row ``v`` (cell centres at integers) of walls that face ``sector``."""
    if not (u >= 0.0 and v >= 0.0 and u < field.shape[1] - 2.0 and v < field.shape[0] - 2.0):
        return 0.0
    column, row = np.int64(u), np.int64(v)
    a, b = u - column, v - row
    f00, f01 = facing(np.int64(field[row, column]), sector), facing(np.int64(field[row, column + 1]), sector)
    f10, f11 = facing(np.int64(field[row + 1, column]), sector), facing(np.int64(field[row + 1, column + 1]), sector)
    low, high = f00 + a * (f01 - f00), f10 + a * (f11 - f10)
    return (low + b * (high - low)) / FULL


@njit(cache=True, nogil=True)
def register_points(
    field: NDArray[np.uint16],
    pose: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    count: int,
    points: NDArray[np.float64],
    box: NDArray[np.int64],
) -> None:
    """Stamp a scan's points, seen from a pose, into a field where it does not know them yet.

    Args:
        field: (rows, columns).
        pose: (3,) x, y, theta.
        origin: (2,) lower-left corner of the field [m].
        resolution: [m].
        count: Number of points.
        points: (≥ count, 5) as ``scan_points.extract_points`` gives them.
        box: (4,) first row, last row + 1, first column, last column + 1 that hold anything; grown.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    turn = pose[2] * (SECTORS / (2.0 * math.pi)) + ROUND_UP
    for i in range(count):
        x = pose[0] + cos * points[i, 0] - sin * points[i, 1]
        y = pose[1] + sin * points[i, 0] + cos * points[i, 1]
        u, v = (x - origin[0]) / resolution - 0.5, (y - origin[1]) / resolution - 0.5
        sector = np.int64(turn + points[i, 4])
        if field_at(field, u, v, sector) < _FRESH:
            _stamp(field, u, v, sector & (SECTORS - 1), resolution, box)


@njit(cache=True, nogil=True)
def _stamp(
    field: NDArray[np.uint16], u: float, v: float, sector: int, resolution: float, box: NDArray[np.int64]
) -> None:
    """Raise the cells around (u, v) to the Gaussian of their distance to it."""
    column, row = int(math.floor(u + 0.5)), int(math.floor(v + 0.5))
    c0, c1 = max(column - _REACH, 0), min(column + _REACH + 1, field.shape[1])
    r0, r1 = max(row - _REACH, 0), min(row + _REACH + 1, field.shape[0])
    if c0 >= c1 or r0 >= r1:
        return
    factor = -0.5 * (resolution / SIGMA) ** 2
    across = np.empty(2 * _REACH + 1)
    for c in range(c0, c1):
        across[c - c0] = math.exp(factor * (c - u) ** 2)
    for r in range(r0, r1):
        along = FULL * math.exp(factor * (r - v) ** 2)
        for c in range(c0, c1):
            value = int(along * across[c - c0] + 0.5)
            if value > field[r, c] >> 4:
                field[r, c] = (value << 4) | sector
    box[0], box[1] = min(box[0], r0), max(box[1], r1)
    box[2], box[3] = min(box[2], c0), max(box[3], c1)
