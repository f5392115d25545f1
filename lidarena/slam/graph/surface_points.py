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
_SURE, _GRAZING = 2, 12.0
"""So many beams to either side count wherever they ended, up to so many spacings from one to the next: along a corridor
beams graze the walls, and only what they meet far ahead tells the heading."""
_ROUGH = 0.04
"""Points that scatter by more across a line are no surface [m]."""


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
        extents: (S, B) float32, how far to either side the surface was seen [m].
    """

    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    weights: NDArray[np.float32]
    extents: NDArray[np.float32]


def empty_points(scans: int, beams: int) -> SurfacePoints:
    """Room for so many scans."""
    shape = (scans, beams)
    planar, single = (*shape, 2), shape
    zeros = (np.zeros(each, np.float32) for each in (planar, planar, single, single))
    return SurfacePoints(*zeros)


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
    points, normals, weights, extents = store.points[s], store.normals[s], store.weights[s], store.extents[s]
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
        extents[k] = 0.0
        if weights[k] > 0.0:
            _fit_surface(points, normals, weights, extents, k, abs(fan.step) * ranges[k])
    return count


@leaf
def _fit_surface(
    points: NDArray[np.float32],
    normals: NDArray[np.float32],
    weights: NDArray[np.float32],
    extents: NDArray[np.float32],
    k: int,
    spacing: float,
) -> None:
    """Fit a line over the points around point k, and weigh it by how straight they lie."""
    px, py = float(points[k, 0]), float(points[k, 1])
    radius, gap = max(_RADIUS, _SPACINGS * spacing), max(_RADIUS, _GRAZING * spacing)
    n, sx, sy, sxx, sxy, syy = 1, 0.0, 0.0, 0.0, 0.0, 0.0
    for sign in (-1, 1):
        lx, ly = px, py
        for j in range(1, _HALF_WIDTH + 1):
            m = k + sign * j
            if m < 0 or m >= points.shape[0] or weights[m] == 0.0:
                break
            dx, dy = points[m, 0] - px, points[m, 1] - py
            if (points[m, 0] - lx) ** 2 + (points[m, 1] - ly) ** 2 > gap * gap:
                break
            if j > _SURE and dx * dx + dy * dy > radius * radius:
                break
            lx, ly = float(points[m, 0]), float(points[m, 1])
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
    across = math.sqrt(max(middle - half, 0.0))
    # a straight wall scatters by the laser's noise of a centimetre or two across, clutter by much more
    weights[k] = 0.2 if across > _ROUGH else max(1.0 - 1.5 * across / math.sqrt(middle + half + 1e-9), 0.2)
    extents[k] = math.sqrt(middle + half)
