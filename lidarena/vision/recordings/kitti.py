"""Sequences in the layout of KITTI's odometry benchmark."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.vision.camera import StereoCamera
from lidarena.vision.recordings.recording import StereoRecording, images_in, numbers_of, read_grey

Floats = NDArray[np.float64]

FOLDERS = (("image_0", "image_1", 0), ("image_l", "image_r", 0), ("left", "right", 0), ("image_2", "image_3", 2))
"""Names of the left and the right folder, and which projection matrices are theirs where there are four."""
_RATE = 10.0
"""KITTI's, where no times are told [1/s]."""


def is_kitti(folder: Path) -> bool:
    """Whether a folder has the layout."""
    return (folder / "calib.txt").is_file() or any((folder / left).is_dir() for left, _, _ in FOLDERS)


def read_kitti(folder: Path) -> StereoRecording:
    """Open a sequence: ``calib.txt`` (12 numbers a row), folders of images, ``times.txt`` and ``poses.txt`` if known.

    Raises:
        VisionError: Something is missing, torn, or does not fit together.
    """
    names = next((names for names in FOLDERS if (folder / names[0]).is_dir()), None)
    if names is None:
        raise VisionError(f"{folder} has no left images; allowed are folders {', '.join(one[0] for one in FOLDERS)}")
    left, right = images_in(folder / names[0]), images_in(folder / names[1])
    if [path.stem for path in left] != [path.stem for path in right]:
        odd = sorted({path.stem for path in left} ^ {path.stem for path in right})
        raise VisionError(f"frame {odd[0] if odd else left[0].stem} of {folder} has no image in one of both folders")
    camera = _camera_of(folder / "calib.txt", names[2], left[0])
    times = np.arange(len(left)) / _RATE
    if (folder / "times.txt").is_file():
        times = numbers_of(folder / "times.txt", 1)[:, 0]
        _check_count(folder / "times.txt", len(times), len(left))
        if (np.diff(times) <= 0.0).any():
            raise VisionError(f"times in {folder / 'times.txt'} must rise")
    truth = None
    if (folder / "poses.txt").is_file():
        truth = read_poses(folder / "poses.txt")
        _check_count(folder / "poses.txt", len(truth), len(left))
    return StereoRecording(folder.name, camera, tuple(zip(left, right, strict=True)), times, truth)


def _check_count(path: Path, found: int, wanted: int) -> None:
    if found != wanted:
        raise VisionError(f"{path} has {found} rows for {wanted} pairs of images")


def _camera_of(path: Path, first: int, image: Path) -> StereoCamera:
    """The camera of two projection matrices P."""
    rows = numbers_of(path, 12).reshape(-1, 12)
    chosen = rows[first : first + 2] if len(rows) >= 4 else rows[:2]
    if len(chosen) < 2:
        raise VisionError(
            f"{path} has {len(rows)} projection matrices; those of the left and the right camera are needed"
        )
    height, width = read_grey(image).shape
    left, right = chosen.reshape(2, 3, 4)
    focal = left[0, 0]
    offset = (left[0, 3] - right[0, 3]) / max(focal, 1e-9)
    if focal <= 0.0 or not np.allclose(left[:, :3], right[:, :3], rtol=1e-6) or offset <= 0.0:
        raise VisionError(
            f"{path} is no calibration of a rectified pair: the same focal length and principal point on both sides, "
            "and the right camera to the right of the left one, are needed"
        )
    if not (0 < left[0, 2] < width and 0 < left[1, 2] < height):
        raise VisionError(
            f"{path} has its principal point at {left[0, 2]:.0f}, {left[1, 2]:.0f}, outside of the images of "
            f"{width} x {height} pixels"
        )
    return StereoCamera(float(focal), float(left[0, 2]), float(left[1, 2]), float(offset), width, height)


def read_poses(path: Path) -> Floats:
    """Poses (N, 4, 4), camera to world, of a file with 12 numbers a row.

    Raises:
        VisionError: It is missing or torn, or a row is no pose.
    """
    rows = numbers_of(path, 12).reshape(-1, 12)
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3] = rows.reshape(-1, 3, 4)
    off = np.abs(poses[:, :3, :3] @ poses[:, :3, :3].transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2), initial=0.0)
    if (off > 1e-2).any():
        raise VisionError(
            f"row {int(np.argmax(off > 1e-2)) + 1} of {path} is no pose: its first 3 columns are no rotation"
        )
    return poses
