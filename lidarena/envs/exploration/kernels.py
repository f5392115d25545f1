"""What the worlds' threads run: sensors and SLAM of one world after another, taken from a shared counter."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf, take_next
from lidarena.slam.known_pose_mapping import map_scan
from lidarena.slam.occupancy import OccupancyMaps
from lidarena.slam.rbpf.filter_kernel import step_filter
from lidarena.slam.rbpf.particle_filter_state import FilterParameters, FilterState, Scratch
from lidarena.slam.scan_outline import Outlines
from lidarena.world.lidar import LidarSpec, MapGeometry
from lidarena.world.odometry import OdometryNoise
from lidarena.world.sensors import Sensors, read_sensors

# Both kernels take: a counter (1,) at the first world and the world after the last, the thread's number; the true poses
# (W, 1, 3) before and after the motion, the worlds' floor plans (W,) and random streams (W, 4); then what the sensors
# and the maps are made of, the range below which a beam is a collision among it.


@leaf
def sense_and_filter(
    counter: NDArray[np.int64],
    last: int,
    thread: int,
    before: NDArray[np.float64],
    poses: NDArray[np.float64],
    plan: NDArray[np.int64],
    streams: NDArray[np.uint64],
    noise: OdometryNoise,
    lidar: LidarSpec,
    bumper: float,
    geometry: MapGeometry,
    directions: NDArray[np.float64],
    sensors: Sensors,
    period: float,
    resolution: float,
    parameters: FilterParameters,
    state: FilterState,
    maps: OccupancyMaps,
    scratch: Scratch,
) -> None:
    """Read the sensors and run the particle filter."""
    w = take_next(counter)
    while w < last:
        read_sensors(w, before, poses, plan, noise, lidar, bumper, geometry, directions, streams, sensors)
        step_filter(
            w, period, resolution, lidar.max_range, directions, parameters, sensors.readings[w, 0],
            sensors.scans[w, 0], streams[w], state, maps, scratch, thread,
        )  # fmt: skip
        w = take_next(counter)


@leaf
def sense_and_map(
    counter: NDArray[np.int64],
    last: int,
    thread: int,
    before: NDArray[np.float64],
    poses: NDArray[np.float64],
    plan: NDArray[np.int64],
    streams: NDArray[np.uint64],
    noise: OdometryNoise,
    lidar: LidarSpec,
    bumper: float,
    geometry: MapGeometry,
    directions: NDArray[np.float64],
    sensors: Sensors,
    period: float,
    resolution: float,
    parameters: FilterParameters,
    since: NDArray[np.float64],
    maps: OccupancyMaps,
    outlines: Outlines,
) -> None:
    """Read the sensors and map with the true poses."""
    w = take_next(counter)
    while w < last:
        read_sensors(w, before, poses, plan, noise, lidar, bumper, geometry, directions, streams, sensors)
        map_scan(
            w, period, resolution, lidar.max_range, directions, parameters, sensors.readings[w, 0],
            sensors.scans[w, 0], poses[w, 0], since, maps, outlines, thread,
        )  # fmt: skip
        w = take_next(counter)
