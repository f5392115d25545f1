"""How uncertain a pose is: the optimality criteria of optimal experimental design, and the weights' entropy."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

COVARIANCE_FLOOR = (4e-6, 4e-6, 1e-6)
"""Added to the diagonal of a pose's covariance (m², m², rad²): what the scan matcher itself leaves open, 2 mm
and 1 mrad, so that a filter whose particles coincide is certain but never singular."""


@leaf
def d_optimality(covariance: NDArray[np.float64]) -> float:
    """D-optimality det(Σ)^(1/l) = exp(mean ln λ_k) of a 3×3 pose covariance; geometric mean of its eigenvalues."""
    a, b, c = covariance[0, 0], covariance[0, 1], covariance[0, 2]
    d, e, f = covariance[1, 1], covariance[1, 2], covariance[2, 2]
    determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)
    mean: float = max(determinant, 0.0) ** (1.0 / 3.0)
    return mean


def a_optimality(covariance: NDArray[np.float64]) -> float:
    """A-optimality trace(Σ)/l, the mean eigenvalue."""
    return float(np.trace(covariance) / len(covariance))


def e_optimality(covariance: NDArray[np.float64]) -> float:
    """E-optimality, the largest eigenvalue of Σ."""
    return float(np.linalg.eigvalsh(covariance)[-1])


@leaf
def weight_entropy(weights: NDArray[np.float64]) -> float:
    """Entropy −Σ w ln w of normalised weights (N,) [nat]; at most ln N."""
    total = 0.0
    for w in weights:
        if w > 0.0:
            total -= w * math.log(w)
    return total


@leaf
def score_entropy(scores: NDArray[np.float64]) -> float:
    """What gmapping publishes as ``~entropy`` [nat]: −Σ p ln p with p_i = l_i / Σ l over *log*-likelihoods (N,) ≤ 0.

    For comparison with DA-SLAM's "average uncertainty" only: it mostly tells how long ago the last resampling was,
    where all l are 0 and it is ln N.
    """
    total = 0.0
    for score in scores:
        total += score
    if total == 0.0:
        return math.log(scores.shape[0])
    entropy = 0.0
    for score in scores:
        p = score / total
        if p > 0.0:
            entropy -= p * math.log(p)
    return entropy


@leaf
def pose_moments(
    particles: NDArray[np.float64],
    weights: NDArray[np.float64],
    mean: NDArray[np.float64],
    covariance: NDArray[np.float64],
) -> None:
    """Weighted mean (3,) and covariance (3, 3) of poses (N, 3), the heading averaged on the circle, plus the floor.

    Args:
        particles: (N, 3) x, y, theta.
        weights: (N,) normalised.
        mean: (3,) output.
        covariance: (3, 3) output.
    """
    x = y = cos = sin = 0.0
    for i in range(particles.shape[0]):
        x += weights[i] * particles[i, 0]
        y += weights[i] * particles[i, 1]
        cos += weights[i] * math.cos(particles[i, 2])
        sin += weights[i] * math.sin(particles[i, 2])
    theta = math.atan2(sin, cos)
    mean[0], mean[1], mean[2] = x, y, theta
    covariance[:] = 0.0
    for i in range(particles.shape[0]):
        dx, dy = particles[i, 0] - x, particles[i, 1] - y
        dt = particles[i, 2] - theta
        dt -= 2.0 * math.pi * math.floor((dt + math.pi) / (2.0 * math.pi))
        w = weights[i]
        covariance[0, 0] += w * dx * dx
        covariance[0, 1] += w * dx * dy
        covariance[0, 2] += w * dx * dt
        covariance[1, 1] += w * dy * dy
        covariance[1, 2] += w * dy * dt
        covariance[2, 2] += w * dt * dt
    covariance[1, 0], covariance[2, 0], covariance[2, 1] = covariance[0, 1], covariance[0, 2], covariance[1, 2]
    for k in range(3):
        covariance[k, k] += COVARIANCE_FLOOR[k]


def predictive_scale(weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """What the covariance of weighted poses (…, N) is to be multiplied by to be that of the pose itself, (…,).

    n poses drawn from a Gaussian scatter a little less around their own mean than around its middle, the mean is off
    the middle, and where the poses happen to lie close together the error looks large beside them. The pose that they
    stand for is distributed around their mean as Student's t, whose covariance is (n + 1) / (n - 5) times theirs in
    three dimensions (Gelman et al. 2013, section 3.6). For weighted poses n is N_eff; from less than 6 the tails are so
    heavy that there is no covariance, and n + 1 is taken.
    """
    n = 1.0 / np.sum(weights * weights, axis=-1)
    scale: NDArray[np.float64] = (n + 1.0) / np.maximum(n - 5.0, 1.0)
    return scale


@leaf
def compound_covariance(
    motion: NDArray[np.float64],
    covariance: NDArray[np.float64],
    dx: float,
    dy: float,
    vx: float,
    vy: float,
    vt: float,
) -> None:
    """Covariance (3, 3) of a motion (3,) followed by a reading (dx, dy) with variances vx, vy, vt in its own frame."""
    cos, sin = math.cos(motion[2]), math.sin(motion[2])
    lever = (-sin * dx - cos * dy, cos * dx - sin * dy)
    for k in range(2):  # J Σ Jᵀ with J = [[1, 0, lever₀], [0, 1, lever₁], [0, 0, 1]]: first the rows, then the columns
        for j in range(3):
            covariance[k, j] += lever[k] * covariance[2, j]
    for k in range(2):
        for j in range(3):
            covariance[j, k] += lever[k] * covariance[j, 2]
    covariance[0, 0] += cos * cos * vx + sin * sin * vy
    covariance[1, 1] += sin * sin * vx + cos * cos * vy
    covariance[0, 1] += cos * sin * (vx - vy)
    covariance[1, 0] += cos * sin * (vx - vy)
    covariance[2, 2] += vt
