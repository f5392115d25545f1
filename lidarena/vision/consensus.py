"""RANSAC of a rigid motion between two clouds, judged by the pixels."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.base.random_streams import uniform
from lidarena.vision.camera import StereoCamera

Floats = NDArray[np.float64]

_TRIES = 150
"""Hypotheses; half the matches may be wrong, then (1/2)³ of the samples are right."""


def find_motion(
    camera: StereoCamera, before: Floats, after: Floats, pixels: Floats, limit: float, stream: NDArray[np.uint64]
) -> tuple[Floats, NDArray[np.bool_]]:
    """Find the motion on which most matches agree.

    Args:
        camera: Of both pairs.
        before: (N, 3) points in the first frame, N at least 3.
        after: (N, 3) the same in the second frame.
        pixels: (N, 4) of the points in the second pair.
        limit: A match agrees if it is nearer than this in both images [pixels].
        stream: State (4,) of the random stream that draws the samples, which moves on.

    Returns:
        The motion (4, 4), and which matches agree (N,).
    """
    optics = np.array([camera.focal, camera.center_x, camera.center_y, camera.baseline])
    motion, agree = np.eye(4), np.zeros(len(before), np.bool_)
    _search(optics, before, after, pixels, limit, stream, motion, agree)
    return motion, agree


@leaf
def _triad(points: Floats, i: int, j: int, k: int, out: Floats) -> bool:
    """Write the axes (3, 3) that three points span, as rows; False if they are nearly on a line."""
    for d in range(3):
        out[0, d] = points[j, d] - points[i, d]
        out[1, d] = points[k, d] - points[i, d]
    length = math.sqrt(out[0, 0] ** 2 + out[0, 1] ** 2 + out[0, 2] ** 2)
    other = math.sqrt(out[1, 0] ** 2 + out[1, 1] ** 2 + out[1, 2] ** 2)
    if length < 1e-6 or other < 1e-6:
        return False
    along = 0.0
    for d in range(3):
        out[0, d] /= length
        along += out[0, d] * out[1, d]
    for d in range(3):
        out[1, d] -= along * out[0, d]
    height = math.sqrt(out[1, 0] ** 2 + out[1, 1] ** 2 + out[1, 2] ** 2)
    if height < 0.05 * other:
        return False
    for d in range(3):
        out[1, d] /= height
    out[2, 0] = out[0, 1] * out[1, 2] - out[0, 2] * out[1, 1]
    out[2, 1] = out[0, 2] * out[1, 0] - out[0, 0] * out[1, 2]
    out[2, 2] = out[0, 0] * out[1, 1] - out[0, 1] * out[1, 0]
    return True


@leaf
def _judge(
    optics: Floats, motion: Floats, before: Floats, pixels: Floats, limit: float, agree: NDArray[np.bool_]
) -> float:
    """Fill which matches agree; returns the truncated sum of squares (MSAC)."""
    total, most = 0.0, limit * limit
    for n in range(len(before)):
        x, y, z = (
            motion[0, 0] * before[n, 0] + motion[0, 1] * before[n, 1] + motion[0, 2] * before[n, 2] + motion[0, 3],
            motion[1, 0] * before[n, 0] + motion[1, 1] * before[n, 1] + motion[1, 2] * before[n, 2] + motion[1, 3],
            motion[2, 0] * before[n, 0] + motion[2, 1] * before[n, 1] + motion[2, 2] * before[n, 2] + motion[2, 3],
        )
        square = 2.0 * most
        if z > 1e-3:
            left, row = optics[0] * x / z + optics[1], optics[0] * y / z + optics[2]
            right = left - optics[0] * optics[3] / z
            off_left = (pixels[n, 0] - left) ** 2 + (pixels[n, 1] - row) ** 2
            off_right = (pixels[n, 2] - right) ** 2 + (pixels[n, 3] - row) ** 2
            square = max(off_left, off_right)
        agree[n] = square < most
        total += min(square, most)
    return total


@kernel
def _search(
    optics: Floats,
    before: Floats,
    after: Floats,
    pixels: Floats,
    limit: float,
    stream: NDArray[np.uint64],
    motion: Floats,
    agree: NDArray[np.bool_],
) -> None:
    """Write the best hypothesis and who agrees with it."""
    count, least = len(before), np.inf
    one, two, guess, now = np.empty((3, 3)), np.empty((3, 3)), np.eye(4), np.empty(count, np.bool_)
    for _ in range(_TRIES):
        i, j, k = int(uniform(stream) * count), int(uniform(stream) * count), int(uniform(stream) * count)
        if i in (j, k) or j == k or not _triad(before, i, j, k, one) or not _triad(after, i, j, k, two):
            continue
        for r in range(3):
            for c in range(3):
                guess[r, c] = two[0, r] * one[0, c] + two[1, r] * one[1, c] + two[2, r] * one[2, c]
        for r in range(3):
            guess[r, 3] = 0.0
            for n in (i, j, k):
                turned = guess[r, 0] * before[n, 0] + guess[r, 1] * before[n, 1] + guess[r, 2] * before[n, 2]
                guess[r, 3] += (after[n, r] - turned) / 3.0
        total = _judge(optics, guess, before, pixels, limit, now)
        if total < least:
            least = total
            motion[...] = guess
            agree[...] = now
