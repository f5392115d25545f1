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
_REACH = 4
"""Cells from an end point up to which it is stamped; 0.2 m is 2.5 σ."""
_FRESH = 0.88
"""A point is stamped where the field is lower: no wall is known within about 4 cm."""


@njit(cache=True, nogil=True, forceinline=True)
def sector_of(angle: float) -> int:
    """Sector 0 … 15 of a direction [rad]."""
    return int(math.floor(angle * (SECTORS / (2.0 * math.pi)) + 0.5)) & (SECTORS - 1)


@njit(cache=True, nogil=True, forceinline=True)
def _facing(cell: int, sector: int) -> int:
    """The cell's value if its wall faces within about 100° of ``sector``, else 0."""
    apart = ((cell & 15) - sector) & 15
    return cell >> 4 if apart <= 4 or apart >= 12 else 0


@njit(cache=True, nogil=True, forceinline=True)
def sample(field: NDArray[np.uint16], u: float, v: float, sector: int) -> tuple[float, float, float]:
    """Field and its gradient (per cell along columns, along rows) at column ``u``, row ``v`` (cell centres at integers).

    Args:
        field: (rows, columns).
        u: Column, fractional.
        v: Row, fractional.
        sector: Direction that the point's own wall faces.
    """
    column, row = int(math.floor(u)), int(math.floor(v))
    if column < 0 or row < 0 or column >= field.shape[1] - 1 or row >= field.shape[0] - 1:
        return 0.0, 0.0, 0.0
    a, b = u - column, v - row
    f00 = _facing(np.int64(field[row, column]), sector)
    f01 = _facing(np.int64(field[row, column + 1]), sector)
    f10 = _facing(np.int64(field[row + 1, column]), sector)
    f11 = _facing(np.int64(field[row + 1, column + 1]), sector)
    low, high = f00 + a * (f01 - f00), f10 + a * (f11 - f10)
    scale = 1.0 / FULL
    along = (1.0 - b) * (f01 - f00) + b * (f11 - f10)
    return (low + b * (high - low)) * scale, along * scale, (high - low) * scale


@njit(cache=True, nogil=True)
def register_points(
    field: NDArray[np.uint16],
    pose: NDArray[np.float64],
    origin: NDArray[np.float64],
    resolution: float,
    count: int,
    points: NDArray[np.float64],
    angles: NDArray[np.float64],
    box: NDArray[np.int64],
) -> None:
    """Stamp a scan's points, seen from a pose, into a field where it does not know them yet.

    Args:
        field: (rows, columns).
        pose: (3,) x, y, theta.
        origin: (2,) lower-left corner of the field [m].
        resolution: [m].
        count: Number of points.
        points: (≥ count, 2) in the sensor's frame.
        angles: (≥ count,) direction of the normals in the sensor's frame [rad].
        box: (4,) first row, last row + 1, first column, last column + 1 that hold anything; grown.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    for i in range(count):
        x = pose[0] + cos * points[i, 0] - sin * points[i, 1]
        y = pose[1] + sin * points[i, 0] + cos * points[i, 1]
        u, v = (x - origin[0]) / resolution - 0.5, (y - origin[1]) / resolution - 0.5
        sector = sector_of(angles[i] + pose[2])
        value, _, _ = sample(field, u, v, sector)
        if value < _FRESH:
            _stamp(field, u, v, sector, resolution, box)


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
