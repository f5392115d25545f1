"""Mapping with the true pose, ``slam="truth"``: what exploring is like for a robot that always knows where it is."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf, take_next
from lidarena.slam.estimator import EstimatorSettings
from lidarena.slam.known_pose_mapping import KnownPoseEstimator, map_scan
from lidarena.slam.occupancy import OccupancyMaps
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.readings import Reading, ScanGeometry
from lidarena.slam.scan_outline import Outlines
from lidarena.slam.uncertainty import COVARIANCE_FLOOR
from lidarena.world.sensors import Sensing, sense


class TruePoseEstimator(KnownPoseEstimator):
    """Traces scans from the true poses, for ablations; the pose is as certain as poses get, its entropy 0.

    Args:
        settings: What it is made for.
    """

    def __init__(self, settings: EstimatorSettings) -> None:
        super().__init__(settings)
        self.covariance[:] = np.diag(COVARIANCE_FLOOR)
        self.d_optimality[:] = float(np.prod(COVARIANCE_FLOOR) ** (1 / 3))

    def sense_and_estimate(self, sensing: Sensing, counter: NDArray[np.int64], last: int, thread: int) -> None:
        """Read the sensors and map with the true poses, world after world."""
        sense_and_map(
            sensing, counter, last, thread, self.settings.resolution, self.parameters, self.estimate, self.since,
            self.maps, self.outlines,
        )  # fmt: skip

    def scaled_entropy(self) -> NDArray[np.float64]:
        """Zero, as nothing is in doubt."""
        return np.zeros(self.settings.worlds)


@leaf
def sense_and_map(
    sensing: Sensing,
    counter: NDArray[np.int64],
    last: int,
    thread: int,
    resolution: float,
    parameters: FilterParameters,
    estimate: NDArray[np.float64],
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
) -> None:
    """Read the sensors and map with the true poses, world after world from a counter (1,) that the threads share."""
    geometry = ScanGeometry(sensing.directions, sensing.lidar.max_range, resolution)
    w = take_next(counter)
    while w < last:
        sense(w, sensing)
        for k in range(3):
            estimate[w, k] = sensing.poses[w, 0, k]
        reading = Reading(
            sensing.period, sensing.sensors.readings[w, 0], sensing.sensors.scans[w, 0], sensing.sensors.fresh[w]
        )
        map_scan(w, reading, geometry, parameters, estimate[w], since, maps, outlines, thread)
        w = take_next(counter)
