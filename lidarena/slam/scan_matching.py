"""Scan matching: Gauss-Newton on the likelihood field, with the odometry as prior.

Minimises ½ (x − x̄)ᵀ Ω (x − x̄) + (1/s²) Σ ρ(e_i(x)), where e_i is the distance of point i to the nearest known wall along the
point's own normal and ρ is Welsch's function, σ²(1 − exp(−e²/2σ²)): points on walls that the map does not know weigh nothing.
Because the normal is the scan's and not the map's, a bare corridor gives no information along itself.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from lidarena.slam.likelihood_field import SIGMA, sample, sector_of


class MatcherParameters(NamedTuple):
    """Scan matcher settings.

    Attributes:
        points: Points of a scan that are matched, evenly chosen.
        iterations: Gauss-Newton steps at most.
        deviation: s, standard deviation of a point's distance to its wall, sensor and map together [m].
    """

    points: int = 72
    iterations: int = 8
    deviation: float = 0.04


@njit(cache=True, nogil=True)
def match(
    field: NDArray[np.uint16],
    origin: NDArray[np.float64],
    resolution: float,
    chosen: NDArray[np.int64],
    points: NDArray[np.float64],
    normals: NDArray[np.float64],
    angles: NDArray[np.float64],
    parameters: MatcherParameters,
    prior: NDArray[np.float64],
    information: NDArray[np.float64],
    pose: NDArray[np.float64],
    posterior: NDArray[np.float64],
) -> float:
    """Move ``pose`` (3,) to the best match and return the log-likelihood of the scan under the map and the prior.

    The likelihood is Laplace's approximation of ∫ p(z | m, x) p(x | x̄, Ω) dx, the weight of FastSLAM 2 and gmapping's
    improved proposal (Grisetti et al. 2007, eq. 13), up to a constant that all particles share.

    Args:
        field: (rows, columns) likelihood field.
        origin: (2,) its lower-left corner [m].
        resolution: [m].
        chosen: (n,) indices of the points to match.
        points: (≥, 2) in the sensor's frame.
        normals: (≥, 2) unit normals there.
        angles: (≥,) the normals' directions [rad].
        parameters: Settings.
        prior: (3,) x̄, the pose that the odometry predicts.
        information: (3, 3) Ω, inverse covariance of the prior.
        pose: (3,) starting value; overwritten by the result.
        posterior: (3, 3) output, information matrix of the result.
    """
    step = np.empty(3)
    gradient = np.empty(3)
    missed = 0.0
    for _ in range(parameters.iterations):
        missed = _linearise(field, origin, resolution, chosen, points, normals, angles, pose, posterior, gradient)
        _add_prior(parameters.deviation, prior, information, pose, posterior, gradient)
        solve(posterior, gradient, step)
        pose[0] += step[0]
        pose[1] += step[1]
        pose[2] += step[2]
        if abs(step[0]) + abs(step[1]) < 5e-4 and abs(step[2]) < 5e-4:
            break
    missed = _linearise(field, origin, resolution, chosen, points, normals, angles, pose, posterior, gradient)
    quadratic = _add_prior(parameters.deviation, prior, information, pose, posterior, gradient)
    fit = -missed * (SIGMA / parameters.deviation) ** 2
    return fit - 0.5 * quadratic + 0.5 * math.log(determinant(information) / determinant(posterior))


@njit(cache=True, nogil=True)
def _linearise(
    field: NDArray[np.uint16],
    origin: NDArray[np.float64],
    resolution: float,
    chosen: NDArray[np.int64],
    points: NDArray[np.float64],
    normals: NDArray[np.float64],
    angles: NDArray[np.float64],
    pose: NDArray[np.float64],
    hessian: NDArray[np.float64],
    gradient: NDArray[np.float64],
) -> float:
    """Sum Welsch-weighted normal equations into ``hessian`` (3, 3) and ``gradient`` (3,); returns Σ (1 − f)."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    scale = SIGMA * SIGMA / resolution
    hxx = hxy = hyy = hxt = hyt = htt = gx = gy = gt = missed = 0.0
    for i in chosen:
        px, py = cos * points[i, 0] - sin * points[i, 1], sin * points[i, 0] + cos * points[i, 1]
        u = (pose[0] + px - origin[0]) / resolution - 0.5
        v = (pose[1] + py - origin[1]) / resolution - 0.5
        f, fu, fv = sample(field, u, v, sector_of(angles[i] + pose[2]))
        missed += 1.0 - f
        if f > 0.01:
            nx, ny = cos * normals[i, 0] - sin * normals[i, 1], sin * normals[i, 0] + cos * normals[i, 1]
            nt = ny * px - nx * py
            pull = scale * (fu * nx + fv * ny)
            hxx, hxy, hyy = hxx + f * nx * nx, hxy + f * nx * ny, hyy + f * ny * ny
            hxt, hyt, htt = hxt + f * nx * nt, hyt + f * ny * nt, htt + f * nt * nt
            gx, gy, gt = gx + pull * nx, gy + pull * ny, gt + pull * nt
    hessian[0, 0], hessian[0, 1], hessian[0, 2] = hxx, hxy, hxt
    hessian[1, 0], hessian[1, 1], hessian[1, 2] = hxy, hyy, hyt
    hessian[2, 0], hessian[2, 1], hessian[2, 2] = hxt, hyt, htt
    gradient[0], gradient[1], gradient[2] = gx, gy, gt
    return missed


@njit(cache=True, nogil=True)
def _add_prior(
    deviation: float,
    prior: NDArray[np.float64],
    information: NDArray[np.float64],
    pose: NDArray[np.float64],
    hessian: NDArray[np.float64],
    gradient: NDArray[np.float64],
) -> float:
    """Weigh the matching by 1/s² and add the odometry's prior; returns (x − x̄)ᵀ Ω (x − x̄)."""
    weight = 1.0 / (deviation * deviation)
    dx, dy, dt = pose[0] - prior[0], pose[1] - prior[1], pose[2] - prior[2]
    dt -= 2.0 * math.pi * math.floor((dt + math.pi) / (2.0 * math.pi))
    quadratic = 0.0
    for k in range(3):
        away = information[k, 0] * dx + information[k, 1] * dy + information[k, 2] * dt
        gradient[k] = gradient[k] * weight - away
        quadratic += away * (dx if k == 0 else dy if k == 1 else dt)
        for j in range(3):
            hessian[k, j] = hessian[k, j] * weight + information[k, j]
    return quadratic


@njit(cache=True, nogil=True)
def determinant(m: NDArray[np.float64]) -> float:
    """Determinant of a symmetric 3×3 matrix, at least 1e-300."""
    a, b, c, d, e, f = m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2]
    return max(a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d), 1e-300)


@njit(cache=True, nogil=True)
def invert(m: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Inverse of a symmetric positive definite 3×3 matrix."""
    a, b, c, d, e, f = m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2]
    over = 1.0 / determinant(m)
    out[0, 0], out[1, 1], out[2, 2] = (d * f - e * e) * over, (a * f - c * c) * over, (a * d - b * b) * over
    out[0, 1] = out[1, 0] = (c * e - b * f) * over
    out[0, 2] = out[2, 0] = (b * e - c * d) * over
    out[1, 2] = out[2, 1] = (b * c - a * e) * over


@njit(cache=True, nogil=True)
def solve(m: NDArray[np.float64], right: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Solve m · out = right for a symmetric positive definite 3×3 matrix."""
    inverse = np.empty((3, 3))
    invert(m, inverse)
    for k in range(3):
        out[k] = inverse[k, 0] * right[0] + inverse[k, 1] * right[1] + inverse[k, 2] * right[2]
