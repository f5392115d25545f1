"""Dead reckoning, ``slam="odometry"``: mapping with the odometry's pose, what SLAM is measured against."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.estimator import EstimatorSettings, Floats
from lidarena.slam.known_pose_mapping import KnownPoseEstimator, map_scan
from lidarena.slam.occupancy import OccupancyMaps
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.readings import ScanGeometry, Share, next_world, reading_of
from lidarena.slam.scan_outline import Outlines
from lidarena.slam.uncertainty import COVARIANCE_FLOOR, compound_covariance, d_optimality
from lidarena.world.odometry import deviations, move
from lidarena.world.sensors import Sensing, sense


class DeadReckoningEstimator(KnownPoseEstimator):
    """Adds up the odometry and traces scans from where that leads; nothing ever corrects it.

    The covariance is that of gmapping's motion noise, propagated to first order from reading to reading, plus the floor
    that every estimator has: D-optimality means the same as with the particle filter.

    Args:
        settings: What it is made for.

    Attributes:
        drift: (worlds, 3, 3) the covariance without the floor.
    """

    def __init__(self, settings: EstimatorSettings) -> None:
        super().__init__(settings)
        self.drift = np.zeros((settings.worlds, 3, 3))

    def start(self, world: int, plan: int, origin: Floats, pose: Floats, rng: np.random.Generator) -> None:
        """Begin an episode in one world, certain of the pose."""
        super().start(world, plan, origin, pose, rng)
        self.drift[world] = 0.0

    def sense_and_estimate(self, sensing: Sensing, share: Share) -> None:
        """Read the sensors, add up the odometry and map, world after world."""
        arguments = (
            sensing, share, self.geometry, self.parameters, self.estimate, self.drift,
            self.covariance, self.d_optimality, self.since, self.maps, self.outlines,
        )  # fmt: skip
        self._pass_of(sense_and_reckon, arguments)(*arguments)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The belief, and the covariance without the floor."""
        return super().arrays() | {"drift": self.drift}


@leaf
def sense_and_reckon(
    sensing: Sensing,
    share: Share,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    estimate: NDArray[np.float64],
    drift: NDArray[np.float64],
    covariance: NDArray[np.float64],
    d_optimalities: NDArray[np.float64],
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
) -> None:
    """Read the sensors, reckon and map, world after world.

    ``d_optimalities`` (worlds,) is set to the D-optimality; the other arrays are those of ``DeadReckoningEstimator``.
    """
    w = next_world(share)
    while w < share.last:
        sense(w, sensing)
        reading = reading_of(w, sensing)
        dx, dy, dtheta = reading.motion[0], reading.motion[1], reading.motion[2]
        sx, sy, st = deviations(parameters.noise, dx, dy, dtheta)
        compound_covariance(estimate[w], drift[w], dx, dy, sx * sx, sy * sy, st * st)
        move(estimate[w], dx, dy, dtheta)
        for k in range(3):
            for j in range(3):
                covariance[w, k, j] = drift[w, k, j] + (COVARIANCE_FLOOR[k] if j == k else 0.0)
        d_optimalities[w] = d_optimality(covariance[w])
        map_scan(w, reading, geometry, parameters, estimate[w], since, maps, outlines, share.thread)
        w = next_world(share)
