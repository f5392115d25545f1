"""The exploration worlds themselves, batched: physics, sensors, SLAM, bookkeeping; no spaces, rewards or episodes."""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.coverage import measure_coverage
from lidarena.envs.exploration_options import ExplorationOptions
from lidarena.envs.worker_threads import for_ranges
from lidarena.slam.known_pose_mapping import KnownPoseMapper
from lidarena.slam.particle_filter import ParticleFilters
from lidarena.slam.particle_filter_state import FilterParameters
from lidarena.slam.uncertainty import COVARIANCE_FLOOR
from lidarena.world.floorplan import START_CLEARANCE
from lidarena.world.lidar import Lidar, LidarSpec, add_range_noise, cast_beams
from lidarena.world.load import load_floorplan
from lidarena.world.odometry import OdometryNoise, move_poses, read_odometry
from lidarena.world.physics import Physics, RobotSpec
from lidarena.world.random_streams import seed_stream

RESOLUTION = 0.05
"""Side of a map cell, gmapping's δ [m]."""
_LEAST_FILTER_NOISE = 0.1
"""The filter never trusts the odometry more than this share of gmapping's noise."""


class ExplorationCore:
    """``worlds`` single-robot worlds with a lidar and SLAM, stepped together.

    World ``i`` depends on nothing but its own generator and commands: not on the other worlds, nor on their number, nor
    on the number of threads.

    Args:
        worlds: Number of worlds.
        options: Checked keywords.

    Attributes:
        physics: The true poses; everything that the robot may know is in the attributes below.
        scans: (worlds, 1, 360) measured ranges, float32 [m].
        readings: (worlds, 1, 3) odometry of the last step.
        dead_reckoning: (worlds, 3) the readings added up.
        collision: (worlds,) whether some beam is shorter than the robot's safety distance.
        path_length: (worlds,) length of the odometry's path [m].
        true_path_length: (worlds,) length of the true path [m].
        estimate: (worlds, 3) pose; covariance (worlds, 3, 3); criteria (worlds, 3): D-optimality, entropy, N_eff.
        wanted_cells: (plans,) size of K of each floor plan.
    """

    def __init__(self, worlds: int, options: ExplorationOptions) -> None:
        self.options = options
        start = None if isinstance(options.start, str) else options.start
        self.plans = [load_floorplan(spec, start=start) for spec in options.maps]
        self.robot, self.beam = RobotSpec(), LidarSpec(noise=options.lidar_noise)
        self.lidar = Lidar(self.plans, self.beam)
        self.physics = Physics(worlds, spec=self.robot)
        self._coverage = [measure_coverage(plan, RESOLUTION, self.robot.radius) for plan in self.plans]
        self.wanted_cells = np.array([coverage.wanted.sum() for coverage in self._coverage])
        self._noise = OdometryNoise().scaled(options.odometry_noise)
        self._allocate(worlds)
        self._make_slam(worlds)

    def _allocate(self, worlds: int) -> None:
        beams = self.beam.beams
        self.worlds = worlds
        self.plan = np.zeros(worlds, np.int64)
        self.streams = np.zeros((worlds, 4), np.uint64)
        self.ranges = np.zeros((worlds, 1, beams))
        self.scans = np.zeros((worlds, 1, beams), np.float32)
        self.readings = np.zeros((worlds, 1, 3))
        self.dead_reckoning = np.zeros((worlds, 1, 3))
        self.collision = np.zeros(worlds, np.bool_)
        self.path_length = np.zeros(worlds)
        self.true_path_length = np.zeros(worlds)

    def _make_slam(self, worlds: int) -> None:
        rows, columns = np.max([coverage.wanted.shape for coverage in self._coverage], axis=0)
        wanted = np.zeros((len(self.plans), rows, columns), np.uint8)
        for k, coverage in enumerate(self._coverage):
            r, c = coverage.wanted.shape
            wanted[k, :r, :c] = coverage.wanted
        factor = max(self.options.odometry_noise, _LEAST_FILTER_NOISE)
        parameters = FilterParameters(particles=self.options.particles, noise=OdometryNoise().scaled(factor))
        self.filters: ParticleFilters | None = None
        self.mapper: KnownPoseMapper | None = None
        settings = (worlds, wanted, self.lidar.directions, self.beam.max_range, RESOLUTION, parameters)
        if self.options.slam == "rbpf":
            self.filters = ParticleFilters(*settings)
            state = self.filters.state
            self.maps = self.filters.maps
            self.estimate, self.covariance, self.criteria = state.estimate, state.covariance, state.criteria
        else:
            self.mapper = KnownPoseMapper(*settings)
            self.maps = self.mapper.maps
            self.estimate = self.physics.poses[:, 0]
            self.covariance = np.tile(np.diag(COVARIANCE_FLOOR), (worlds, 1, 1))
            certain = (float(np.prod(COVARIANCE_FLOOR) ** (1 / 3)), 0.0, float(self.options.particles))
            self.criteria = np.tile(np.array(certain), (worlds, 1))

    def reset_world(self, world: int, rng: np.random.Generator) -> None:
        """Begin a new episode in one world; everything random is drawn from ``rng``."""
        plan = int(rng.integers(len(self.plans))) if len(self.plans) > 1 else 0
        pose = self._start_pose(plan, rng)
        self.streams[world] = seed_stream(rng)
        self.plan[world] = plan
        self.physics.place(world, self.plans[plan], [pose])
        self.dead_reckoning[world, 0] = pose
        self.readings[world] = 0.0
        self.path_length[world] = self.true_path_length[world] = 0.0
        self._sense(world, world + 1)
        slam = self.filters or self.mapper
        assert slam is not None
        origin = self._coverage[plan].origin
        slam.start(world, plan, origin, self.physics.poses[world, 0].copy(), self.scans[:, 0])

    def _start_pose(self, plan: int, rng: np.random.Generator) -> tuple[float, float, float]:
        if self.options.start != "random":
            return self.plans[plan].start
        starts = self._coverage[plan].starts
        x, y = starts[int(rng.integers(len(starts)))]
        return (float(x), float(y), float(rng.uniform(-np.pi, np.pi)))

    def step(self, commands: NDArray[np.float64]) -> None:
        """Drive every world for one decision period.

        Args:
            commands: (worlds, 2) speed [m/s] and turn rate [rad/s].
        """
        before = self.physics.poses.copy()
        clearance = self.ranges.min(axis=2)
        self.physics.advance(commands[:, None, :], self.options.decision_period, clearance)
        moved = self.physics.poses[:, 0] - before[:, 0]
        self.true_path_length += np.sqrt(moved[:, 0] ** 2 + moved[:, 1] ** 2)
        for_ranges(self.worlds, partial(self._perceive, before))

    def _perceive(self, before: NDArray[np.float64], first: int, last: int) -> None:
        """Read the sensors of worlds first … last - 1 and run their SLAM."""
        poses, here = self.physics.poses, slice(first, last)
        read_odometry(first, last, before, poses, self._noise, self.streams, self.readings)
        move_poses(first, last, self.dead_reckoning, self.readings)
        reading = self.readings[here, 0]
        self.path_length[here] += np.sqrt(reading[:, 0] ** 2 + reading[:, 1] ** 2)
        self._sense(first, last)
        period, readings, scans = self.options.decision_period, self.readings[:, 0], self.scans[:, 0]
        if self.filters is not None:
            self.filters.step(first, last, period, readings, scans, self.streams)
        elif self.mapper is not None:
            self.mapper.step(first, last, period, readings, scans, poses[:, 0])

    def _sense(self, first: int, last: int) -> None:
        reach = self.beam.max_range
        cast_beams(
            first,
            last,
            self.physics.poses,
            self.plan,
            0.0,
            self.lidar.scenery,
            self.lidar.directions,
            reach,
            self.ranges,
        )
        add_range_noise(first, last, self.beam.noise, reach, self.streams, self.ranges, self.scans)
        self.collision[first:last] = self.ranges[first:last, 0].min(axis=1) < START_CLEARANCE

    @property
    def completeness(self) -> NDArray[np.float64]:
        """Map completeness (worlds,), known ∩ K over K, from 0 to 1."""
        share: NDArray[np.float64] = self.maps.covered / self.wanted_cells[self.plan]
        return share

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Every array that makes up the worlds' state, by name; ``load_arrays`` writes them back."""
        named: dict[str, NDArray[Any]] = {
            "poses": self.physics.poses, "plan": self.plan, "streams": self.streams, "ranges": self.ranges,
            "scans": self.scans, "dead_reckoning": self.dead_reckoning, "collision": self.collision,
            "path_length": self.path_length, "true_path_length": self.true_path_length,
        }  # fmt: skip
        named |= {f"maps.{name}": array for name, array in self.maps._asdict().items() if name != "wanted"}
        if self.filters is not None:
            state = self.filters.state._asdict()
            named |= {f"fields.{name}": array for name, array in state.pop("fields")._asdict().items()}
            named |= {f"filter.{name}": array for name, array in state.items()}
        elif self.mapper is not None:
            named["since"] = self.mapper.since
        return named

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another core with the same options."""
        for name, array in self.arrays().items():
            array[...] = saved[name]
        for world in range(self.worlds):
            pose = self.physics.poses[world, 0].tolist()
            self.physics.place(world, self.plans[int(self.plan[world])], [(pose[0], pose[1], pose[2])])
