"""Planar poses (…, 3) of x, y [m] and theta [rad], whole arrays at a time."""

import numpy as np
from numpy.typing import NDArray

Poses = NDArray[np.float64]


def wrapped(angles: Poses) -> Poses:
    """The same angles in (-π, π]."""
    turned: Poses = -np.remainder(np.pi - angles, 2.0 * np.pi) + np.pi
    return turned


def compose(poses: Poses, motions: Poses) -> Poses:
    """``poses`` moved by ``motions`` that are given in the poses' own frames."""
    cos, sin = np.cos(poses[..., 2]), np.sin(poses[..., 2])
    dx, dy = motions[..., 0], motions[..., 1]
    x, y = poses[..., 0] + cos * dx - sin * dy, poses[..., 1] + sin * dx + cos * dy
    return np.stack([x, y, wrapped(poses[..., 2] + motions[..., 2])], axis=-1)


def between(first: Poses, second: Poses) -> Poses:
    """Where ``second`` is, seen from ``first``: the motion that leads from one to the other."""
    cos, sin = np.cos(first[..., 2]), np.sin(first[..., 2])
    dx, dy = second[..., 0] - first[..., 0], second[..., 1] - first[..., 1]
    return np.stack([cos * dx + sin * dy, cos * dy - sin * dx, wrapped(second[..., 2] - first[..., 2])], axis=-1)


def inverse(motions: Poses) -> Poses:
    """The way back."""
    return between(motions, np.zeros_like(motions))
