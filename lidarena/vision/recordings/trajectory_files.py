"""Trajectories as KITTI's and TUM's programs read them, and everything that an odometry of a sequence writes."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.files import replace_folder, write_text
from lidarena.vision.recordings.recording import StereoRecording
from lidarena.vision.recordings.sequence_odometry import SequenceResult
from lidarena.vision.recordings.sequence_picture import draw_sequence
from lidarena.vision.recordings.trajectory_errors import TrajectoryErrors
from lidarena.vision.rigid_motion import vector_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

FILES = ("picture.png", "trajectory_kitti.txt", "trajectory_tum.txt", "errors.json")


def kitti_text(poses: Floats) -> str:
    """Poses (N, 4, 4) as KITTI has them: 12 numbers a row."""
    return "".join(" ".join(f"{number:.9g}" for number in pose[:3].ravel()) + "\n" for pose in poses)


def tum_text(times: Floats, poses: Floats) -> str:
    """Poses (N, 4, 4) as TUM has them: time [s], x, y, z, qx, qy, qz, qw."""
    rows = []
    for time, pose in zip(times, poses, strict=True):
        vector = vector_of(pose[:3, :3])
        angle = float(np.linalg.norm(vector))
        axis = vector / angle if angle > 0.0 else np.zeros(3)
        quaternion = [*(np.sin(0.5 * angle) * axis), np.cos(0.5 * angle)]
        rows.append(f"{time:.6f} " + " ".join(f"{number:.9g}" for number in [*pose[:3, 3], *quaternion]) + "\n")
    return "".join(rows)


def save_sequence(
    folder: str | Path, recording: StereoRecording, result: SequenceResult, errors: TrajectoryErrors | None
) -> Path | None:
    """Write the trajectory, its picture and its errors; returns where an earlier folder was moved to, if there was one.

    Raises:
        WriteError: The folder cannot be written.
    """

    def fill(place: Path) -> None:
        write_text(place / FILES[1], kitti_text(result.poses))
        write_text(place / FILES[2], tum_text(recording.times, result.poses))
        write_text(place / FILES[3], json.dumps(_told(result, errors), indent=1) + "\n")
        figure: Figure = draw_sequence(recording, result, errors)
        figure.savefig(place / FILES[0], dpi=110)

    return replace_folder(folder, fill)


def _told(result: SequenceResult, errors: TrajectoryErrors | None) -> dict[str, Any]:
    told: dict[str, Any] = {
        "frames": len(result.poses),
        "dropped": result.dropped,
        "unread": {str(number): why for number, why in result.unread.items()},
        "frames_per_second": len(result.poses) / max(result.seconds, 1e-9),
    }
    if errors is not None:
        told |= {
            "relative_translation_percent": 100.0 * errors.translation,
            "relative_rotation_degrees_per_metre": float(np.degrees(errors.rotation)),
            "over_lengths": list(errors.lengths),
            "ate": errors.ate,
            "final_error": errors.final,
            "path_length": errors.path,
        }
    return told
