"""Features that both images of a pair show: where they are, and what they look like."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.keyword_checks import check_choice, check_range
from lidarena.vision.camera import StereoCamera

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]
Pair = tuple[Image, Image]
Region = tuple[int, int, int, int]
"""x_min, y_min, x_max, y_max of a part of an image, the ends not included [pixels]."""

KINDS = ("sift", "orb", "tracks")
_WINDOW = 21
"""Side of the squares that Lucas-Kanade compares [pixels]."""
_SHRINK = 4
"""By which images are reduced before disparities are guessed."""
_SURROUNDINGS, _CONTRAST, _LEAST_VARIANCE = 101, 40.0, 4.0
"""Brightness is made even over squares of this side [pixels]: to this deviation, if it has so much variance at all."""


@dataclass(frozen=True)
class FeatureOptions:
    """How features are found and matched.

    Attributes:
        kind: ``"sift"``, ``"orb"`` (refined by Lucas-Kanade, since its places are whole pixels), or ``"tracks"``:
            corners that Lucas-Kanade follows.
        count: At most so many an image.
        ratio: The nearest descriptor must be nearer than this share of the second nearest (Lowe).
        row_error: Rows by which the two images of a feature may differ [pixels].
        nearest: Least depth [m].
        farthest: Greatest depth [m].

    Raises:
        ConfigError: A value out of range.
    """

    kind: str = "sift"
    count: int = 400
    ratio: float = 0.85
    row_error: float = 1.5
    nearest: float = 0.3
    farthest: float = 60.0

    def __post_init__(self) -> None:
        check_choice("kind", self.kind, KINDS)
        check_range("count", self.count, 8, 20000, whole=True)
        check_range("ratio", self.ratio, 0.1, 1.0)
        check_range("row_error", self.row_error, 0.1, 20.0)
        check_range("nearest", self.nearest, 0.01, 1e3)
        check_range("farthest", self.farthest, self.nearest, 1e5)


class Features(NamedTuple):
    """Features of a pair.

    Attributes:
        pixels: (N, 4) u, v of the left and u, v of the right image [pixels].
        descriptors: (N, D) what they look like: float32 of length 1, or bits in uint8; (N, 0) for corners.
        sigma: (N,) standard deviation of a coordinate, relative to each other [pixels].
        images: The pair, for Lucas-Kanade; None where it is not needed.
        found: (2,) keypoints in the left and the right image, matched or not.
    """

    pixels: Floats
    descriptors: NDArray[Any]
    sigma: Floats
    images: Pair | None
    found: tuple[int, int]

    def within(self, region: Region) -> NDArray[np.int64]:
        """Numbers of the features whose left pixel lies in a part of the image."""
        u, v = self.pixels[:, 0], self.pixels[:, 1]
        return np.flatnonzero((u >= region[0]) & (u < region[2]) & (v >= region[1]) & (v < region[3]))

    def taken(self, numbers: NDArray[np.int64] | NDArray[np.bool_]) -> "Features":
        """Only some of the features."""
        return self._replace(
            pixels=self.pixels[numbers], descriptors=self.descriptors[numbers], sigma=self.sigma[numbers]
        )


def detect(images: Pair, camera: StereoCamera, options: FeatureOptions, region: Region | None = None) -> Features:
    """Find the features that both images of a pair show.

    Args:
        images: The pair.
        camera: That took it.
        options: How.
        region: Part of the left image that is looked at, and of the right one what may show the same; None: all.

    Raises:
        VisionError: The images do not fit the camera.
    """
    camera.check_pair(*images)
    if options.kind == "tracks":
        return _corners((even(images[0]), even(images[1])), camera, options, region)
    left, right = (_keypoints(image, options, part) for image, part in zip(images, _parts(camera, region), strict=True))
    likely = _on_one_row(left, right, camera, options)
    chosen, other = match_descriptors(left[1], right[1], options.ratio, likely)
    pixels = np.hstack([left[0][chosen], right[0][other]])
    sigma = 0.5 * (left[2][chosen] + right[2][other])
    found = len(left[0]), len(right[0])
    made = Features(pixels, left[1][chosen], sigma, images if options.kind == "orb" else None, found)
    return refine_stereo(made, camera, options) if options.kind == "orb" else made


def _parts(camera: StereoCamera, region: Region | None) -> tuple[Region, Region]:
    """What of the left and of the right image is looked at: what is nearby is farther left in the right one."""
    if region is None:
        whole = (0, 0, camera.width, camera.height)
        return whole, whole
    return region, (0, region[1], region[2], region[3])


_Keypoints = tuple[Floats, NDArray[Any], Floats]


def _keypoints(image: Image, options: FeatureOptions, part: Region) -> _Keypoints:
    """Pixels (N, 2), descriptors (N, D) and sigma (N,) of the keypoints in a part of an image."""
    x, y = part[0], part[1]
    cropped = np.ascontiguousarray(image[y : part[3], x : part[2]])
    made = cv2.SIFT.create(options.count) if options.kind == "sift" else cv2.ORB.create(options.count, fastThreshold=8)
    points, descriptors = made.detectAndCompute(cropped, None)
    if descriptors is None or not len(points):
        return np.empty((0, 2)), np.empty((0, 128), np.float32), np.empty(0)
    pixels = np.array([point.pt for point in points], np.float64) + np.array([x, y], np.float64)
    if options.kind == "orb":
        return pixels, descriptors, np.ones(len(points))
    descriptors = np.sqrt(descriptors / np.maximum(descriptors.sum(axis=1, keepdims=True), 1e-6))  # RootSIFT
    sigma = 0.15 * np.array([point.size for point in points], np.float64)
    return pixels, descriptors.astype(np.float32), sigma


def _on_one_row(
    left: _Keypoints, right: _Keypoints, camera: StereoCamera, options: FeatureOptions
) -> NDArray[np.bool_]:
    """Which keypoints of two images can be one point (N, M): the epipolar constraint, and a depth within the range."""
    disparity = left[0][:, None, 0] - right[0][None, :, 0]
    rows = np.abs(left[0][:, None, 1] - right[0][None, :, 1])
    reach = camera.focal * camera.baseline
    near = (disparity >= reach / options.farthest) & (disparity <= reach / options.nearest)
    return np.asarray(near & (rows <= options.row_error))


def match_descriptors(
    one: NDArray[Any], two: NDArray[Any], ratio: float, likely: NDArray[np.bool_] | None = None
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Match descriptors that are each other's nearest, and clearly nearer than the second nearest.

    Args:
        one: (N, D).
        two: (M, D) of the same kind.
        ratio: Of the nearest distance to the second nearest, at most.
        likely: (N, M) which may be matched; None: all.

    Returns:
        Which of ``one``, and which of ``two``, (K,) each.
    """
    if not len(one) or not len(two):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    distance = _distances(one, two)
    if likely is not None:
        distance = np.where(likely, distance, np.float32(np.inf))
    rows = np.arange(len(one))
    best = distance.argmin(axis=1)
    least = distance[rows, best].copy()
    mutual = (distance.argmin(axis=0)[best] == rows) & np.isfinite(least)
    distance[rows, best] = np.inf
    clear = least < ratio * np.minimum(distance.min(axis=1), _NOTHING_NEAR[one.dtype == np.uint8])
    chosen = np.flatnonzero(mutual & clear)
    return chosen, best[chosen]


