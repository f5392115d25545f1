"""A recorded log mapped by a graph of poses."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.graph.mapper import Loop, MapParameters, Mapper, PoseGraph
from lidarena.slam.logs.bridges import unbridged, unsure_scans
from lidarena.slam.logs.mount_check import checked_mount
from lidarena.slam.logs.reading import read_recording
from lidarena.slam.logs.recorded_log import RecordedLog
from lidarena.slam.logs.traced_map import trace_map
from lidarena.slam.logs.trajectory import Trajectory, in_order, spread_correction
from lidarena.slam.planar import compose, inverse
from lidarena.slam.rbpf.likelihood_field import CELL
from lidarena.world.map_server import OccupancyMap

Progress = Callable[[int, int], None]
"""Called with the scans that are done and the scans of the log."""


@dataclass(frozen=True)
class LogMap:
    """What was made of a log.

    Attributes:
        trajectory: The robot's pose at every reading of the log.
        readings: (K,) which readings are nodes of the graph.
        poses: (K, 3) the laser's poses then.
        map: The occupancy grid of the nodes' scans.
        loops: The loops that were found; their scans are numbered as the log's.
        graph: Nodes and edges.
        doubts: Sentences on where the map may be wrong.
        seconds: Processor time, without what it took to compile.
    """

    trajectory: Trajectory
    readings: NDArray[np.int64]
    poses: NDArray[np.float64]
    map: OccupancyMap
    loops: list[Loop]
    graph: PoseGraph
    doubts: list[str]
    seconds: float


def map_log(
    log: RecordedLog | str | Path,
    parameters: MapParameters | None = None,
    progress: Progress | None = None,
    resolution: float = CELL,
) -> LogMap:
    """Map a recorded log, on one core; the same log gives the same bits.

    The map and the trajectory are in the frame of the log's odometry at its first scan.

    Args:
        log: A file, or what `lidarena.slam.read_log` made of one.
        parameters: Settings.
        progress: Told now and then how far it is.
        resolution: Side of a cell of the map [m].

    Raises:
        LogError: The file cannot be read.
        EstimatorError: The beams are not evenly spaced.
        MapError: The robot went farther than any map may reach.
    """
    if not isinstance(log, RecordedLog):
        log = read_recording(log)
    began = time.process_time()
    unsure = unsure_scans(log)
    mapper, total = Mapper(log.angles, log.max_range, log.mount, parameters), len(log.scan_readings)
    for k, reading in enumerate(log.scan_readings):
        mapper.add(float(log.times[reading]), log.odometry[reading], log.ranges[k], bool(unsure[k]))
        if progress is not None and (k % 50 == 49 or k == total - 1):
            progress(k + 1, total)
    result = mapper.finish()
    graph, laser = result.graph, compose(result.poses, log.mount)
    mount, doubt = checked_mount(log.mount, log.odometry[log.scan_readings], laser)
    robot = result.poses if doubt is None else compose(laser, inverse(mount))
    seconds = time.process_time() - began
    doubts = [*result.doubts, *unbridged(log, unsure, mapper.front.scores), *([] if doubt is None else [doubt])]
    return LogMap(
        trajectory=in_order(log.times, spread_correction(log.odometry, log.scan_readings, robot)),
        readings=log.scan_readings[graph.scans],
        poses=graph.nodes,
        map=trace_map(log, graph.scans, graph.nodes, resolution=resolution),
        loops=result.loops,
        graph=graph,
        doubts=doubts,
        seconds=seconds,
    )
