"""Wheel odometry: what the wheels report of a motion, with gmapping's noise model."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.base.random_streams import normal


class OdometryNoise(NamedTuple):
    """gmapping's motion model (openslam_gmapping, ``drawFromMotion``), per reading.

    σ_x = srr |dx| + str |dθ| + 0.3 srr |dy|, σ_y = srr |dy| + str |dθ| + 0.3 srr |dx|,
    σ_θ = stt |dθ| + srt hypot(dx, dy), in the frame of the robot before the motion. The defaults are turtlebot3_slam's.

    Attributes:
        srr: Translation as a function of translation [m/m].
        srt: Rotation as a function of translation [rad/m].
        str_: Translation as a function of rotation [m/rad].
        stt: Rotation as a function of rotation [rad/rad].
    """

    srr: float = 0.1
    srt: float = 0.2
    str_: float = 0.1
    stt: float = 0.2

    def scaled(self, factor: float) -> "OdometryNoise":
        """The same model with every deviation multiplied by ``factor``."""
        return OdometryNoise(*(factor * value for value in self))


@leaf
def wrap(angle: float) -> float:
    """The same angle in (-π, π] [rad]."""
    turned = angle - 2.0 * math.pi * math.floor((angle + math.pi) / (2.0 * math.pi))
    return math.pi if turned <= -math.pi else turned


@leaf
def deviations(noise: OdometryNoise, dx: float, dy: float, dtheta: float) -> tuple[float, float, float]:
    """Standard deviations (σ_x, σ_y, σ_θ) [m, m, rad] of one reading."""
    sx = noise.srr * abs(dx) + noise.str_ * abs(dtheta) + 0.3 * noise.srr * abs(dy)
    sy = noise.srr * abs(dy) + noise.str_ * abs(dtheta) + 0.3 * noise.srr * abs(dx)
    return sx, sy, noise.stt * abs(dtheta) + noise.srt * math.hypot(dx, dy)


@leaf
def relative_motion(before: NDArray[np.float64], after: NDArray[np.float64]) -> tuple[float, float, float]:
    """Motion (dx, dy, dθ) between two poses (3,), in the frame of the first."""
    cos, sin = math.cos(before[2]), math.sin(before[2])
    dx, dy = after[0] - before[0], after[1] - before[1]
    return dx * cos + dy * sin, dy * cos - dx * sin, wrap(after[2] - before[2])


@leaf
def move(pose: NDArray[np.float64], dx: float, dy: float, dtheta: float) -> None:
    """Compose ``pose`` (3,) in place with a motion given in its own frame."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    pose[0] += dx * cos - dy * sin
    pose[1] += dx * sin + dy * cos
    pose[2] = wrap(pose[2] + dtheta)


@leaf
def read_odometry(
    first: int,
    last: int,
    before: NDArray[np.float64],
    after: NDArray[np.float64],
    noise: OdometryNoise,
    streams: NDArray[np.uint64],
    readings: NDArray[np.float64],
) -> None:
    """Fill ``readings`` (worlds, robots, 3) with noisy motions of worlds first … last - 1.

    Args:
        first: First world.
        last: World after the last.
        before: (worlds, robots, 3) poses before the motion.
        after: (worlds, robots, 3) poses after it.
        noise: The motion model; all zero reads the motion exactly.
        streams: (worlds, 4) random streams.
        readings: (worlds, robots, 3) output, in the robots' frames before the motion.
    """
    for w in range(first, last):
        for r in range(before.shape[1]):
            dx, dy, dtheta = relative_motion(before[w, r], after[w, r])
            sx, sy, st = deviations(noise, dx, dy, dtheta)
            readings[w, r, 0] = dx + sx * normal(streams[w])
            readings[w, r, 1] = dy + sy * normal(streams[w])
            readings[w, r, 2] = dtheta + st * normal(streams[w])
