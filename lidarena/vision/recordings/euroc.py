"""Sequences in the layout of the EuRoC data set (ASL): distorted cameras, rectified here."""

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import yaml
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import Image, Pair
from lidarena.vision.recordings.recording import StereoRecording, numbers_of

Floats = NDArray[np.float64]

_LATE = 0.02
"""Images of a pair, and a pose of the truth, are of the same time within this [s]."""


def is_euroc(folder: Path) -> bool:
    """Whether a folder, or its ``mav0``, has the layout."""
    return (folder / "mav0" / "cam0").is_dir() or (folder / "cam0" / "sensor.yaml").is_file()


def read_euroc(folder: Path) -> StereoRecording:
    """Open a sequence: ``cam0`` and ``cam1`` with ``sensor.yaml`` and ``data.csv``, and a ground truth if there is one.

    Raises:
        VisionError: Something is missing, torn, or does not fit together.
    """
    root = folder / "mav0" if (folder / "mav0").is_dir() else folder
    sensors = [_sensor_of(root / name / "sensor.yaml") for name in ("cam0", "cam1")]
    stamps, files = _pairs_of(root)
    camera, maps, turned = _rectified(*sensors)
    times = (stamps - stamps[0]) * 1e-9
    truth = _truth_of(root, stamps, sensors[0]["pose"], turned)

    def rectify(left: Image, right: Image) -> Pair:
        if left.shape != (sensors[0]["size"][1], sensors[0]["size"][0]):
            raise VisionError(
                f"images of {folder.name} have {left.shape[1]} x {left.shape[0]} pixels, the calibration is for "
                f"{sensors[0]['size'][0]} x {sensors[0]['size'][1]}"
            )
        left, right = (
            np.asarray(cv2.remap(one, *both, cv2.INTER_LINEAR), np.uint8)
            for one, both in zip((left, right), maps, strict=True)
        )
        return left, right

    return StereoRecording(folder.name, camera, tuple(files), times, truth, rectify)


def _sensor_of(path: Path) -> dict[str, Any]:
    """Intrinsics, distortion, size, and pose in the body."""
    try:
        told = yaml.safe_load(path.read_text(encoding="utf-8"))
        fu, fv, cu, cv = (float(one) for one in told["intrinsics"])
        width, height = (int(one) for one in told["resolution"])
        pose = np.array(told["T_BS"]["data"], np.float64).reshape(4, 4)
        distortion = np.array(told.get("distortion_coefficients", [0.0] * 4), np.float64)
    except (OSError, yaml.YAMLError, KeyError, TypeError, ValueError) as error:
        raise VisionError(f"{path} is no calibration of a camera: {error!r}") from None
    matrix = np.array([[fu, 0.0, cu], [0.0, fv, cv], [0.0, 0.0, 1.0]])
    return {"matrix": matrix, "distortion": distortion, "size": (width, height), "pose": pose}


def _pairs_of(root: Path) -> tuple[Floats, list[tuple[Path, Path]]]:
    """Times [ns] and files of the images that both cameras took."""
    listed = []
    for name in ("cam0", "cam1"):
        folder = root / name / "data"
        found = {int(path.stem): path for path in folder.glob("*.png") if path.stem.isdigit()}
        if not found:
            raise VisionError(f"there is no image in {folder} whose name is its time in nanoseconds")
        listed.append(found)
    both = sorted(listed[0].keys() & listed[1].keys())
    if len(both) < 2:
        raise VisionError(f"cam0 and cam1 of {root} have {len(both)} times in common; 2 at least are needed")
    return np.array(both, np.float64), [(listed[0][stamp], listed[1][stamp]) for stamp in both]


def _rectified(left: dict[str, Any], right: dict[str, Any]) -> tuple[StereoCamera, list[tuple[Any, Any]], Floats]:
    """The rectified camera, both maps of pixels, and how the left camera was turned for it (3, 3)."""
    if left["size"] != right["size"]:
        raise VisionError(f"cam0 is of {left['size']} pixels, cam1 of {right['size']}")
    between = np.linalg.inv(right["pose"]) @ left["pose"]
    turns_l, turns_r, project, to_right, *_ = cv2.stereoRectify(
        left["matrix"], left["distortion"], right["matrix"], right["distortion"], left["size"], between[:3, :3].copy(),
        between[:3, 3:].copy(), flags=cv2.CALIB_ZERO_DISPARITY, alpha=0,
    )  # fmt: skip
    baseline = -to_right[0, 3] / to_right[0, 0]
    if not baseline > 0.0:
        raise VisionError("cam1 is not to the right of cam0")
    width, height = left["size"]
    camera = StereoCamera(
        float(project[0, 0]), float(project[0, 2]), float(project[1, 2]), float(baseline), width, height
    )
    maps = [
        cv2.initUndistortRectifyMap(one["matrix"], one["distortion"], turn, matrix, one["size"], cv2.CV_32FC1)
        for one, turn, matrix in ((left, turns_l, project), (right, turns_r, to_right))
    ]
    return camera, maps, np.asarray(turns_l, np.float64)


def _truth_of(root: Path, stamps: Floats, mounted: Floats, turned: Floats) -> Floats | None:
    """Poses (N, 4, 4) of the rectified left camera; None unless they are known of all images."""
    path = root / "state_groundtruth_estimate0" / "data.csv"
    if not path.is_file():
        return None
    rows = numbers_of(path)
    if rows.shape[1] < 8:
        raise VisionError(f"{path} has {rows.shape[1]} columns; time, position and quaternion are needed")
    nearest = np.abs(rows[None, :, 0] - stamps[:, None]).argmin(axis=1)
    if (np.abs(rows[nearest, 0] - stamps) > _LATE * 1e9).any():
        return None
    lens = np.eye(4)
    lens[:3, :3] = turned.T
    return np.stack([_body_pose(row) @ mounted @ lens for row in rows[nearest]])


def _body_pose(row: Floats) -> Floats:
    """The pose of a row: time, x, y, z, qw, qx, qy, qz."""
    w, x, y, z = row[4:8] / np.linalg.norm(row[4:8])
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = row[1:4]
    return pose
