"""Mapping with the true pose, ``slam="truth"``: what exploring is like for a robot that always knows where it is."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.estimator import EstimatorSettings
from lidarena.slam.known_pose_mapping import KnownPoseEstimator, map_scan
from lidarena.slam.occupancy import OccupancyMaps
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.readings import ScanGeometry, Share, next_world, reading_of
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

    def sense_and_estimate(self, sensing: Sensing, share: Share) -> None:
        """Read the sensors and map with the true poses, world after world."""
        arguments = (
            sensing, share, self.geometry, self.parameters, self.estimate, self.since,
            self.maps, self.outlines,
        )  # fmt: skip
        self._pass_of(sense_and_map, arguments)(*arguments)

    def scaled_entropy(self) -> NDArray[np.float64]:
        """Zero, as nothing is in doubt."""
        return np.zeros(self.settings.worlds)


@leaf
def sense_and_map(
    sensing: Sensing,
    share: Share,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    estimate: NDArray[np.float64],
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
) -> None:
    """Read the sensors and map with the true poses, world after world."""
    w = next_world(share)
    while w < share.last:
        sense(w, sensing)
        for k in range(3):
            estimate[w, k] = sensing.poses[w, 0, k]
        map_scan(w, reading_of(w, sensing), geometry, parameters, estimate[w], since, maps, outlines, share.thread)
        w = next_world(share)
