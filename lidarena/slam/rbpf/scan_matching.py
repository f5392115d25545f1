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

from lidarena.base.jit import inlined, leaf
from lidarena.slam.rbpf.likelihood_field import FULL, SIGMA, ParticleField
from lidarena.slam.rbpf.point_blocks import (
    AWAY_X,
    AWAY_Y,
    BLOCK,
    CELLS,
    FACING,
    FIT,
    FIT_X,
    FIT_Y,
    LEVER,
    NEXT,
    NORMAL_X,
    NORMAL_Y,
    PULL,
    ROW,
    ROWS,
    WALL_X,
    WALL_Y,
    PointBlocks,
    U,
    V,
    Workspace,
    facing,
    gather_around,
    gather_middle,
    locate,
)
from lidarena.slam.rbpf.symmetric import Symmetric, Vector, determinant, inverse, times

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
    field: ParticleField,
    points: PointBlocks,
    work: Workspace,
    parameters: MatcherParameters,
    prior: NDArray[np.float64],
    information: Symmetric,
    pose: NDArray[np.float64],
) -> tuple[float, Symmetric]:
    """Move ``pose`` (3,) to the best match; returns the scan's log-likelihood and the result's information matrix.

    The likelihood is Laplace's approximation of ∫ p(z | m, x) p(x | x̄, Ω) dx, the weight of FastSLAM 2 and gmapping's
    improved proposal (Grisetti et al. 2007, eq. 13), up to a constant that all particles share.

    Args:
        field: Of the particle.
        points: Those to match.
        work: Work space.
        parameters: Settings.
        prior: (3,) x̄, the pose that the odometry predicts.
        information: Ω, inverse covariance of the prior.
        pose: (3,) starting value; overwritten by the result.
    """
    missed = quadratic = 0.0
    posterior = information
    for _ in range(parameters.iterations):
        missed, hessian, gradient = _linearise(field, points, work, pose)
        quadratic, posterior, slope = _add_prior(parameters.deviation, prior, information, pose, hessian, gradient)
        step = times(inverse(posterior), slope)
        for k in range(3):
            pose[k] += _OVER_RELAXATION * step[k]
        if abs(step[0]) + abs(step[1]) < parameters.tolerance and abs(step[2]) < parameters.tolerance:
            break
    fit = -missed * (SIGMA / parameters.deviation) ** 2
    return fit - 0.5 * quadratic + 0.5 * math.log(determinant(information) / determinant(posterior)), posterior


@leaf
def match_cost(field: ParticleField, points: PointBlocks, work: Workspace, pose: NDArray[np.float64]) -> float:
    """Σ (1 − f) of the points seen from ``pose`` (3,): how many are not on a known wall; see ``match``.

    Read off the cells that the points lie in, which is coarser than ``_linearise`` and several times as fast.
    """
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    names, numbers, integers = field.table.reshape(-1), points.blocks.reshape(-1), work.integers
    missed = float(points.size)
    for block in range((points.size + BLOCK - 1) // BLOCK):
        here = min(BLOCK, points.size - block * BLOCK)
        locate(numbers, block, here, pose, cos, sin, field, work)
        gather_middle(field.cells, names, here, integers)
        for i in range(np.uint64(here)):
            missed -= facing(integers[i + CELLS], integers[i + FACING]) * (1.0 / FULL)
    return missed


@leaf
def _linearise(
    field: ParticleField, points: PointBlocks, work: Workspace, pose: NDArray[np.float64]
) -> tuple[float, Symmetric, Vector]:
    """Σ (1 − f) of the points seen from ``pose`` (3,), and the Welsch-weighted normal equations; see ``match``."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    names, numbers, reals = field.table.reshape(-1), points.blocks.reshape(-1), work.reals
    hxx = hxy = hyy = hxt = hyt = htt = gx = gy = gt = 0.0
    missed = float(points.size)
    for block in range((points.size + BLOCK - 1) // BLOCK):
        here = min(BLOCK, points.size - block * BLOCK)
        locate(numbers, block, here, pose, cos, sin, field, work)
        gather_around(field.cells, names, here, work.integers)
        _fit(numbers, block, here, cos, sin, work)
        for i in range(np.uint64(here)):  # by itself, since sums must be added in order
            f, fx, fy, pull = reals[i + FIT], reals[i + FIT_X], reals[i + FIT_Y], reals[i + PULL]
            nx, ny, nt = reals[i + WALL_X], reals[i + WALL_Y], reals[i + LEVER]
            missed -= f
            hxx, hxy, hyy = hxx + fx * nx, hxy + fx * ny, hyy + fy * ny
            hxt, hyt, htt = hxt + fx * nt, hyt + fy * nt, htt + f * nt * nt
            gx, gy, gt = gx + pull * nx, gy + pull * ny, gt + pull * nt
    # a spline over cells widens a Gaussian by a quarter cell²
    resolution = field.resolution
    scale = (SIGMA * SIGMA + 0.25 * resolution * resolution) / (resolution * FULL)
    return missed, (hxx, hxy, hxt, hyy, hyt, htt), (scale * gx, scale * gy, scale * gt)


@leaf
def _fit(points: NDArray[np.float64], block: int, count: int, cos: float, sin: float, work: Workspace) -> None:
    """Field, slope along the normal, normal and its lever of a block's points, from the cells around them.

    Field and gradient are read off the quadratic B-spline over the nearest 3 × 3 cells: its gradient is continuous,
    where a bilinear one jumps from cell to cell and keeps Gauss-Newton from settling.
    """
    base, reals, integers = np.uint64(block) * ROWS, work.reals, work.integers
    for i in range(np.uint64(count)):
        allowed, k = integers[i + FACING], i + CELLS
        a = reals[i + U] - np.int32(reals[i + U]) - 0.5  # from the cell's centre, ±½
        b = reals[i + V] - np.int32(reals[i + V]) - 0.5
        low, low_slope = _spline(integers, k, a, allowed)
        mid, mid_slope = _spline(integers, k + ROW, a, allowed)
        high, high_slope = _spline(integers, k + ROW + ROW, a, allowed)
        before, at, after = 0.5 * (0.5 - b) ** 2, 0.75 - b * b, 0.5 * (0.5 + b) ** 2
        f = (before * low + at * mid + after * high) * (1.0 / FULL)
        nx = cos * points[base + i + NORMAL_X] - sin * points[base + i + NORMAL_Y]
        ny = sin * points[base + i + NORMAL_X] + cos * points[base + i + NORMAL_Y]
        pull = (before * low_slope + at * mid_slope + after * high_slope) * nx
        pull += ((b - 0.5) * low - 2.0 * b * mid + (b + 0.5) * high) * ny
        reals[i + FIT], reals[i + FIT_X], reals[i + FIT_Y], reals[i + PULL] = f, f * nx, f * ny, pull
        reals[i + WALL_X], reals[i + WALL_Y] = nx, ny
        reals[i + LEVER] = ny * reals[i + AWAY_X] - nx * reals[i + AWAY_Y]


@inlined
def _spline(integers: NDArray[np.int32], first: int, a: float, allowed: int) -> tuple[float, float]:
    """Quadratic B-spline through three neighbouring cells, at ``a`` ∈ ±½ from the middle; and its slope."""
    f0, f1 = facing(integers[first], allowed), facing(integers[first + NEXT], allowed)
    f2 = facing(integers[first + NEXT + NEXT], allowed)
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