_NOTHING_NEAR = {False: 0.9, True: 80.0}
"""Where there is no second: the distance at which two descriptors, real (False) or of bits, have nothing in common."""


def _distances(one: NDArray[Any], two: NDArray[Any]) -> NDArray[np.float32]:
    """Distances (N, M) of unit vectors, or numbers of differing bits."""
    if one.dtype == np.uint8:
        a, b = np.unpackbits(one, axis=1).astype(np.float32), np.unpackbits(two, axis=1).astype(np.float32)
        return np.asarray(a.sum(1)[:, None] + b.sum(1)[None, :] - 2.0 * (a @ b.T))
    return np.asarray(np.sqrt(np.maximum(2.0 - 2.0 * (one @ two.T), 0.0)), np.float32)


def _corners(images: Pair, camera: StereoCamera, options: FeatureOptions, region: Region | None) -> Features:
    """Corners of the left image, and where Lucas-Kanade finds them in the right one."""
    part = region or (0, 0, camera.width, camera.height)
    mask = np.zeros(images[0].shape, np.uint8)
    mask[part[1] : part[3], part[0] : part[2]] = 255
    spacing = max(5.0, 0.6 * np.sqrt((part[2] - part[0]) * (part[3] - part[1]) / options.count))
    corners: Any = cv2.goodFeaturesToTrack(images[0], options.count, 0.005, spacing, mask=mask)
    if corners is None:
        return Features(np.empty((0, 4)), np.empty((0, 0), np.float32), np.empty(0), images, (0, 0))
    left = np.asarray(corners, np.float32).reshape(-1, 2)
    right, fits = track(images[0], images[1], left, guessed_right(images, left), levels=2)
    pixels = np.hstack([left, right]).astype(np.float64)
    reach = camera.focal * camera.baseline
    disparity = pixels[:, 0] - pixels[:, 2]
    fits &= (disparity >= reach / options.farthest) & (disparity <= reach / options.nearest)
    fits &= np.abs(pixels[:, 1] - pixels[:, 3]) <= options.row_error
    found = Features(pixels, np.empty((len(pixels), 0), np.float32), np.ones(len(pixels)), images, (len(left),) * 2)
    return found.taken(fits)


