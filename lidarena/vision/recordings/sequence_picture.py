"""The picture of a sequence's odometry: the way from above, and how the error grows."""

from typing import TYPE_CHECKING

import numpy as np

from lidarena.vision.recordings.recording import StereoRecording
from lidarena.vision.recordings.sequence_odometry import SequenceResult
from lidarena.vision.recordings.trajectory_errors import TrajectoryErrors, path_lengths
from lidarena.vision.rigid_motion import inverse

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TRUE, _FOUND = "#0072B2", "#D55E00"


def draw_sequence(recording: StereoRecording, result: SequenceResult, errors: TrajectoryErrors | None) -> "Figure":
    """Draw the estimated way, beside the true one where it is known."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.6), layout="constrained")
    way, side = figure.subplots(1, 2)
    poses, truth = result.poses, recording.truth
    if truth is not None:
        poses = truth[0] @ inverse(result.poses[0]) @ result.poses
        spread = np.ptp(truth[:, :3, 3], axis=0)
    else:
        spread = np.ptp(poses[:, :3, 3], axis=0)
    across, up = sorted(np.argsort(spread)[-2:].tolist())  # the plane in which the camera moves
    if truth is not None:
        way.plot(truth[:, across, 3], truth[:, up, 3], color=_TRUE, label="truth")
    way.plot(poses[:, across, 3], poses[:, up, 3], "--", color=_FOUND, label="odometry")
    lost = [number for number in result.dropped if number < len(poses)]
    if lost:
        way.plot(poses[lost, across, 3], poses[lost, up, 3], "x", color="black", label="dropped frame")
    way.set(xlabel=f"{'xyz'[across]} (m)", ylabel=f"{'xyz'[up]} (m)", title=recording.name)
    way.set_aspect("equal", adjustable="datalim")
    way.legend()
    if truth is None or errors is None:
        side.plot(result.tracked, color=_FOUND)
        side.set(xlabel="frame", ylabel="corners that agree on the motion", title="tracked corners")
    else:
        off = np.linalg.norm(poses[:, :3, 3] - truth[:, :3, 3], axis=1)
        side.plot(path_lengths(truth), off, color=_FOUND)
        title = f"relative error {100 * errors.translation:.2f}% of the path, ATE {errors.ate:.2f} m"
        side.set(xlabel="path (m)", ylabel="error (m)", title=title)
    return figure
