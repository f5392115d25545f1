"""A calibrated, rectified stereo camera: projection, triangulation and the epipolar constraint."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.base.keyword_checks import check_range

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class StereoCamera:
    """Two equal cameras side by side whose rows are the same: the left one is where the pose is.

    Attributes:
        focal: Focal length [pixels].
        center_x: Column of the principal point, the first pixel's centre being 0 [pixels].
        center_y: Row of the principal point [pixels].
        baseline: From the left camera to the right one, along x [m].
        width: Of the images [pixels].
        height: Of the images [pixels].

    Raises:
        ConfigError: A number out of range.
    """

    focal: float
    center_x: float
    center_y: float
    baseline: float
    width: int
    height: int

    def __post_init__(self) -> None:
        check_range("focal", self.focal, 1.0, 1e5)
        check_range("baseline", self.baseline, 1e-4, 100.0)
        for name in ("width", "height"):
            check_range(name, getattr(self, name), 16, 16384, whole=True)
        check_range("center_x", self.center_x, 0.0, self.width)
        check_range("center_y", self.center_y, 0.0, self.height)

    @classmethod
    def with_view(cls, width: int, height: int, view: float, baseline: float) -> "StereoCamera":
        """A camera whose principal point is in the middle.

        Args:
            width: Of the images [pixels].
            height: Of the images [pixels].
            view: Angle from the left border to the right one [rad].
            baseline: Between the cameras [m].
        """
        check_range("view", view, 0.1, 2.8)
        focal = 0.5 * width / float(np.tan(0.5 * view))
        return cls(focal, 0.5 * (width - 1), 0.5 * (height - 1), baseline, width, height)

    def project(self, points: Floats) -> Floats:
        """Pixels (N, 4) u, v of the left and u, v of the right image of points (N, 3) in the left camera's frame [m].

        Points that are not in front of the camera give NaN.
        """
        ahead = np.where(points[:, 2] > 0.0, points[:, 2], np.nan)
        across, down = self.focal * points[:, 0] / ahead, self.focal * points[:, 1] / ahead
        left, row = self.center_x + across, self.center_y + down
        return np.stack([left, row, left - self.focal * self.baseline / ahead, row], axis=1)

    def triangulate(self, pixels: Floats) -> Floats:
        """Points (N, 3) in the left camera's frame [m] of pixels (N, 4) u, v left and u, v right.

        The row is the mean of both; pixels without a positive disparity give NaN.
        """
        disparity = pixels[:, 0] - pixels[:, 2]
        ahead = self.focal * self.baseline / np.where(disparity > 1e-6, disparity, np.nan)
        row = 0.5 * (pixels[:, 1] + pixels[:, 3])
        across = (pixels[:, 0] - self.center_x) * ahead / self.focal
        return np.stack([across, (row - self.center_y) * ahead / self.focal, ahead], axis=1)

    def epipolar_errors(self, pixels: Floats) -> Floats:
        """Rows by which pixels (N, 4) of the two images are apart, (N,): 0 where the pair is calibrated [pixels]."""
        return np.asarray(np.abs(pixels[:, 1] - pixels[:, 3]))

    def check_pair(self, left: NDArray[np.uint8], right: NDArray[np.uint8], name: str = "the pair") -> None:
        """Refuse images that this camera cannot have taken.

        Raises:
            VisionError: They are no grey images of its size.
        """
        for side, image in (("left", left), ("right", right)):
            if image.ndim != 2 or image.dtype != np.uint8:
                kind = f"{image.dtype} {image.shape}"
                raise VisionError(f"{side} image of {name} is {kind}; grey images of 8 bits are allowed")
        if left.shape != right.shape:
            sizes = f"{left.shape[1]} x {left.shape[0]} and {right.shape[1]} x {right.shape[0]}"
            raise VisionError(f"the images of {name} are of two sizes, {sizes} pixels")
        if left.shape != (self.height, self.width):
            raise VisionError(
                f"images of {name} have {left.shape[1]} x {left.shape[0]} pixels, the calibration is for "
                f"{self.width} x {self.height}"
            )
