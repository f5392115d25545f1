"""Features matched over the four images of two pairs."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import FeatureOptions, Features, match_descriptors, track
from lidarena.vision.rigid_motion import moved

Floats = NDArray[np.float64]

_GATE = 60.0
"""A feature is looked for so near to where it is expected [pixels], and as near again for each second of doubt."""
_SAME = 1.0
"""Tracks that Lucas-Kanade does not lead back to within so many pixels are dropped."""


class Matches(NamedTuple):
    """Features that two pairs show.

    Attributes:
        first: (N,) numbers among the first pair's features.
        second: (N,) numbers among the second's; -1 where they were tracked instead of found there.
        pixels_a: (N, 4) in the first pair.
        pixels_b: (N, 4) in the second.
        sigma: (N,) relative standard deviation [pixels].
    """

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    pixels_a: Floats
    pixels_b: Floats
    sigma: Floats


def match_pairs(
    a: Features, b: Features, camera: StereoCamera, options: FeatureOptions, guess: Floats | None = None
) -> Matches:
    """Match the features of two pairs.

    Args:
        a: Of the first pair.
        b: Of the second.
        camera: Of both.
        options: How.
        guess: (4, 4) about how the camera moves from the first to the second; None: not known.
    """
    expected = None
    if guess is not None and len(a.pixels):
        expected = camera.project(moved(guess, camera.triangulate(a.pixels)))
    if options.kind == "tracks":
        return _follow(a, b, camera, options, expected)
    likely = None
    if expected is not None:
        off = np.abs(expected[:, None, :2] - b.pixels[None, :, :2]).max(axis=2)
        likely = off <= _GATE
    first, second = match_descriptors(a.descriptors, b.descriptors, options.ratio, likely)
    sigma = 0.5 * (a.sigma[first] + b.sigma[second])
    found = Matches(first, second, a.pixels[first], b.pixels[second], sigma)
    return _refined(found, a, b, options) if options.kind == "orb" else found


def _refined(found: Matches, a: Features, b: Features, options: FeatureOptions) -> Matches:
    """Move the second pair's pixels to where Lucas-Kanade sees the first's surroundings."""
    if a.images is None or b.images is None or not len(found.first):
        return found
    one, two = found.pixels_a.astype(np.float32), found.pixels_b.astype(np.float32)
    left, fits = track(a.images[0], b.images[0], one[:, :2], two[:, :2], levels=1)
    right, also = track(a.images[0], b.images[1], one[:, :2], two[:, 2:], levels=1)
    fits &= also & (np.abs(left[:, 1] - right[:, 1]) <= options.row_error)
    pixels = np.hstack([left, right]).astype(np.float64)
    return Matches(found.first[fits], found.second[fits], found.pixels_a[fits], pixels[fits], found.sigma[fits])


def _follow(
    a: Features, b: Features, camera: StereoCamera, options: FeatureOptions, expected: Floats | None
) -> Matches:
    """Follow corners from the first pair's left image to both images of the second, and back."""
    assert a.images is not None and b.images is not None
    here = a.pixels.astype(np.float32)
    aim = here if expected is None else np.where(np.isfinite(expected), expected, here).astype(np.float32)
    left, fits = track(a.images[0], b.images[0], here[:, :2], aim[:, :2])
    back, returned = track(b.images[0], a.images[0], left, here[:, :2])
    fits &= returned & (np.abs(back - here[:, :2]).max(axis=1, initial=0.0) < _SAME)
    right, also = track(a.images[1], b.images[1], here[:, 2:], aim[:, 2:])
    fits &= also & (np.abs(left[:, 1] - right[:, 1]) <= options.row_error) & (left[:, 0] - right[:, 0] > 0.1)
    chosen = np.flatnonzero(fits)
    pixels = np.hstack([left, right]).astype(np.float64)[chosen]
    return Matches(chosen, np.full(len(chosen), -1), a.pixels[chosen], pixels, a.sigma[chosen])
