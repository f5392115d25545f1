"""Scan matching: Gauss-Newton on the likelihood field, with the odometry as prior.

Minimises ½ (x − x̄)ᵀ Ω (x − x̄) + (1/s²) Σ ρ(e_i(x)), where e_i is the distance of point i to the nearest known wall
along the point's own normal and ρ is Welsch's function, σ²(1 − exp(−e²/2σ²)): points on walls that the map does not
know weigh nothing. Because the normal is the scan's and not the map's, a bare corridor gives no information along
itself.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.likelihood_field import (
    FULL,
    ROUND_UP,
    SECTORS,
    SIGMA,
    TILE,
    TILE_BITS,
    facing,
    facing_mask,
    field_at,
)
from lidarena.slam.symmetric import Symmetric, Vector, determinant, inverse, times
from lidarena.world.kernels import inlined, leaf

_OVER_RELAXATION = 1.4
"""A wall that was stamped from several poses has a flattened crest: plain steps fall short, by half in the mean."""


class MatcherParameters(NamedTuple):
    """Scan matcher settings.

    Attributes:
        points: Points of a scan that are matched, evenly chosen.
        iterations: Gauss-Newton steps at most.
        tolerance: Steps shorter than this [m, rad] end the search.
        deviation: s, standard deviation of a point's distance to its wall, sensor and map together [m].
    """

    points: int = 32
    iterations: int = 8
    tolerance: float = 4e-3
    deviation: float = 0.02


@leaf
def match(
    tiles: NDArray[np.uint16],
    table: NDArray[np.int32],
    origin: NDArray[np.float64],
    resolution: float,
    points: NDArray[np.float64],
    parameters: MatcherParameters,
    prior: NDArray[np.float64],
    information: Symmetric,
    pose: NDArray[np.float64],
) -> tuple[float, Symmetric]:
    """Move ``pose`` (3,) to the best match; returns the scan's log-likelihood and the result's information matrix.

    The likelihood is Laplace's approximation of ∫ p(z | m, x) p(x | x̄, Ω) dx, the weight of FastSLAM 2 and gmapping's
    improved proposal (Grisetti et al. 2007, eq. 13), up to a constant that all particles share.

    Args:
        tiles: (capacity, TILE + 2, TILE + 2) the world's tiles, see ``likelihood_field.Fields``.
        table: (A, B) the particle's table of them.
        origin: (2,) its lower-left corner [m].
        resolution: [m].
        points: (n, 5) the points to match, as ``scan_points.extract_points`` gives them.
        parameters: Settings.
        prior: (3,) x̄, the pose that the odometry predicts.
        information: Ω, inverse covariance of the prior.
        pose: (3,) starting value; overwritten by the result.
    """
    cells, names = tiles.reshape(-1), table.reshape(-1)
    missed = quadratic = 0.0
    posterior = information
    for _ in range(parameters.iterations):
        missed, hessian, gradient = _linearise(cells, names, table, origin[0], origin[1], resolution, points, pose)
        quadratic, posterior, slope = _add_prior(parameters.deviation, prior, information, pose, hessian, gradient)
        step = times(inverse(posterior), slope)
        for k in range(3):
            pose[k] += _OVER_RELAXATION * step[k]
        if abs(step[0]) + abs(step[1]) < parameters.tolerance and abs(step[2]) < parameters.tolerance:
            break
    fit = -missed * (SIGMA / parameters.deviation) ** 2
    return fit - 0.5 * quadratic + 0.5 * math.log(determinant(information) / determinant(posterior)), posterior


@leaf
def misfit(
    tiles: NDArray[np.uint16],
    table: NDArray[np.int32],
    origin: NDArray[np.float64],
    resolution: float,
    points: NDArray[np.float64],
    pose: NDArray[np.float64],
) -> float:
    """Σ (1 − f) of ``points`` (n, 5) seen from ``pose`` (3,): how many are not on a known wall; see ``match``.

    Read off the cells that the points lie in, which is coarser than ``_linearise`` and five times as fast.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    per_cell = 1.0 / resolution
    start_u, start_v = (pose[0] - origin[0]) * per_cell, (pose[1] - origin[1]) * per_cell
    turn = pose[2] * (SECTORS / (2.0 * math.pi)) + ROUND_UP
    cells = tiles.reshape(-1)
    missed = float(points.shape[0])
    for i in range(points.shape[0]):
        u = start_u + (cos * points[i, 0] - sin * points[i, 1]) * per_cell
        v = start_v + (sin * points[i, 0] + cos * points[i, 1]) * per_cell
        missed -= field_at(cells, table, math.floor(u), math.floor(v), np.int64(turn + points[i, 4]))
    return missed


