"""Recorded logs made by the simulator: a robot with a laser of a half turn that drives from waypoint to waypoint."""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.slam.logs.carmen import RecordedLog
from lidarena.slam.logs.relations import Relations
from lidarena.slam.planar import compose
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.odometry import OdometryNoise, read_odometry

RANGE = 30.0
LAP = [(0.65, 0.65), (7.35, 0.65), (7.35, 7.35), (0.65, 7.35), (0.65, 0.65), (4.0, 0.65)]
"""Once round ``drive.ring()`` and on, so that the loop closes."""


def way(points: list[tuple[float, float]], stride: float = 0.1, turn: float = 0.1) -> NDArray[np.float64]:
    """Poses (n, 3) along straight lines, turning on the spot between them."""
    poses, heading = [], math.atan2(points[1][1] - points[0][1], points[1][0] - points[0][0])
    for (x1, y1), (x2, y2) in pairwise(points):
        goal = math.atan2(y2 - y1, x2 - x1)
        by = math.remainder(goal - heading, 2 * math.pi)
        poses += [(x1, y1, heading + by * s) for s in np.linspace(0, 1, max(round(abs(by) / turn), 1), endpoint=False)]
        n = max(round(math.hypot(x2 - x1, y2 - y1) / stride), 1)
        poses += [(x1 + (x2 - x1) * s, y1 + (y2 - y1) * s, goal) for s in np.linspace(0, 1, n, endpoint=False)]
        heading = goal
    return np.array(poses)


def record(plan: Floorplan, truth: NDArray[np.float64], seed: int = 0, drift: float = 1.0) -> RecordedLog:
    """What a robot on its way along ``truth`` (n, 3) reports: a reading every 0.1 s, a scan with every second one."""
    rng = np.random.default_rng(seed)
    streams, reading = seed_stream(rng)[None], np.zeros((1, 1, 3))
    odometry = [truth[0]]
    for before, after in pairwise(truth):
        read_odometry(0, 1, before[None, None], after[None, None], OdometryNoise().scaled(drift), streams, reading)
        odometry.append(compose(odometry[-1], reading[0, 0]))
    scans = np.arange(0, len(truth), 2)
    lidar = Lidar([plan], LidarSpec(360, RANGE))
    exact = lidar.cast(truth[scans][:, None], np.zeros(len(scans), np.int64))[:, 0]
    front = np.roll(exact, 90, axis=1)[:, :180]
    noisy = np.clip(front + rng.normal(0.0, 0.01, front.shape), 0.01, None)
    return RecordedLog(
        name="simulated.log",
        times=1e9 + 0.1 * np.arange(len(truth)),
        odometry=np.array(odometry),
        scan_readings=scans,
        ranges=np.where(front < RANGE, noisy, RANGE).astype(np.float32),
        angles=np.radians(np.arange(180) - 90.0),
        max_range=RANGE,
        mount=np.zeros(3),
    )


def relations_of(log: RecordedLog, truth: NDArray[np.float64], count: int = 60) -> Relations:
    """True relations between random moments of a log."""
    from lidarena.slam.planar import between

    pairs = np.random.default_rng(0).integers(0, len(truth), (count, 2))
    return Relations("simulated.relations", log.times[pairs], between(truth[pairs[:, 0]], truth[pairs[:, 1]]))
