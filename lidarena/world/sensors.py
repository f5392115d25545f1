"""What robots measure in one decision period, in one kernel: odometry, scan, bumper, and the paths added up."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import merged
from lidarena.world.lidar import NO_OUTLINE, LidarSpec, add_range_noise, cast_beams, scan_is_due
from lidarena.world.map_geometry import MapGeometry
from lidarena.world.odometry import OdometryNoise, move, read_odometry


class Sensors(NamedTuple):
    """Measurements of ``W`` worlds with one robot each.

    Attributes:
        ranges: (W, 1, beams) exact ranges [m].
        scans: (W, 1, beams) measured ranges, float32 [m].
        readings: (W, 1, 3) odometry of the last step.
        dead_reckoning: (W, 1, 3) the readings added up.
        path_length: (W,) length of the odometry's path [m].
        true_path_length: (W,) length of the true path [m].
        collision: (W,) whether some exact range is below the bumper's distance.
        since_scan: (W,) time since the last scan [s].
        fresh: (W,) whether the scan is of the last step; a slow lidar keeps its last one.
    """

    ranges: NDArray[np.float64]
    scans: NDArray[np.float32]
    readings: NDArray[np.float64]
    dead_reckoning: NDArray[np.float64]
    path_length: NDArray[np.float64]
    true_path_length: NDArray[np.float64]
    collision: NDArray[np.bool_]
    since_scan: NDArray[np.float64]
    fresh: NDArray[np.bool_]


def empty_sensors(worlds: int, beams: int) -> Sensors:
    """Allocate them."""
    return Sensors(
        np.zeros((worlds, 1, beams)),
        np.zeros((worlds, 1, beams), np.float32),
        np.zeros((worlds, 1, 3)),
        np.zeros((worlds, 1, 3)),
        np.zeros(worlds),
        np.zeros(worlds),
        np.zeros(worlds, np.bool_),
        np.zeros(worlds),
        np.zeros(worlds, np.bool_),
    )


class Sensing(NamedTuple):
    """What sensors are read from, ``W`` worlds with one robot each; see ``sense``.

    Attributes:
        before: (W, 1, 3) true poses before the motion.
        poses: (W, 1, 3) true poses after it.
        plan: (W,) each world's floor plan.
        streams: (W, 4) random streams.
        noise: The odometry's.
        lidar: The lidar.
        bumper: Ranges below this are a collision [m].
        geometry: The floor plans.
        directions: (2, beams) cos and sin of the beams' angles.
        sensors: What is measured; output.
        period: Duration of the motion [s].
    """

    before: NDArray[np.float64]
    poses: NDArray[np.float64]
    plan: NDArray[np.int64]
    streams: NDArray[np.uint64]
    noise: OdometryNoise
    lidar: LidarSpec
    bumper: float
    geometry: MapGeometry
    directions: NDArray[np.float64]
    sensors: Sensors
    period: float


@merged
def sense(w: int, sensing: Sensing) -> None:
    """Read the sensors of world w after a motion; for the kernels of estimators."""
    before, poses, sensors = sensing.before, sensing.poses, sensing.sensors
    streams, lidar, geometry = sensing.streams, sensing.lidar, sensing.geometry
    read_odometry(w, w + 1, before, poses, sensing.noise, streams, sensors.readings)
    cast_beams(w, w + 1, poses, sensing.plan, 0.0, NO_OUTLINE, geometry, sensing.directions, lidar, sensors.ranges)
    sensors.fresh[w] = scan_is_due(w, sensing.period, lidar, sensors.since_scan)
    if sensors.fresh[w]:
        add_range_noise(w, w + 1, lidar, streams, sensors.ranges, sensors.scans)
    dx, dy, dtheta = sensors.readings[w, 0, 0], sensors.readings[w, 0, 1], sensors.readings[w, 0, 2]
    move(sensors.dead_reckoning[w, 0], dx, dy, dtheta)
    sensors.path_length[w] += math.sqrt(dx * dx + dy * dy)
    dx, dy = poses[w, 0, 0] - before[w, 0, 0], poses[w, 0, 1] - before[w, 0, 1]
    sensors.true_path_length[w] += math.sqrt(dx * dx + dy * dy)
    least = lidar.max_range
    for k in range(sensors.ranges.shape[2]):
        least = min(least, sensors.ranges[w, 0, k])
    sensors.collision[w] = least < sensing.bumper