@leaf
def _linearise(
    cells: NDArray[np.uint16],
    names: NDArray[np.int32],
    table: NDArray[np.int32],
    x0: float,
    y0: float,
    resolution: float,
    points: NDArray[np.float64],
    pose: NDArray[np.float64],
) -> tuple[float, Symmetric, Vector]:
    """Σ (1 − f) of the points seen from ``pose`` (3,), and the Welsch-weighted normal equations; see ``match``.

    Field and gradient are read off the quadratic B-spline over the nearest 3 × 3 cells: its gradient is continuous,
    where a bilinear one jumps from cell to cell and keeps Gauss-Newton from settling. Flat, unsigned indices spare the
    tests for negative ones: ``cells`` and ``names`` are the tiles and their table in one row each.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    per_cell = 1.0 / resolution
    start_u, start_v = (pose[0] - x0) * per_cell, (pose[1] - y0) * per_cell
    turn = pose[2] * (SECTORS / (2.0 * math.pi)) + ROUND_UP
    tiles_across = table.shape[1]
    end_u, end_v = float(tiles_across * TILE), float(table.shape[0] * TILE)
    side = TILE + 2
    hxx = hxy = hyy = hxt = hyt = htt = gx = gy = gt = missed = 0.0
    for i in range(points.shape[0]):
        px, py = cos * points[i, 0] - sin * points[i, 1], sin * points[i, 0] + cos * points[i, 1]
        u, v = start_u + px * per_cell, start_v + py * per_cell
        if not (u >= 0.0 and v >= 0.0 and u < end_u and v < end_v):
            missed += 1.0
            continue
        c, r = np.int64(u), np.int64(v)
        a, b = u - c - 0.5, v - r - 0.5  # from the cell's centre, ±½
        allowed = facing_mask(np.int64(turn + points[i, 4]))
        tile = np.int64(names[np.uint64((r >> TILE_BITS) * tiles_across + (c >> TILE_BITS))])
        corner = tile * (side * side) + (r & (TILE - 1)) * side + (c & (TILE - 1))
        low, low_slope = _spline(cells, corner, a, allowed)
        mid, mid_slope = _spline(cells, corner + side, a, allowed)
        high, high_slope = _spline(cells, corner + 2 * side, a, allowed)
        before, at, after = 0.5 * (0.5 - b) ** 2, 0.75 - b * b, 0.5 * (0.5 + b) ** 2
        f = (before * low + at * mid + after * high) * (1.0 / FULL)
        missed += 1.0 - f
        nx, ny = cos * points[i, 2] - sin * points[i, 3], sin * points[i, 2] + cos * points[i, 3]
        nt = ny * px - nx * py
        pull = (before * low_slope + at * mid_slope + after * high_slope) * nx
        pull += ((b - 0.5) * low - 2.0 * b * mid + (b + 0.5) * high) * ny
        hxx, hxy, hyy = hxx + f * nx * nx, hxy + f * nx * ny, hyy + f * ny * ny
        hxt, hyt, htt = hxt + f * nx * nt, hyt + f * ny * nt, htt + f * nt * nt
        gx, gy, gt = gx + pull * nx, gy + pull * ny, gt + pull * nt
    # a spline over cells widens a Gaussian by a quarter cell²
    scale = (SIGMA * SIGMA + 0.25 * resolution * resolution) * per_cell / FULL
    return missed, (hxx, hxy, hxt, hyy, hyt, htt), (scale * gx, scale * gy, scale * gt)


@inlined
def _spline(cells: NDArray[np.uint16], first: int, a: float, allowed: int) -> tuple[float, float]:
    """Quadratic B-spline through three cells from ``first`` on, at ``a`` ∈ ±½ from the middle; and its slope."""
    k, one, two = np.uint64(first), np.uint64(1), np.uint64(2)
    f0 = facing(np.int64(cells[k]), allowed)
    f1 = facing(np.int64(cells[k + one]), allowed)
    f2 = facing(np.int64(cells[k + two]), allowed)
    value = 0.5 * (0.5 - a) ** 2 * f0 + (0.75 - a * a) * f1 + 0.5 * (0.5 + a) ** 2 * f2
    return value, (a - 0.5) * f0 - 2.0 * a * f1 + (a + 0.5) * f2


@inlined
def _add_prior(
    deviation: float,
    prior: NDArray[np.float64],
    information: Symmetric,
    pose: NDArray[np.float64],
    h: Symmetric,
    gradient: Vector,
) -> tuple[float, Symmetric, Vector]:
    """Weigh the matching by 1/s² and add the odometry's prior; (x − x̄)ᵀ Ω (x − x̄), information and gradient."""
    k, o = 1.0 / (deviation * deviation), information
    dx, dy, dt = pose[0] - prior[0], pose[1] - prior[1], pose[2] - prior[2]
    dt -= 2.0 * math.pi * math.floor((dt + math.pi) / (2.0 * math.pi))
    away = times(information, (dx, dy, dt))
    quadratic = away[0] * dx + away[1] * dy + away[2] * dt
    total = (h[0] * k + o[0], h[1] * k + o[1], h[2] * k + o[2], h[3] * k + o[3], h[4] * k + o[4], h[5] * k + o[5])
    return quadratic, total, (gradient[0] * k - away[0], gradient[1] * k - away[1], gradient[2] * k - away[2])
