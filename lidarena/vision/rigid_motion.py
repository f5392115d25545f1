"""Rigid motions as 4 × 4 matrices in column form, ``X_b = R X_a + t``."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

Floats = NDArray[np.float64]


@leaf
def write_rotation(x: float, y: float, z: float, out: Floats) -> None:
    """Write the rotation by the vector (x, y, z) [rad] to ``out`` (3, 3) (Rodrigues)."""
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-9:
        sine, cosine = 1.0 - angle * angle / 6.0, 0.5 - angle * angle / 24.0
    else:
        sine, cosine = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    out[0, 0], out[1, 1], out[2, 2] = (
        1.0 - cosine * (y * y + z * z), 1.0 - cosine * (x * x + z * z), 1.0 - cosine * (x * x + y * y)
    )  # fmt: skip
    out[0, 1], out[1, 0] = cosine * x * y - sine * z, cosine * x * y + sine * z
    out[0, 2], out[2, 0] = cosine * x * z + sine * y, cosine * x * z - sine * y
    out[1, 2], out[2, 1] = cosine * y * z - sine * x, cosine * y * z + sine * x


def rotation_of(vector: Floats) -> Floats:
    """The rotation matrix (3, 3) of a rotation vector (3,) [rad]."""
    out = np.empty((3, 3))
    write_rotation(*(float(part) for part in vector), out)
    return out


def vector_of(rotation: Floats) -> Floats:
    """The rotation vector (3,) [rad], of length at most π, of a rotation matrix (3, 3)."""
    skew = 0.5 * np.array(
        [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    )
    sine, cosine = float(np.linalg.norm(skew)), 0.5 * (float(np.trace(rotation)) - 1.0)
    angle = math.atan2(sine, cosine)
    if sine > 1e-6:
        return np.asarray(skew * (angle / sine))
    if cosine > 0.0:
        return skew
    axis = np.sqrt(np.maximum(0.5 * (np.diag(rotation) + 1.0), 0.0))  # half a turn: only the axis's signs are open
    first = int(np.argmax(axis))
    signs = np.where(rotation[first] < 0.0, -1.0, 1.0)
    signs[first] = 1.0
    return np.asarray(math.pi * axis * signs)


def motion_of(rotation: Floats, translation: Floats) -> Floats:
    """The matrix (4, 4) of a rotation (3, 3) and a translation (3,)."""
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = rotation, translation
    return out


def inverse(motion: Floats) -> Floats:
    """The motion (4, 4) back."""
    turned = motion[:3, :3].T
    return motion_of(turned, -turned @ motion[:3, 3])


def moved(motion: Floats, points: Floats) -> Floats:
    """Points (N, 3) after a motion (4, 4)."""
    return np.asarray(points @ motion[:3, :3].T + motion[:3, 3])


def orthonormal(rotation: Floats) -> Floats:
    """The rotation (3, 3) nearest to a matrix, such as one that rounding has worn off."""
    left, _, right = np.linalg.svd(rotation)
    return np.asarray(left @ np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))]) @ right)


def fit_motion(before: Floats, after: Floats, weights: Floats | None = None) -> Floats:
    """The motion (4, 4) with the least sum of squared distances of two clouds (Kabsch; Umeyama without scale).

    Args:
        before: (N, 3) points, three at least that are not on a line.
        after: (N, 3) the same after the motion.
        weights: (N,) of the squares; None: all the same.
    """
    share = np.ones(len(before)) if weights is None else weights
    share = share / share.sum()
    middle, target = share @ before, share @ after
    rotation = orthonormal((after - target).T @ ((before - middle) * share[:, None]))
    return motion_of(rotation, target - rotation @ middle)
