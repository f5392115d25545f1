"""The motion between two stereo pairs from matched features, and how certain it is."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.base.keyword_checks import check_choice, check_range
from lidarena.vision.bundle import Adjusted, Observations, adjust
from lidarena.vision.camera import StereoCamera
from lidarena.vision.consensus import find_motion
from lidarena.vision.matching import Matches
from lidarena.vision.rigid_motion import fit_motion, moved

Floats = NDArray[np.float64]

OBJECTIVES = ("reprojection", "clouds")
LEAST = 6
"""Matches that a motion needs at least."""


@dataclass(frozen=True)
class MotionOptions:
    """How a motion is found.

    Attributes:
        objective: What is least in the end: ``"reprojection"``, errors in the pixels of all images, points being
            fitted too, or ``"clouds"``, distances between the two triangulated clouds, as Bobkov et al. have it.
        limit: A match agrees with a motion if it is nearer than this in every image [pixels].

    Raises:
        ConfigError: A value out of range.
    """

    objective: str = "reprojection"
    limit: float = 2.5

    def __post_init__(self) -> None:
        check_choice("objective", self.objective, OBJECTIVES)
        check_range("limit", self.limit, 0.1, 50.0)


class MotionEstimate(NamedTuple):
    """A motion from one frame to another.

    Attributes:
        motion: (4, 4), ``X_b = R X_a + t``.
        covariance: (6, 6) of rotation vector [rad] and translation [m] after the motion, ``X' = exp(w) X + t``.
        agree: (N,) which matches agree with it.
        error: Root mean square of their pixels' residuals over their standard deviation, corrected for what was fitted.
    """

    motion: Floats
    covariance: Floats
    agree: NDArray[np.bool_]
    error: float


def estimate_motion(
    matches: Matches, camera: StereoCamera, options: MotionOptions, stream: NDArray[np.uint64]
) -> MotionEstimate:
    """Find the motion from the first pair's frame to the second's.

    Args:
        matches: Of the two pairs.
        camera: Of both.
        options: How.
        stream: State (4,) of the random stream that RANSAC draws from.

    Raises:
        VisionError: Fewer than ``LEAST`` matches, or fewer that agree.
    """
    clouds = camera.triangulate(matches.pixels_a), camera.triangulate(matches.pixels_b)
    whole = np.isfinite(clouds[0]).all(axis=1) & np.isfinite(clouds[1]).all(axis=1)
    _check_count(int(whole.sum()), "matched")
    usable = np.flatnonzero(whole)
    before, after, pixels = clouds[0][usable], clouds[1][usable], matches.pixels_b[usable]
    start, among = find_motion(camera, before, after, pixels, 1.5 * options.limit, stream)
    _check_count(int(among.sum()), "matched that agree on a motion")
    chosen = usable[among]
    first = fit_motion(clouds[0][chosen], clouds[1][chosen], clouds[0][chosen, 2] ** -4)
    if _median_error(camera, first, clouds[0], matches, chosen) < _median_error(
        camera, start, clouds[0], matches, chosen
    ):
        start = first
    if options.objective == "clouds":
        return _of_clouds(camera, clouds, matches, chosen, start)
    return _refined(camera, clouds[0], matches, usable, start, options.limit)


def _check_count(count: int, what: str) -> None:
    if count < LEAST:
        raise VisionError(f"{count} features are {what}; a motion needs {LEAST} at least")


def _median_error(
    camera: StereoCamera, motion: Floats, points: Floats, matches: Matches, chosen: NDArray[np.int64]
) -> float:
    off = camera.project(moved(motion, points[chosen])) - matches.pixels_b[chosen]
    return float(np.median(np.nan_to_num(np.abs(off).max(axis=1), nan=1e6)))


def two_views(matches: Matches, chosen: NDArray[np.int64]) -> Observations:
    """The pixels of chosen matches as observations of two views."""
    pixels = np.stack([matches.pixels_a[chosen], matches.pixels_b[chosen]], axis=1).reshape(-1, 4)
    sigma = np.repeat(matches.sigma[chosen], 2)
    first = 2 * np.arange(len(chosen) + 1)
    return Observations(first, np.tile(np.array([0, 1]), len(chosen)), pixels, np.stack([sigma, sigma], axis=1))


def _refined(
    camera: StereoCamera, points: Floats, matches: Matches, usable: NDArray[np.int64], start: Floats, limit: float
) -> MotionEstimate:
    """Fit motion and points to the pixels, look again who agrees, and fit once more."""
    motion = start
    for _ in range(2):
        off = np.abs(camera.project(moved(motion, points[usable])) - matches.pixels_b[usable]).max(axis=1)
        chosen = usable[np.nan_to_num(off, nan=1e6) < 2.0 * limit]
        _check_count(len(chosen), "matched that agree on a motion")
        fitted = adjust(camera, np.stack([np.eye(4), motion]), points[chosen], two_views(matches, chosen))
        motion = fitted.poses[1]
    agree = np.zeros(len(points), np.bool_)
    agree[chosen] = True
    error = noise_of(fitted, 6)
    return MotionEstimate(motion, fitted.covariance * error**2, agree, error)


def noise_of(fitted: Adjusted, parameters: int) -> float:
    """Standard deviation of the pixels relative to what was assumed, from the residuals of a fit; robust.

    Args:
        fitted: The fit.
        parameters: Of the poses that were fitted; three more a point were.
    """
    squares = np.minimum(fitted.errors, 3.0) ** 2 * 4.0
    freedom = max(4 * len(squares) - 3 * len(fitted.points) - parameters, 1)
    return float(np.sqrt(squares.sum() / freedom))


def _of_clouds(
    camera: StereoCamera, clouds: tuple[Floats, Floats], matches: Matches, chosen: NDArray[np.int64], start: Floats
) -> MotionEstimate:
    """The motion with the least squared distances between the clouds, without the farthest of them."""
    motion = start
    for _ in range(3):
        off = np.linalg.norm(moved(motion, clouds[0][chosen]) - clouds[1][chosen], axis=1)
        kept = chosen[off <= 3.0 * np.median(off) + 1e-9]
        motion = fit_motion(clouds[0][kept], clouds[1][kept])
    _check_count(len(kept), "matched that agree on a motion")
    agree = np.zeros(len(clouds[0]), np.bool_)
    agree[kept] = True
    rest = moved(motion, clouds[0][kept]) - clouds[1][kept]
    spread = rest.T @ rest / max(len(kept) - 2, 1)
    left = np.zeros((6, 6))
    for x, y, z in clouds[1][kept]:
        lever = np.array([[0.0, z, -y, 1.0, 0.0, 0.0], [-z, 0.0, x, 0.0, 1.0, 0.0], [y, -x, 0.0, 0.0, 0.0, 1.0]])
        left += lever.T @ np.linalg.solve(spread + 1e-12 * np.eye(3), lever)
    pixels = camera.project(moved(motion, clouds[0][kept])) - matches.pixels_b[kept]
    error = float(np.sqrt(np.nanmean((pixels / matches.sigma[kept, None]) ** 2)))
    return MotionEstimate(motion, np.asarray(np.linalg.inv(left + 1e-9 * np.eye(6)), np.float64), agree, error)
