"""Trajectories: the corrected poses of some moments spread over all readings of a log; TUM's and KITTI's files."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.base.files import write_text
from lidarena.slam.planar import between, compose, wrapped

_METRES_PER_RADIAN = 0.3
"""How much driving a turn counts for when drift is spread over both [m/rad]."""


@dataclass(frozen=True)
class Trajectory:
    """Where a robot was.

    Attributes:
        times: (R,) ascending; clocks of real logs repeat themselves [s].
        poses: (R, 3) x, y [m], theta [rad].
    """

    times: NDArray[np.float64]
    poses: NDArray[np.float64]


def spread_correction(
    odometry: NDArray[np.float64], readings: NDArray[np.int64], corrected: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Poses (R, 3) of all readings from the corrected poses of some.

    Between two corrected poses the odometry's shape is kept, and what it misses of the second one is spread over the
    way; before the first and after the last one the odometry is followed.

    Args:
        odometry: (R, 3).
        readings: (K,) which readings are corrected, ascending, at least one.
        corrected: (K, 3) their poses.
    """
    steps = between(odometry[:-1], odometry[1:])
    effort = np.hypot(steps[:, 0], steps[:, 1]) + _METRES_PER_RADIAN * np.abs(steps[:, 2]) + 1e-9
    way = np.concatenate([[0.0], np.cumsum(effort)])
    every = np.arange(len(odometry))
    at = np.clip(np.searchsorted(readings, every, side="right") - 1, 0, len(readings) - 1)
    after = np.minimum(at + 1, len(readings) - 1)
    a, b = readings[at], readings[after]
    onwards = compose(corrected[at], between(odometry[a], odometry))
    backwards = compose(corrected[after], between(odometry[b], odometry))
    share = np.clip((way - way[a]) / np.where(b > a, way[b] - way[a], 1.0), 0.0, 1.0) * (b > a)
    gap = backwards - onwards
    gap[:, 2] = wrapped(gap[:, 2])
    poses: NDArray[np.float64] = onwards + share[:, None] * gap
    poses[:, 2] = wrapped(poses[:, 2])
    return poses


def interpolated(
    times: NDArray[np.float64], poses: NDArray[np.float64], at: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Poses (n, 3) at the times ``at`` (n,) between those at ``times`` (m,) ascending; angles on the circle.

    Before the first and after the last one it stands still.
    """
    headings = np.unwrap(poses[:, 2])
    x, y, theta = (np.interp(at, times, values) for values in (poses[:, 0], poses[:, 1], headings))
    return np.stack([x, y, wrapped(theta)], axis=1)


def in_order(times: NDArray[np.float64], poses: NDArray[np.float64]) -> Trajectory:
    """Sort by time; poses with one time stamp stay in the order in which they were driven."""
    order = np.argsort(times, kind="stable")
    return Trajectory(times[order], poses[order])


def save_tum(path: str | Path, trajectory: Trajectory) -> Path:
    """Write ``time x y z qx qy qz qw`` lines, the format of the TUM RGB-D benchmark (read by evo, for one)."""
    lines = ["# time x y z qx qy qz qw"]
    for time, (x, y, theta) in zip(trajectory.times, trajectory.poses, strict=True):
        qz, qw = math.sin(theta / 2.0), math.cos(theta / 2.0)
        lines.append(f"{time:.6f} {x:.6f} {y:.6f} 0 0 0 {qz:.9f} {qw:.9f}")
    return write_text(path, "\n".join(lines) + "\n")


def save_kitti(path: str | Path, trajectory: Trajectory) -> Path:
    """Write the upper three rows of each pose's matrix, twelve numbers a line, the format of the KITTI benchmark.

    Its frame is x ahead, y to the left, z up, not a camera's; it knows no time stamps.
    """
    lines = []
    for x, y, theta in trajectory.poses:
        cos, sin = math.cos(theta), math.sin(theta)
        lines.append(f"{cos:.9f} {-sin:.9f} 0 {x:.6f} {sin:.9f} {cos:.9f} 0 {y:.6f} 0 0 1 0")
    return write_text(path, "\n".join(lines) + "\n")


def load_tum(path: str | Path) -> Trajectory:
    """Read what `save_tum` writes."""
    table = np.loadtxt(path, ndmin=2)
    return Trajectory(
        table[:, 0], np.column_stack([table[:, 1:3], wrapped(2.0 * np.arctan2(table[:, 6], table[:, 7]))])
    )
