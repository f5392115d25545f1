"""Mapping with known poses: what is left of SLAM when the robot knows where it is (``slam="truth"``, for ablations)."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.occupancy import OccupancyMaps, clear_map, empty_maps, trace_scan
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.slam.scan_outline import Outlines, empty_outlines


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
        outlines: What the kernel works on, a row for each thread.
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
        self.outlines = empty_outlines(worlds, wanted.shape[1], directions.shape[1], max_range, resolution)
        self.parameters = parameters or FilterParameters()
        self.directions, self.max_range, self.resolution = directions, max_range, resolution

    def start(
        self,
        world: int,
        plan: int,
        origin: NDArray[np.float64],
        pose: NDArray[np.float64],
    ) -> None:
        """Start one map anew; the next scan is traced, whatever the update rule says and from whatever ``pose``."""
        clear_map(self.maps, world, plan, origin)
        self.since[world] = math.inf


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
        pose: (3,) true pose.
        since: (worlds, 3), see ``KnownPoseMapper``.
        maps: The grids.
        outlines: Room to work in.
        s: Which row of it; no other thread may use it meanwhile.
    """
    since[w, 0] += math.hypot(reading[0], reading[1])
    since[w, 1] += abs(reading[2])
    since[w, 2] += duration
    due = since[w, 0] >= parameters.linear_update or since[w, 1] >= parameters.angular_update
    if due or since[w, 2] > parameters.temporal_update:
        trace_scan(maps, w, resolution, pose, scan, directions, max_range, 1, outlines, s)
        since[w] = 0.0
