"""Mapping with known poses: what is left of SLAM when the robot knows where it is (``slam="truth"``, for ablations)."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.occupancy import OccupancyMaps, clear_map, empty_maps, trace_scan
from lidarena.slam.particle_filter_state import FilterParameters
from lidarena.slam.scan_outline import Outlines, empty_outlines
from lidarena.world.kernels import leaf


class KnownPoseMapper:
    """Traces scans from given poses into a batch of maps, at the particle filter's update rule.

    Args:
        worlds: Number of maps.
        wanted: (plans, rows, columns) cells that count as covered once known; its shape is that of every grid.
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: Ranges from here on are no returns [m].
        resolution: Side of a cell [m].
        parameters: Settings, of which only the update rule matters.

    Attributes:
        maps: The occupancy grids.
        since: (worlds, 3) distance [m], turn [rad] and time [s] since the last traced scan.
    """

    def __init__(
        self,
        worlds: int,
        wanted: NDArray[np.uint8],
        directions: NDArray[np.float64],
        max_range: float,
        resolution: float = 0.05,
        parameters: FilterParameters | None = None,
    ) -> None:
        self.maps: OccupancyMaps = empty_maps(worlds, wanted)
        self.since = np.zeros((worlds, 3))
        self._outlines = empty_outlines(worlds, wanted.shape[1], directions.shape[1], max_range, resolution)
        self._parameters = parameters or FilterParameters()
        self._directions, self._max_range, self._resolution = directions, max_range, resolution

    def start(
        self,
        world: int,
        plan: int,
        origin: NDArray[np.float64],
        pose: NDArray[np.float64],
        scans: NDArray[np.float32],
    ) -> None:
        """Start one map anew with its row of ``scans`` (W, beams), taken at ``pose`` (3,)."""
        clear_map(self.maps, world, plan, origin)
        self.since[world] = 0.0
        trace_scan(
            self.maps, world, self._resolution, pose, scans[world], self._directions, self._max_range, 1,
            self._outlines, world,
        )  # fmt: skip

    def step(
        self,
        first: int,
        last: int,
        duration: float,
        readings: NDArray[np.float64],
        scans: NDArray[np.float32],
        poses: NDArray[np.float64],
    ) -> None:
        """Advance maps first … last - 1 by a motion (W, 3) and, where due, the scan (W, beams) at ``poses`` (W, 3)."""
        _map_scans(
            first, last, duration, self._resolution, self._max_range, self._directions, self._parameters,
            readings, scans, poses, self.since, self.maps, self._outlines,
        )  # fmt: skip


@leaf
def _map_scans(
    first: int,
    last: int,
    duration: float,
    resolution: float,
    max_range: float,
    directions: NDArray[np.float64],
    parameters: FilterParameters,
    readings: NDArray[np.float64],
    scans: NDArray[np.float32],
    poses: NDArray[np.float64],
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
) -> None:
    """Kernel of ``KnownPoseMapper.step``."""
    for w in range(first, last):
        since[w, 0] += math.hypot(readings[w, 0], readings[w, 1])
        since[w, 1] += abs(readings[w, 2])
        since[w, 2] += duration
        due = since[w, 0] >= parameters.linear_update or since[w, 1] >= parameters.angular_update
        if due or since[w, 2] > parameters.temporal_update:
            trace_scan(maps, w, resolution, poses[w], scans[w], directions, max_range, 1, outlines, first)
            since[w] = 0.0
