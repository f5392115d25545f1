"""A recorded stereo sequence: its camera, its pairs of images, and where they were taken if that is known."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import FeatureOptions, Image, Pair, detect

Floats = NDArray[np.float64]

IMAGES = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".pgm", ".tif", ".tiff")
_SWAPPED = 4.0
"""Left and right are swapped if the other way round so many times the features fit."""


@dataclass(frozen=True)
class StereoRecording:
    """A sequence of pairs.

    Attributes:
        name: Of its folder.
        camera: Of the images as ``pair`` gives them.
        files: Left and right image of each pair.
        times: (N,) [s].
        truth: (N, 4, 4) left camera to world; None if it is not known.
        rectify: Makes a left and a right image as read into rectified ones; None where they are.
    """

    name: str
    camera: StereoCamera
    files: tuple[tuple[Path, Path], ...]
    times: Floats
    truth: Floats | None = None
    rectify: Callable[[Image, Image], Pair] | None = None

    def pair(self, number: int) -> Pair:
        """Read a pair.

        Raises:
            VisionError: A file is missing or torn, or does not fit the calibration.
        """
        left, right = (read_grey(path) for path in self.files[number])
        if left.shape != right.shape:
            self.camera.check_pair(left, right, f"frame {number}")
        if self.rectify is not None:
            left, right = self.rectify(left, right)
        self.camera.check_pair(left, right, f"frame {number} of {self.name}")
        return left, right

    def check_sides(self, pair: Pair) -> None:
        """Refuse a sequence whose left and right images are swapped.

        Raises:
            VisionError: The other way round far more features of a pair are in front of the camera.
        """
        options = FeatureOptions(kind="orb", count=600, nearest=0.2, farthest=1e3)
        given, swapped = (len(detect(one, self.camera, options).pixels) for one in (pair, pair[::-1]))
        if swapped > max(_SWAPPED * given, 20):
            raise VisionError(
                f"left and right images of {self.name} are swapped: {given} features fit as they are, {swapped} the "
                "other way round"
            )


def read_grey(path: Path) -> Image:
    """Read an image as grey values of 8 bits.

    Raises:
        VisionError: It is missing or torn.
    """
    if not path.is_file():
        raise VisionError(f"image {path} is missing")
    try:
        image = cv2.imdecode(np.fromfile(path, np.uint8), cv2.IMREAD_GRAYSCALE)
    except cv2.error:
        image = None
    if image is None:
        raise VisionError(f"image {path} is torn or of a format that is not known")
    return np.asarray(image, np.uint8)


def images_in(folder: Path) -> list[Path]:
    """Image files of a folder by name.

    Raises:
        VisionError: There is no such folder, or no image in it.
    """
    if not folder.is_dir():
        raise VisionError(f"there is no folder {folder} of images")
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() in IMAGES)
    if not found:
        raise VisionError(f"there is no image in {folder}")
    return found


def numbers_of(path: Path, columns: int | None = None) -> Floats:
    """Rows of numbers of a text file, those behind a name with a colon included.

    Raises:
        VisionError: It is missing or torn, or has rows of another length.
    """
    rows = []
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise VisionError(f"{path} cannot be read: {error}") from None
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].rpartition(":")[2].replace(",", " ").split()
        if not words:
            continue
        try:
            rows.append([float(word) for word in words])
        except ValueError:
            raise VisionError(f"line {number} of {path} is no row of numbers: {line[:60]!r}") from None
        wanted = len(rows[0]) if columns is None else columns
        if len(rows[-1]) != wanted or not np.isfinite(rows[-1]).all():
            raise VisionError(f"line {number} of {path} has {len(rows[-1])} numbers; {wanted} finite ones are needed")
    return np.array(rows, np.float64).reshape(len(rows), -1 if rows else columns or 0)
