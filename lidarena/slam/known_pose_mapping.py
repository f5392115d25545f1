"""Mapping with known poses: what is left of SLAM when the robot knows where it is, or believes that it does."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.estimator import BatchEstimator, EstimatorSettings, Floats
from lidarena.slam.occupancy import OccupancyMaps, trace_scan
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.readings import Reading, ScanGeometry
from lidarena.slam.scan_outline import Outlines, empty_outlines


class KnownPoseEstimator(BatchEstimator):
    """Traces scans from given poses into the maps, at the particle filter's update rule; whose poses, subclasses say.

    Args:
        settings: What it is made for.

    Attributes:
        parameters: Settings, of which only the update rule and the noise matter.
        since: (worlds, 3) distance [m], turn [rad] and time [s] since the last traced scan.
        outlines: What the kernel works on, a row for each thread.
    """

    def __init__(self, settings: EstimatorSettings) -> None:
        super().__init__(settings)
        rows, beams = settings.wanted.shape[1], settings.directions.shape[1]
        self.parameters = FilterParameters(noise=settings.noise)
        self.since = np.zeros((settings.worlds, 3))
        self.outlines = empty_outlines(settings.worlds, rows, beams, settings.lidar.max_range, settings.resolution)

    def start(self, world: int, plan: int, origin: Floats, pose: Floats, rng: np.random.Generator) -> None:
        """Begin an episode in one world; the next scan is traced, whatever the update rule says."""
        super().start(world, plan, origin, pose, rng)
        self.since[world] = math.inf

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The belief, and what has happened since the last traced scan."""
        return super().arrays() | {"since": self.since}


@leaf
def map_scan(
    w: int,
    reading: Reading,
    geometry: ScanGeometry,
    parameters: FilterParameters,
    pose: NDArray[np.float64],
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
    s: int,
) -> None:
    """Advance world w's map by a motion and, where due, the scan taken at ``pose`` (3,) after it.

    Args:
        w: World.
        reading: What was measured.
        geometry: Of scans and grids.
        parameters: Settings, of which only the update rule matters.
        pose: (3,) where the scan was taken.
        since: (worlds, 3), see ``KnownPoseEstimator``.
        maps: The grids.
        outlines: Room to work in.
        s: Which row of it; no other thread may use it meanwhile.
    """
    since[w, 0] += math.hypot(reading.motion[0], reading.motion[1])
    since[w, 1] += abs(reading.motion[2])
    since[w, 2] += reading.duration
    due = since[w, 0] >= parameters.linear_update or since[w, 1] >= parameters.angular_update
    if reading.fresh and (due or since[w, 2] > parameters.temporal_update):
        resolution, directions, max_range = geometry.resolution, geometry.directions, geometry.max_range
        trace_scan(maps, w, resolution, pose, reading.scan, directions, max_range, 1, outlines, s)
        since[w] = 0.0
