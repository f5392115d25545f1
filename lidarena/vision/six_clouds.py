"""Three positions at once: the 6-cloud step of Bobkov et al., on pixels or on clouds."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.vision.bundle import Observations, adjust
from lidarena.vision.camera import StereoCamera
from lidarena.vision.matching import Matches
from lidarena.vision.motion import MotionEstimate, MotionOptions, noise_of
from lidarena.vision.rigid_motion import inverse, motion_of, moved, rotation_of

Floats = NDArray[np.float64]


class ThreeViews(NamedTuple):
    """Matches between three positions: the last one, the middle and the next; with the motions from each alone.

    Attributes:
        near: From the last to the middle.
        far: From the middle to the next.
        whole: From the last to the next.
    """

    near: tuple[Matches, MotionEstimate]
    far: tuple[Matches, MotionEstimate]
    whole: tuple[Matches, MotionEstimate]


class SixClouds(NamedTuple):
    """Motions that fit all three pairings.

    Attributes:
        near: From the last position to the middle.
        whole: From the last position to the next; the first times that from the middle.
    """

    near: MotionEstimate
    whole: MotionEstimate


def fit_six_clouds(views: ThreeViews, camera: StereoCamera, options: MotionOptions) -> SixClouds:
    """Fit the two motions, 12 numbers, to all three pairings at once.

    With ``objective="reprojection"`` a feature that was matched in two pairings or all three is one point, and pixels
    are fitted; with ``"clouds"`` it is Bobkov et al.'s sum of distances in the six clouds, in its consistent form
    F = Σ|M - H₁ L|² + Σ|N - H₂ M|² + Σ|N - H₂ H₁ L|² of columns.

    Args:
        views: The pairings.
        camera: Of all.
        options: How.
    """
    if options.objective == "clouds":
        return _fit_clouds(views, camera)
    tracks = _tracks(views)
    seen = _observations(tracks)
    near, whole = views.near[1].motion, views.whole[1].motion
    starts = np.stack([np.eye(4), near, whole])
    first = seen.frame[seen.first[:-1]]
    points = camera.triangulate(seen.pixels[seen.first[:-1]])
    for number, pose in enumerate(starts):
        points[first == number] = moved(inverse(pose), points[first == number])
    fitted = adjust(camera, starts, points, seen)
    noise = noise_of(fitted, 12)
    covariance = fitted.covariance * noise**2
    return SixClouds(
        MotionEstimate(fitted.poses[1], covariance[:6, :6], views.near[1].agree, noise),
        MotionEstimate(fitted.poses[2], covariance[6:, 6:], views.whole[1].agree, noise),
    )


_Track = dict[int, tuple[Floats, float]]
"""Pixels (4,) and sigma of one point by the number of the view."""


def _tracks(views: ThreeViews) -> list[_Track]:
    """Join the matches of a feature; the pairing that speaks first is believed where two disagree."""
    tracks: list[_Track] = []
    owner: dict[tuple[int, int], int] = {}
    for (matches, estimate), (a, b) in ((views.near, (0, 1)), (views.whole, (0, 2)), (views.far, (1, 2))):
        for k in np.flatnonzero(estimate.agree).tolist():
            one, two = int(matches.first[k]), int(matches.second[k])
            sigma = float(matches.sigma[k])
            number = owner.get((a, one))
            if number is None:
                number = owner[a, one] = len(tracks)
                tracks.append({a: (matches.pixels_a[k], sigma)})
            if b in tracks[number] or (two >= 0 and (b, two) in owner):
                continue
            tracks[number][b] = matches.pixels_b[k], sigma
            if two >= 0:
                owner[b, two] = number
    return [track for track in tracks if len(track) > 1]


def _observations(tracks: list[_Track]) -> Observations:
    frames = [sorted(track) for track in tracks]
    first = np.cumsum([0, *(len(one) for one in frames)]).astype(np.int64)
    pixels = np.array([track[view][0] for track, one in zip(tracks, frames, strict=True) for view in one])
    sigma = np.array([track[view][1] for track, one in zip(tracks, frames, strict=True) for view in one])
    return Observations(first, np.concatenate(frames).astype(np.int64), pixels, np.stack([sigma, sigma], axis=1))


def _fit_clouds(views: ThreeViews, camera: StereoCamera, steps: int = 15) -> SixClouds:
    """Gauss-Newton on the distances between the clouds."""
    near, far = views.near[1].motion.copy(), views.far[1].motion.copy()
    clouds = [
        tuple(camera.triangulate(pixels[estimate.agree]) for pixels in (matches.pixels_a, matches.pixels_b))
        for matches, estimate in (views.near, views.far, views.whole)
    ]
    for _ in range(steps):
        left, right = np.zeros((12, 12)), np.zeros(12)
        turned = far[:3, :3]
        parts = [(clouds[0], near, 0), (clouds[1], far, 1), (clouds[2], far @ near, 2)]
        for (before, after), motion, kind in parts:
            ahead = moved(motion, before)
            rest = after - ahead
            lever = np.zeros((len(ahead), 3, 12))
            if kind != 1:
                inner, through = (ahead, np.eye(3)) if kind == 0 else (moved(near, before), turned)
                lever[:, :, 0:3], lever[:, :, 3:6] = through @ -_skew(inner), through
            if kind != 0:
                lever[:, :, 6:9], lever[:, :, 9:12] = -_skew(ahead), np.eye(3)
            left += np.einsum("nki,nkj->ij", lever, lever)
            right += np.einsum("nki,nk->i", lever, rest)
        step = np.asarray(np.linalg.solve(left + 1e-12 * np.eye(12), right), np.float64)
        near = motion_of(rotation_of(step[0:3]), step[3:6]) @ near
        far = motion_of(rotation_of(step[6:9]), step[9:12]) @ far
        if np.abs(step).max() < 1e-10:
            break
    return SixClouds(views.near[1]._replace(motion=near), views.whole[1]._replace(motion=far @ near))


def _skew(points: Floats) -> Floats:
    """The matrices (N, 3, 3) of the cross products with points (N, 3)."""
    out = np.zeros((len(points), 3, 3))
    x, y, z = points.T
    out[:, 0, 1], out[:, 0, 2], out[:, 1, 0] = -z, y, z
    out[:, 1, 2], out[:, 2, 0], out[:, 2, 1] = -x, -y, x
    return out
