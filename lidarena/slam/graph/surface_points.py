"""Scans as points with the normals of the surfaces that they lie on, in the laser's own frame."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

_HALF_WIDTH = 8
"""Most beams to either side that a surface is fitted over."""
_RADIUS, _SPACINGS = 0.12, 3.0
"""A surface is fitted over so much around a point [m], or so many spacings of the beams if that is more."""


class BeamFan(NamedTuple):
    """Evenly spaced beams.

    Attributes:
        first: Direction of the first beam [rad].
        step: From a beam to the next [rad], not zero.
        beams: How many.
    """

    first: float
    step: float
    beams: int


class SurfacePoints(NamedTuple):
    """Points of ``S`` scans of ``B`` beams.

    Attributes:
        points: (S, B, 2) float32, where the beams ended in the laser's frame [m].
        normals: (S, B, 2) float32, the surface's unit normal towards the laser; zero where no surface is known.
        weights: (S, B) float32: 0 no return, else how much the point says, up to 1.
    """

    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    weights: NDArray[np.float32]


def empty_points(scans: int, beams: int) -> SurfacePoints:
    """Room for so many scans."""
    shape = (scans, beams)
    return SurfacePoints(
        np.zeros((*shape, 2), np.float32), np.zeros((*shape, 2), np.float32), np.zeros(shape, np.float32)
    )


def enlarged_points(known: SurfacePoints) -> SurfacePoints:
    """The same with twice the room."""
    more = empty_points(2 * known.points.shape[0], known.points.shape[1])
    for old, new in zip(known, more, strict=True):
        new[: len(old)] = old
    return more


@leaf
def enter_scan(store: SurfacePoints, s: int, ranges: NDArray[np.float32], fan: BeamFan, reach: float) -> int:
    """Enter a scan as number ``s``.

    Args:
        store: Where to.
        s: Which scan.
        ranges: (B,) [m]; what is not above 0 and below ``reach`` is no return.
        fan: The beams.
        reach: [m].

    Returns:
        The number of points.
    """
    points, normals, weights = store.points[s], store.normals[s], store.weights[s]
    count = 0
    for k in range(fan.beams):
        normals[k, 0] = normals[k, 1] = 0.0
        weights[k] = 0.0
        if 0.0 < ranges[k] < reach:
            angle = fan.first + k * fan.step
            points[k, 0], points[k, 1] = ranges[k] * math.cos(angle), ranges[k] * math.sin(angle)
            weights[k] = 1.0
            count += 1
    for k in range(fan.beams):
        if weights[k] > 0.0:
            _fit_surface(points, normals, weights, k, max(_RADIUS, _SPACINGS * abs(fan.step) * ranges[k]))
    return count


@leaf
def _fit_surface(
    points: NDArray[np.float32], normals: NDArray[np.float32], weights: NDArray[np.float32], k: int, radius: float
) -> None:
    """Fit a line over the points around point k, and weigh it by how straight they lie."""
    px, py = float(points[k, 0]), float(points[k, 1])
    n, sx, sy, sxx, sxy, syy = 1, 0.0, 0.0, 0.0, 0.0, 0.0
    for sign in (-1, 1):
        for j in range(1, _HALF_WIDTH + 1):
            m = k + sign * j
            if m < 0 or m >= points.shape[0] or weights[m] == 0.0:
                break
            dx, dy = points[m, 0] - px, points[m, 1] - py
            if dx * dx + dy * dy > radius * radius:
                break
            n += 1
            sx, sy = sx + dx, sy + dy
            sxx, sxy, syy = sxx + dx * dx, sxy + dx * dy, syy + dy * dy
    if n < 3:
        weights[k] = 0.2
        return
    cxx, cxy, cyy = sxx / n - sx * sx / n / n, sxy / n - sx * sy / n / n, syy / n - sy * sy / n / n
    middle, half = 0.5 * (cxx + cyy), math.sqrt(0.25 * (cxx - cyy) ** 2 + cxy * cxy)
    along = 0.5 * math.atan2(2.0 * cxy, cxx - cyy)
    nx, ny = -math.sin(along), math.cos(along)
    if nx * px + ny * py > 0.0:
        nx, ny = -nx, -ny
    normals[k, 0], normals[k, 1] = nx, ny
    # a straight wall scatters by the laser's noise of a centimetre or two across, clutter by as much as along
    weights[k] = max(1.0 - math.sqrt(max(middle - half, 0.0) / (middle + half + 1e-9)) * 1.5, 0.2)
