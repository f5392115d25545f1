"""The exploration worlds themselves, batched: physics, sensors, SLAM, bookkeeping; no spaces, rewards or episodes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.envs.exploration.bumper import Bumper
from lidarena.envs.exploration.floors import make_floors
from lidarena.envs.exploration.options import ExplorationOptions
from lidarena.envs.worker_threads import on_threads
from lidarena.slam.estimator import BatchEstimator, EstimatorSettings
from lidarena.slam.readings import Share
from lidarena.slam.registry import make_estimator
from lidarena.world.lidar import first_scan
from lidarena.world.odometry import OdometryNoise
from lidarena.world.physics import Physics, may_touch
from lidarena.world.sensors import Sensing, empty_sensors

RESOLUTION = 0.05
"""Side of a map cell, gmapping's δ [m]."""
_LEAST_BELIEVED_NOISE = 0.1
"""No estimator trusts the odometry more than this share of gmapping's noise."""


class ExplorationCore:
    """``worlds`` single-robot worlds with a lidar and SLAM, of checked ``options``, stepped together.

    World ``i`` depends on nothing but its own generator and commands.

    Args:
        worlds: How many.
        options: The checked keywords.

    Attributes:
        physics: The true poses; everything that the robot may know is in the attributes below.
        sensors: Scans, odometry, paths, collisions.
        estimator: The SLAM; ``maps``, ``estimate`` (worlds, 3), ``covariance`` (worlds, 3, 3) and ``d_optimality``
            (worlds,) are its.
        floors: The floor plans.
    """

    def __init__(self, worlds: int, options: ExplorationOptions) -> None:
        self.options = options
        start = None if isinstance(options.start, str) else options.start
        self.robot, self.beam = options.robot, options.lidar
        at_start = options.start != "random"
        self.floors = make_floors(worlds, options.maps, start, self.beam, RESOLUTION, self.robot, at_start)
        self.plans, self.lidar = self.floors.plans, self.floors.lidar
        self.bumper = Bumper(worlds, self.lidar, self.robot, options.decision_period)
        self.physics = Physics(worlds, spec=self.robot)
        self._noise = OdometryNoise().scaled(options.odometry_noise)
        self._allocate(worlds)
        self._sensing = self._make_sensing()
        self.estimator = self._make_estimator()
        self.maps, self.estimate = self.estimator.maps, self.estimator.estimate
        self.covariance, self.d_optimality = self.estimator.covariance, self.estimator.d_optimality

    def _allocate(self, worlds: int) -> None:
        self.worlds = worlds
        self.plan = np.zeros(worlds, np.int64)
        self.streams = np.zeros((worlds, 4), np.uint64)
        self._near, self._all = np.zeros(worlds, np.bool_), np.ones(worlds, np.bool_)
        self.sensors = empty_sensors(worlds, self.beam.beams)

    def _make_sensing(self) -> Sensing:
        """What every step's sensing reads and writes: arrays that stay the same ones, but for those of drawn plans."""
        return Sensing(
            np.zeros_like(self.physics.poses), self.physics.poses, self.plan, self.streams, self._noise, self.beam,
            self.robot.bumper, self.lidar.geometry, self.lidar.directions, self.sensors,
            self.options.decision_period,
        )  # fmt: skip

    def _make_estimator(self) -> BatchEstimator:
        wanted = self.floors.wanted
        believed = OdometryNoise().scaled(max(self.options.odometry_noise, _LEAST_BELIEVED_NOISE))
        settings = EstimatorSettings(self.worlds, wanted, self.lidar.directions, self.beam, RESOLUTION, believed)
        return make_estimator(self.options.estimator, settings)

    def reset_world(self, world: int, rng: np.random.Generator) -> None:
        """Begin a new episode in one world; everything random is drawn from ``rng``."""
        plan = self.floors.draw(world, rng)
        pose = self._start_pose(plan, rng)
        self.streams[world] = seed_stream(rng)
        self.plan[world] = plan
        self.physics.place(world, self.plans[plan], [pose])
        sensors = self.sensors
        sensors.dead_reckoning[world, 0] = pose
        sensors.since_scan[world] = first_scan(self.options.decision_period, self.beam)
        sensors.path_length[world] = sensors.true_path_length[world] = 0.0
        self.estimator.start(world, plan, self.floors.coverage(plan).origin, self.physics.poses[world, 0], rng)
        self._sensing.before[world] = self.physics.poses[world]
        self._perceive(world, world + 1, self._all)

    def _start_pose(self, plan: int, rng: np.random.Generator) -> tuple[float, float, float]:
        if self.options.start != "random":
            return self.plans[plan].start
        starts = self.floors.coverage(plan).starts
        x, y = starts[int(rng.integers(len(starts)))]
        return (float(x), float(y), float(rng.uniform(-np.pi, np.pi)))

    def step(self, commands: NDArray[np.float64], active: NDArray[np.bool_] | None = None) -> None:
        """Drive worlds for one decision period.

        Args:
            commands: (worlds, 2) speed [m/s] and turn rate [rad/s].
            active: (worlds,) the others stay as they are; None: all are.
        """
        self._sensing.before[:] = self.physics.poses
        driven, period = commands[:, None, :], self.options.decision_period
        around, directions = self.bumper.ranges(self.sensors), self.bumper.directions
        may_touch(driven, period, self.robot.radius, around, directions, self._near)
        self.physics.advance(driven, period, self._near, active)
        self._perceive(0, self.worlds, self._all if active is None else np.ascontiguousarray(active, np.bool_))

    def _perceive(self, first: int, last: int, active: NDArray[np.bool_]) -> None:
        """Read the sensors of those of worlds first … last - 1 that are active, and run their SLAM."""
        if self._sensing.geometry is not self.lidar.geometry:  # a drawn plan did not fit into the arrays
            self._sensing = self._sensing._replace(geometry=self.lidar.geometry)
        sensing, estimator, counter = self._sensing, self.estimator, np.array([first])
        on_threads(
            last - first, lambda thread: estimator.sense_and_estimate(sensing, Share(counter, last, thread, active))
        )
        estimator.finish(sensing, first, last, active)
        self.bumper.feel(self.physics.poses, self.plan, self.sensors, first, last)

    @property
    def completeness(self) -> NDArray[np.float64]:
        """Map completeness (worlds,), known ∩ K over K, from 0 to 1."""
        share: NDArray[np.float64] = self.maps.covered / self.floors.wanted_cells[self.plan]
        return share

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Every array that makes up the worlds' state, by name; ``load_arrays`` continues from them.

        Raises:
            EstimatorError: The estimator cannot be saved.
        """
        return self._own_arrays() | self.estimator.arrays()

    def _own_arrays(self) -> dict[str, NDArray[Any]]:
        own: dict[str, NDArray[Any]] = {"poses": self.physics.poses, "plan": self.plan, "streams": self.streams}
        return own | self.sensors._asdict() | self.floors.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another core with the same options."""
        for name, array in self._own_arrays().items():
            array[...] = saved[name]
        self.floors.restore()
        self.estimator.load_arrays(saved)
        for world in range(self.worlds):
            pose = self.physics.poses[world, 0].tolist()
            self.physics.place(world, self.plans[int(self.plan[world])], [(pose[0], pose[1], pose[2])])
        self.bumper.feel(self.physics.poses, self.plan, self.sensors, 0, self.worlds)
