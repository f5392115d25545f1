"""A short flight over the seabed, written as recorded sequences."""

from pathlib import Path

import cv2
import numpy as np

from lidarena.vision.recordings.trajectory_files import kitti_text
from tests.vision.scenes import CAMERA, pair_at, pose_at

PLACES = tuple(8.0 + 0.15 * number for number in range(5))
TRUTH = np.stack([pose_at(x) for x in PLACES])
KITTI = Path(__file__).parents[4] / "shared" / "data" / "stereo" / "kitti_seq1"


def projections() -> str:
    f, u, v, b = CAMERA.focal, CAMERA.center_x, CAMERA.center_y, CAMERA.baseline
    rows = [[f, 0, u, shift, 0, f, v, 0, 0, 0, 1, 0] for shift in (0.0, -f * b)]
    return "".join(" ".join(map(repr, map(float, row))) + "\n" for row in rows)


def write_kitti(folder: Path, names: tuple[str, str] = ("image_l", "image_r"), truth: bool = True) -> Path:
    for side, name in enumerate(names):
        (folder / name).mkdir(parents=True)
        for number, x in enumerate(PLACES):
            cv2.imwrite(str(folder / name / f"{number:06d}.png"), pair_at(x)[side])
    (folder / "calib.txt").write_text(projections())
    if truth:
        (folder / "poses.txt").write_text(kitti_text(TRUTH))
    return folder


def write_euroc(folder: Path) -> Path:
    """The same flight with a body frame that is not the camera's, and stamps in nanoseconds."""
    mounted = pose_at(1.0)
    for side, name in enumerate(("cam0", "cam1")):
        data = folder / "mav0" / name / "data"
        data.mkdir(parents=True)
        for number, x in enumerate(PLACES):
            cv2.imwrite(str(data / f"{1_000_000_000 + number * 50_000_000}.png"), pair_at(x)[side])
        offset = np.eye(4)
        offset[0, 3] = side * CAMERA.baseline
        numbers = ", ".join(map(repr, (mounted @ offset).ravel().tolist()))
        (folder / "mav0" / name / "sensor.yaml").write_text(
            f"resolution: [{CAMERA.width}, {CAMERA.height}]\n"
            f"intrinsics: [{CAMERA.focal}, {CAMERA.focal}, {CAMERA.center_x}, {CAMERA.center_y}]\n"
            f"distortion_coefficients: [0.0, 0.0, 0.0, 0.0]\nT_BS:\n  rows: 4\n  cols: 4\n  data: [{numbers}]\n"
        )
    from scipy.spatial.transform import Rotation

    rows = ["#timestamp, x, y, z, qw, qx, qy, qz"]
    for number, pose in enumerate(TRUTH):
        body = pose @ np.linalg.inv(mounted)
        x, y, z, w = Rotation.from_matrix(body[:3, :3]).as_quat()
        told = [1_000_000_000 + number * 50_000_000, *body[:3, 3], w, x, y, z]
        rows.append(",".join(str(one) for one in told))
    truth = folder / "mav0" / "state_groundtruth_estimate0"
    truth.mkdir()
    (truth / "data.csv").write_text("\n".join(rows) + "\n")
    return folder
