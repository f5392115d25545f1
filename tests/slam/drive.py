"""A robot driven along a list of commands, with its sensors, for the tests of the filter."""

from collections.abc import Iterable

import numpy as np

from lidarena.base.random_streams import seed_stream
from lidarena.slam.rbpf.particle_filter import ParticleFilters
from lidarena.slam.rbpf.particle_filter_state import FilterParameters
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec, add_range_noise
from lidarena.world.odometry import OdometryNoise, read_odometry
from lidarena.world.physics import Physics

FORWARD, LEFT, RIGHT = (0.5, 0.0), (0.05, 0.3), (0.05, -0.3)


class Drive:
    """One world: ``run`` drives and returns position error and covariance after every step."""

    def __init__(self, plan: Floorplan, seed: int = 0, parameters: FilterParameters | None = None) -> None:
        self.lidar, self.physics = Lidar([plan]), Physics(1)
        self.streams = seed_stream(np.random.default_rng(seed))[None]
        self.raster = plan.raster(0.05)
        self.physics.place(0, plan, [plan.start])
        self.scans = np.zeros((1, 1, 360), np.float32)
        self.readings = np.zeros((1, 1, 3))
        wanted = (~self.raster.solid)[None].astype(np.uint8)
        self.filters = ParticleFilters(1, wanted, self.lidar.directions, 3.5, parameters=parameters)
        self._scan()
        self.filters.start(0, 0, self.raster.origin, self.physics.poses[0, 0])
        self._filter()

    def _scan(self) -> None:
        self.ranges = self.lidar.cast(self.physics.poses, np.zeros(1, np.int64))
        add_range_noise(0, 1, LidarSpec(), self.streams, self.ranges, self.scans)

    def _filter(self) -> None:
        self.filters.step(0, 0.2, self.readings[0, 0], self.scans[0, 0], self.streams[0])

    def run(self, commands: Iterable[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
        errors, covariances = [], []
        for command in commands:
            before = self.physics.poses.copy()
            self.physics.advance(np.array([[command]]), 0.2, self.ranges.min(axis=2)[:, 0] < 0.3)
            read_odometry(0, 1, before, self.physics.poses, OdometryNoise(), self.streams, self.readings)
            self._scan()
            self._filter()
            state = self.filters.state
            errors.append(np.hypot(*(state.estimate[0] - self.physics.poses[0, 0])[:2]))
            covariances.append(state.covariance[0].copy())
        return np.array(errors), np.array(covariances)


def turn(angle: float) -> list[tuple[float, float]]:
    """Commands that turn by about ``angle`` [rad]."""
    return [LEFT if angle > 0 else RIGHT] * round(abs(angle) / 0.06)


def corridor(length: float) -> Floorplan:
    """A bare corridor 1.2 m wide whose ends are out of the lidar's range for most of its length."""
    walls = [(0, 0, length, 0), (length, 0, length, 1.2), (length, 1.2, 0, 1.2), (0, 1.2, 0, 0)]
    return Floorplan.from_shapes("corridor", (0, 0, length, 1.2), walls=walls, start=(4.0, 0.6, 0.0))


def ring() -> Floorplan:
    """A square corridor round a block, 1.2 m wide, with some posts to hold on to."""
    walls = [(0, 0, 8, 0), (8, 0, 8, 8), (8, 8, 0, 8), (0, 8, 0, 0)]
    block = [(1.3, 1.3), (6.7, 1.3), (6.7, 6.7), (1.3, 6.7)]
    return Floorplan.from_shapes("ring", (0, 0, 8, 8), walls=walls, polygons=[block], start=(0.7, 0.7, 0.0))