def guessed_right(images: Pair, left: NDArray[np.float32]) -> NDArray[np.float32]:
    """About where the right image shows what is at places (N, 2) of the left one.

    Lucas-Kanade finds only what is near to its guess; on ground close by, disparities are a third of the image. They
    are looked for at a quarter of the resolution, by semi-global matching.
    """
    small = [
        cv2.resize(image, None, fx=1.0 / _SHRINK, fy=1.0 / _SHRINK, interpolation=cv2.INTER_AREA) for image in images
    ]
    most = 16 * max(1, round(0.5 * small[0].shape[1] / 16))
    padded = [cv2.copyMakeBorder(image, 0, 0, most, 0, cv2.BORDER_REPLICATE) for image in small]
    matcher = cv2.StereoSGBM.create(0, most, 5, 200, 800, uniquenessRatio=5, speckleWindowSize=40, speckleRange=2)
    disparity = np.asarray(matcher.compute(padded[0], padded[1]), np.float32)[:, most:] / 16.0
    known = disparity > 0.0
    disparity[~known] = np.median(disparity[known]) if known.any() else 0.0
    column, row = (np.clip((left[:, k] / _SHRINK).astype(int), 0, disparity.shape[1 - k] - 1) for k in (0, 1))
    guess = left.copy()
    guess[:, 0] -= _SHRINK * disparity[row, column]
    return guess


def even(image: Image) -> Image:
    """An image whose brightness and contrast are the same everywhere.

    Vignetting and the veil of the water move with the camera, and Lucas-Kanade would follow them a little.
    """
    grey = image.astype(np.float32)
    side = (_SURROUNDINGS, _SURROUNDINGS)
    mean = cv2.blur(grey, side)
    variance = np.maximum(cv2.blur(grey * grey, side) - mean * mean, _LEAST_VARIANCE)
    made: Image = np.clip(128.0 + _CONTRAST * (grey - mean) / np.sqrt(variance), 0, 255).astype(np.uint8)
    return made


def refine_stereo(features: Features, camera: StereoCamera, options: FeatureOptions) -> Features:
    """Move the right pixels to where Lucas-Kanade sees the left ones' surroundings."""
    if not len(features.pixels) or features.images is None:
        return features
    left, right = features.pixels[:, :2].astype(np.float32), features.pixels[:, 2:].astype(np.float32)
    refined, fits = track(*features.images, left, right, levels=0)
    fits &= (np.abs(refined - right).max(axis=1) < 3.0) & (np.abs(refined[:, 1] - left[:, 1]) <= options.row_error)
    pixels = np.hstack([left, refined]).astype(np.float64)[fits]
    return features.taken(fits)._replace(pixels=pixels)


def track(
    before: Image, after: Image, places: NDArray[np.float32], guess: NDArray[np.float32], levels: int = 3
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Follow points from one image to another with pyramidal Lucas-Kanade.

    Args:
        before: The one.
        after: The other.
        places: (N, 2) in the one [pixels].
        guess: (N, 2) about where in the other.
        levels: Of the pyramid above the image itself; each doubles how far the guess may be off.

    Returns:
        Places (N, 2) in the other, and which were found there (N,).
    """
    if not len(places):
        return np.empty((0, 2), np.float32), np.empty(0, np.bool_)
    stop = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 20, 0.01)
    moved, status, _ = cv2.calcOpticalFlowPyrLK(
        before, after, np.ascontiguousarray(places), np.array(guess, np.float32, order="C"), winSize=(_WINDOW, _WINDOW),
        maxLevel=levels, criteria=stop, flags=cv2.OPTFLOW_USE_INITIAL_FLOW, minEigThreshold=1e-4,
    )  # fmt: skip
    found = np.asarray(moved, np.float32)
    fits = status.ravel().astype(np.bool_)
    height, width = after.shape
    fits &= (found[:, 0] >= 0) & (found[:, 0] < width) & (found[:, 1] >= 0) & (found[:, 1] < height)
    return found, fits
