"""What estimators are made for in tests."""

import numpy as np

from lidarena.slam.estimator import BatchEstimator, EstimatorSettings
from lidarena.world.lidar import LidarSpec
from lidarena.world.odometry import OdometryNoise


def settings_for(worlds: int, rows: int = 20, columns: int = 30, beams: int = 36) -> EstimatorSettings:
    """Small maps and few beams."""
    angles = np.arange(beams) * (2 * np.pi / beams)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    wanted = np.ones((1, rows, columns), np.uint8)
    return EstimatorSettings(worlds, wanted, directions, LidarSpec(beams=beams), 0.05, OdometryNoise())


def start_all(estimator: BatchEstimator) -> None:
    """Begin an episode in every world, in the middle of its map."""
    for world in range(estimator.settings.worlds):
        origin, pose = np.array([-0.75, -0.5]), np.array([0.0, 0.0, 0.2])
        estimator.start(world, 0, origin, pose, np.random.default_rng(world))
