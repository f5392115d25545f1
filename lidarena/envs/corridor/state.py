"""The multi-robot worlds themselves, batched: physics, sensors, ways; no spaces, rewards or episodes."""

from collections import OrderedDict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.envs.corridor.guard import guard_speeds
from lidarena.envs.corridor.kernels import (
    Ground,
    MotionNoise,
    TeamMeasurements,
    TeamMotion,
    Ways,
    apply_motion_noise,
    distance_to_goal,
    find_near,
    sense,
)
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.envs.corridor.starts_and_goals import StartGoalSampler
from lidarena.envs.worker_threads import on_threads
from lidarena.planning.grid.grid_search import path_costs
from lidarena.world.lidar import Lidar, Scanner, first_scan
from lidarena.world.load import load_floorplan
from lidarena.world.team_physics import TeamPhysics

_FINE = 0.05
"""Cells in which clearances are looked up [m]."""
_KEPT_FIELDS = 1024
_WALL_GAP = 0.03
"""Ways keep so much more than the radius from walls [m]."""
_COMFORT, _WALL_COST = 0.4, 1.5
"""Nearer to a wall than this [m] a way is dearer, right beside it by so many times its length."""


class CorridorCore:
    """``worlds`` teams of robots, stepped together.

    World ``i`` depends on nothing but its own generator and commands: not on the other worlds, nor on their number, nor
    on the number of threads.

    Args:
        worlds: Number of worlds.
        options: Checked keywords.

    Attributes:
        plan: The floor plan.
        physics: The true poses; everything that robots may know is in ``measurements`` and ``goals``.
        measurements: What the robots know.
        goals: (worlds, robots, 2) [m].
        starts: (worlds, robots, 2) [m].
        places: Where episodes begin and end.
        travelled: (worlds, robots) lengths of the true paths [m].
    """

    def __init__(self, worlds: int, options: CorridorOptions) -> None:
        self.options, self.worlds, self.robots = options, worlds, options.robots
        self.plan = load_floorplan(options.map)
        self.places = StartGoalSampler(options, self.plan)
        self.robot, self.beam = options.robot, options.lidar
        self.lidar = Lidar([self.plan], self.beam)
        self.physics = TeamPhysics(worlds, self.robots, self.robot)
        for world in range(worlds):
            self.physics.furnish(world, self.plan)
        self._noise = MotionNoise().scaled(options.motion_noise)
        self._lay_ground()
        self._allocate()

    def _lay_ground(self) -> None:
        fine = self.plan.raster(_FINE)
        clearance = np.where(fine.solid, -fine.clearance, fine.clearance).astype(np.float32)
        grid = self.places.grid
        self.ground = Ground(clearance, fine.origin.copy(), _FINE, np.array(grid.origin), grid.resolution)
        coarse = self.plan.raster(grid.resolution)
        beyond = coarse.clearance.astype(np.float64) - self.robot.radius
        cost = 1.0 + _WALL_COST * np.clip(1.0 - beyond / _COMFORT, 0.0, 1.0)
        self._costs = np.where(grid.blocked | (beyond < _WALL_GAP), np.inf, cost)
        fitting = grid.graph(self.robot.radius).index >= 0
        self._tight_costs = np.where(fitting | np.isfinite(self._costs), cost, np.inf)
        self._known: OrderedDict[tuple[int, int, bool], NDArray[np.float32]] = OrderedDict()

    def _allocate(self) -> None:
        shape = (self.worlds, self.robots)
        self._scanner = Scanner(self.beam, self.lidar.geometry, self.lidar.directions, np.zeros(self.worlds, np.int64))
        self._corners = self.robot.corners
        self.streams = np.zeros((self.worlds, 4), np.uint64)
        self._goal_streams = np.zeros((self.worlds, 4), np.uint64)
        self.goals, self.starts = np.zeros((*shape, 2)), np.zeros((*shape, 2))
        self.fields = np.zeros((*shape, *self._costs.shape), np.float32)
        self._ways = Ways(self.ground, self.fields, self.goals)
        self._speed_bias, self._stalled = np.zeros(shape), np.zeros(shape)
        self._near = np.zeros(shape, np.bool_)
        self.travelled = np.zeros(shape)
        beams = self.beam.beams
        self.measurements = TeamMeasurements(
            np.zeros((*shape, beams)),
            np.zeros((*shape, beams), np.float32),
            np.zeros((*shape, 3)),
            np.zeros((*shape, 2)),
            np.zeros(shape),
            np.zeros((*shape, 2)),
            np.zeros(shape),
            np.zeros(self.worlds),
        )

    def reset_world(self, world: int, rng: np.random.Generator) -> None:
        """Begin a new episode in one world; everything random is drawn from ``rng``."""
        starts, goals = self.places.draw(rng)
        self.starts[world], self.goals[world] = starts, goals
        self.streams[world] = seed_stream(rng)
        if self.options.lifelong:
            self._goal_streams[world] = seed_stream(rng)
        self.measurements.since_scan[world] = first_scan(self.options.decision_period, self.beam)
        self._speed_bias[world] = self._noise.speed_bias * rng.standard_normal(self.robots)
        self._stalled[world] = self.travelled[world] = 0.0
        self._look_up_ways(world)
        self.physics.poses[world, :, :2] = starts
        self.measurements.remaining[world] = np.hypot(*(goals - starts).T)
        for robot in range(self.robots):
            x, y = starts[robot].tolist()
            lookahead_point = self.measurements.lookahead_point[world, robot]
            distance_to_goal(self.fields[world, robot], goals[robot], x, y, self.ground, 1e6, lookahead_point)
            self.physics.poses[world, robot, 2] = np.arctan2(lookahead_point[1] - y, lookahead_point[0] - x)
        self._perceive(self.physics.poses, world, world + 1)

    def renew_goal(self, world: int, robot: int) -> None:
        """Give a robot that has reached its goal another one, and tell it how far that is."""
        stream, goals = self._goal_streams[world], self.goals[world]
        goals[robot] = self.places.draw_goal(goals, robot, stream)
        here = self.physics.poses[world, robot, :2]
        self._look_up_way(world, robot, here)
        (x, y), lookahead_point = here.tolist(), self.measurements.lookahead_point[world, robot]
        left = distance_to_goal(self.fields[world, robot], goals[robot], x, y, self.ground, 1e6, lookahead_point)
        self.measurements.remaining[world, robot] = left

    def _look_up_ways(self, world: int) -> None:
        for robot in range(self.robots):
            self._look_up_way(world, robot, self.starts[world, robot])

    def _look_up_way(self, world: int, robot: int, start: NDArray[np.float64]) -> None:
        goal, (x, y) = self.goals[world, robot], start.tolist()
        row, col = self.places.grid.cells(goal)[0].tolist()
        self.fields[world, robot] = self._field((row, col))
        if distance_to_goal(self.fields[world, robot], goal, x, y, self.ground, np.inf, np.empty(2)) == np.inf:
            self.fields[world, robot] = self._field((row, col), tight=True)

    def _field(self, cell: tuple[int, int], tight: bool = False) -> NDArray[np.float32]:
        """Lengths of the ways from everywhere to a cell [m], 1e9 where there is none.

        ``tight``: through whatever a robot just fits through, for those whom the room beside the walls leaves no way.
        """
        key = (*cell, tight)
        if key not in self._known:
            costs = self._tight_costs if tight else self._costs
            lengths = path_costs(costs, cell) * self.places.grid.resolution
            self._known[key] = np.where(np.isfinite(lengths), lengths, 1e9).astype(np.float32)
            if len(self._known) > _KEPT_FIELDS:
                self._known.popitem(last=False)
        return self._known[key]

    def step(self, commands: NDArray[np.float64]) -> None:
        """Drive every robot for one decision period.

        Args:
            commands: (worlds, robots, 2) speed [m/s] and turn rate [rad/s]; changed into what the wheels do, after the
                guard's say where there is one.
        """
        before, period = self.physics.poses.copy(), self.options.decision_period
        if self.options.guard:
            scans, reach, turn = self.measurements.scans, self.beam.max_range, 0.5 * self.robot.max_turn_rate
            guard_speeds(scans, self.lidar.directions, reach, self.robot.radius, period, turn, commands)
        apply_motion_noise(
            commands, period, self._noise, self.options.stall_rate, self.streams, self._speed_bias, self._stalled
        )
        find_near(commands, period, self.robot.radius, bool(self.robot.outline), before, self.ground, self._near)
        self.physics.advance(commands, period, self._near)
        self.travelled += lengths((self.physics.poses - before)[..., :2])
        self._perceive(before, 0, self.worlds)

    @property
    def touching(self) -> NDArray[np.bool_]:
        """(worlds, robots) whether a robot has touched something in the last step, or come nearer than it may."""
        touching: NDArray[np.bool_] = self.physics.touched_wall | self.physics.touched_robot
        if self.robot.collision_distance is not None:
            touching |= self.measurements.ranges.min(axis=2) < self.robot.collision_distance
        return touching

    def _perceive(self, before: NDArray[np.float64], first: int, last: int) -> None:
        """Let the robots of worlds first … last - 1 sense."""
        counter, options = np.array([first]), self.options
        motion = TeamMotion(
            before, self.physics.poses, self.streams, options.localization_noise, options.decision_period
        )
        arguments = (motion, self.robot.radius, self._corners, self._scanner, self._ways, self.measurements)
        on_threads(last - first, lambda _: sense(counter, last, *arguments))

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Every array that makes up the worlds' state, by name."""
        named: dict[str, NDArray[Any]] = {"poses": self.physics.poses, "streams": self.streams, "goals": self.goals}
        named |= {
            "starts": self.starts,
            "speed_bias": self._speed_bias,
            "stalled": self._stalled,
            "travelled": self.travelled,
        }
        if self.options.lifelong:
            named["goal_streams"] = self._goal_streams
        named |= {"touched_wall": self.physics.touched_wall, "touched_robot": self.physics.touched_robot}
        return named | {f"measurements.{name}": array for name, array in self.measurements._asdict().items()}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another core with the same options."""
        for name, array in self.arrays().items():
            array[...] = saved[name]
        for world in range(self.worlds):
            self._look_up_ways(world)


def lengths(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Lengths (…) of vectors (…, 2)."""
    made: NDArray[np.float64] = np.sqrt(vectors[..., 0] ** 2 + vectors[..., 1] ** 2)
    return made
