"""Mapping with known poses: what is left of SLAM when the robot knows where it is, or believes that it does."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.estimator import BatchEstimator, EstimatorSettings
from lidarena.slam.occupancy import OccupancyMaps, trace_scan
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
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

    def start(
        self,
        world: int,
        plan: int,
        origin: NDArray[np.float64],
        pose: NDArray[np.float64],
        rng: np.random.Generator,
    ) -> None:
        """Begin an episode in one world; the next scan is traced, whatever the update rule says."""
        super().start(world, plan, origin, pose, rng)
        self.since[world] = math.inf

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The belief, and what has happened since the last traced scan."""
        return super().arrays() | {"since": self.since}


@leaf
def map_scan(
    w: int,
    duration: float,
    resolution: float,
    max_range: float,
    directions: NDArray[np.float64],
    parameters: FilterParameters,
    reading: NDArray[np.float64],
    scan: NDArray[np.float32],
    fresh: bool,
    pose: NDArray[np.float64],
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
    s: int,
) -> None:
    """Advance world w's map by a motion (3,) and, where due, the scan (beams,) taken at ``pose`` (3,) after it.

    Args:
        w: World.
        duration: Of the motion [s].
        resolution: Of the grids [m].
        max_range: Ranges from here on are no returns [m].
        directions: (2, beams) cos and sin of the beams' angles.
        parameters: Settings, of which only the update rule matters.
        reading: (3,) the motion.
        scan: (beams,) ranges [m].
        fresh: Whether the scan was taken now; an older one is not looked at.
        pose: (3,) where the scan was taken.
        since: (worlds, 3), see ``KnownPoseEstimator``.
        maps: The grids.
        outlines: Room to work in.
        s: Which row of it; no other thread may use it meanwhile.
    """
    since[w, 0] += math.hypot(reading[0], reading[1])
    since[w, 1] += abs(reading[2])
    since[w, 2] += duration
    due = since[w, 0] >= parameters.linear_update or since[w, 1] >= parameters.angular_update
    if fresh and (due or since[w, 2] > parameters.temporal_update):
        trace_scan(maps, w, resolution, pose, scan, directions, max_range, 1, outlines, s)
        since[w] = 0.0
