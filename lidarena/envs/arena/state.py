"""The arena worlds themselves, batched: physics, lidar, bookkeeping; no spaces, rewards or episodes."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.envs.arena.guard import guard_turns
from lidarena.envs.arena.kernels import Measurements, sense, turn_and_sweep, way_gap
from lidarena.envs.arena.known_way import Knowledge, Moves, learn, no_ways
from lidarena.envs.arena.moving import (
    KINDS,
    choose_velocities,
    drive_moving,
    meet_moving,
    moving_obstacles,
    place_moving,
)
from lidarena.envs.arena.options import ArenaOptions, OwnSize
from lidarena.envs.arena.scan_tracks import no_tracks
from lidarena.envs.arena.scenarios import Scenario, ScenarioGenerator, vicinity
from lidarena.envs.arena.seen_map import empty_maps, forget
from lidarena.planning.grid.known_ways import search_space
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Scanner, first_scan
from lidarena.world.map_geometry import MapGeometry
from lidarena.world.physics import Physics
from lidarena.world.robots import RobotSpec

_MARGIN = 1e-3
"""Room beside the way below which the solver is asked whether the robot touches [m in a 100 m room]."""


class ArenaCore:
    """``worlds`` arenas with one robot each, stepped together.

    World ``i`` depends on nothing but its own generator and actions.

    Args:
        worlds: Number of worlds.
        options: Checked keywords.

    Attributes:
        options: The keywords, with robot, lidar, periods and distances made out for these arenas.
        robot: The robots, see ``ArenaOptions``.
        beam: Their lidars.
        physics: Poses and contacts.
        moving: Obstacles that move.
        scenarios: The arena of each world.
        measurements: What is measured of it.
        known: What the robots have made of their scans; None unless they keep a map, see ``ArenaOptions.keeps_map``.
        step_length: Driven in a decision period [m].
        goal_radius: The goal is reached from this distance on [m].
        side: Side of the room to which everything is to scale [m].
        goals: (worlds, 2) [m].
        drawn: (worlds, 2) entry and number of each world's arena.
        turns: (worlds,) of the last step [rad].

    Raises:
        MapError: See ``ScenarioGenerator``.
        ConfigError: See there.
    """

    def __init__(self, worlds: int, options: ArenaOptions) -> None:
        radius = None if isinstance(options.robot, OwnSize) else options.robot.radius
        self.worlds, self.generator = worlds, ScenarioGenerator(options, radius)
        scale = self.generator.scale
        self.options = options.at_scale(scale, self.generator.radius)
        self.robot, self.beam = self.options.robot, self.options.lidar
        self.side = 100.0 * scale
        self.period, self.goal_radius = self.options.decision_period or scale, self.options.goal_radius or scale
        self.step_length = self.robot.max_speed * self.period
        self.physics = Physics(worlds)
        self.moving = moving_obstacles(worlds, options.moving, scale)
        self._bodies: dict[float, RobotSpec] = {}
        self.directions = self.beam.directions
        self._allocate()

    def _allocate(self) -> None:
        worlds, beams = self.worlds, self.beam.beams
        self.scenarios: list[Scenario | None] = [None] * worlds
        self.circles = np.empty(worlds, object)
        self.bounds = np.zeros((worlds, 4))
        self.optimal_time = np.zeros(worlds)
        self.goals = np.zeros((worlds, 2))
        self.radii = np.zeros(worlds)
        self.drawn = np.zeros((worlds, 2), np.int64)
        self.streams = np.zeros((worlds, 4), np.uint64)
        self.turns = np.zeros(worlds)
        self.measurements = Measurements(
            np.zeros((worlds, 1, beams)),
            np.zeros((worlds, 1, beams), np.float32),
            np.zeros(worlds),
            np.zeros(worlds),
            np.zeros(worlds),
            np.zeros(worlds),
        )
        self._near = np.zeros(worlds, np.bool_)
        self.known: Knowledge | None = None
        if self.options.keeps_map:
            seen = empty_maps(worlds)
            self.known = Knowledge(seen, no_tracks(worlds, beams), no_ways(worlds), search_space(seen.cost.shape[1]))
        self._slots(0, 0)

    def _slots(self, edges: int, circles: int) -> None:
        """Make room for so many edges and circles in each world: a plan of a single tile each."""
        worlds = self.worlds
        self._room = (edges, circles)
        self.geometry = MapGeometry(
            edges=np.zeros((worlds * edges, 4)),
            circles=np.zeros((worlds * circles, 3)),
            first_tile=2 * np.arange(worlds),  # every other "tile" is what a world leaves free of its room
            tile_origin=np.zeros((worlds, 2)),
            tile_shape=np.ones((worlds, 2), np.int64),
            tile_start=np.repeat(np.arange(worlds) * (edges + circles), 2),
            items=np.zeros(worlds * (edges + circles), np.int32),
        )
        self._scanner = Scanner(self.beam, self.geometry, self.directions, np.arange(worlds))
        for world, scenario in enumerate(self.scenarios):
            if scenario is not None:
                self._furnish(world, scenario)

    def _furnish(self, world: int, scenario: Scenario) -> None:
        """Write a scenario's edges and circles into a world's room in the geometry."""
        edges, circles = scenario.plan.edges, scenario.plan.circles
        if len(edges) > self._room[0] or len(circles) > self._room[1]:
            self._slots(max(len(edges), self._room[0]), max(2 * len(circles), self._room[1]))
        most_edges, most_circles = self._room
        geometry, first = self.geometry, world * (most_edges + most_circles)
        geometry.edges[world * most_edges :][: len(edges)] = edges
        geometry.circles[world * most_circles :][: len(circles)] = circles
        items = geometry.items[first:]
        items[: len(edges)] = world * most_edges + np.arange(len(edges))
        circle_items = len(geometry.edges) + world * most_circles + np.arange(len(circles))
        items[len(edges) : len(edges) + len(circles)] = circle_items
        geometry.tile_start[2 * world + 1] = first + len(edges) + len(circles)

    def reset_world(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        """Begin a new episode in one world.

        Args:
            world: Which one.
            rng: Its generator; everything random is drawn from it.
            seed: That it was reset with, if it was.
        """
        self.drawn[world] = self.generator.draw(rng, seed)
        self.streams[world] = seed_stream(rng)
        self._take_scenario(world)
        scenario = self.scenarios[world]
        assert scenario is not None
        self._place(world, scenario.plan, scenario.plan.start)
        if self.moving.number:
            self._place_moving(world, rng)
        self.turns[world] = 0.0
        self.measurements.path_length[world] = 0.0
        self.measurements.since_scan[world] = first_scan(self.period, self.beam)
        if self.known is not None:
            forget(world, self.bounds[world], float(self.radii[world]), self.known.seen)
            self.known.tracks.discs[world], self.known.ways.number[world] = 0.0, 0
        self._sense(self.physics.poses, world, world + 1)
        if self.known is not None:
            self.known.ways.approach[world] = 0.0
        x, y = scenario.arena.start
        self.measurements.gap[world] = way_gap(x, y, x, y, world, self.geometry) - self.radii[world]

    def _place_moving(self, world: int, rng: np.random.Generator) -> None:
        """Draw one world's moving obstacles."""
        spec, moving = self.options.moving, self.moving
        moving.streams[world] = seed_stream(rng)
        least, most = spec.numbers
        moving.counts[world] = least if least == most else rng.integers(least, most + 1)
        mixed = spec.kind == "mixed"
        moving.kinds[world] = rng.integers(len(KINDS) - 1, size=moving.number) if mixed else KINDS.index(spec.kind)
        start, keep = self.physics.poses[world, 0, :2], 3.0 * self.step_length
        keep += float(self.radii[world] + moving.radius[0])
        bounds = self.bounds[world]
        place_moving(world, start, self.goals[world], keep, *spec.speeds, bounds, self.geometry, moving)

    def _take_scenario(self, world: int) -> None:
        scenario = self.generator.scenario(*self.drawn[world].tolist())
        if scenario is self.scenarios[world]:
            return
        self.scenarios[world] = scenario
        self.circles[world] = scenario.arena.circles
        self.bounds[world], self.goals[world] = scenario.arena.bounds, scenario.arena.goal
        self.radii[world], self.optimal_time[world] = scenario.arena.robot_radius, scenario.optimal_time
        self._furnish(world, scenario)

    def _place(self, world: int, plan: Floorplan, pose: tuple[float, float, float]) -> None:
        # half a radius a step: no body passes through another between two looks of the solver
        radius = float(self.radii[world])
        if radius not in self._bodies:
            smallest = self.robot.inner_radius if self.robot.outline else radius
            substep = min(0.5 * smallest / self.robot.max_speed, 0.25 * self.period)
            self._bodies[radius] = replace(self.robot, radius=radius, substep=substep)
        self.physics.place(world, plan, [pose], self._bodies[radius])

    def _meet(self, world: int) -> None:
        """Give the solver only the obstacles that a robot can reach in a step, so that it has few to check."""
        scenario = self.scenarios[world]
        assert scenario is not None
        x, y, theta = self.physics.poses[world, 0].tolist()
        self._place(
            world, vicinity(scenario.plan, x, y, 1.1 * self.step_length + 1.1 * float(self.radii[world])), (x, y, theta)
        )
        self.physics.movers[world] = self.moving.discs(world) if self.moving.number else None

    def step(self, turns: NDArray[np.float64]) -> None:
        """Turn every robot by ``turns`` (worlds,) to the left [rad] unless guarded, and drive for a period."""
        poses, margin = self.physics.poses, _MARGIN * self.generator.scale
        before = poses.copy()
        if self.options.guard and self.known is not None:
            turns = turns.copy()
            guard_turns(self.known.ways.free, turns)
        self.turns = turns
        turn_and_sweep(
            turns, self.step_length, margin, self.geometry, self.radii, poses, self.measurements.gap, self._near
        )
        if self.moving.number:
            choose_velocities(self.period, poses, self.radii, self.bounds, self.geometry, self.moving)
            gap = self.measurements.gap
            meet_moving(self.period, self.step_length, margin, poses, self.radii, self.moving, gap, self._near)
        for world in self._near.nonzero()[0].tolist():
            self._meet(world)
        commands = np.zeros((self.worlds, 1, 2))
        commands[:, 0, 0] = self.robot.max_speed
        self.physics.advance(commands, self.period, self._near)
        if self.moving.number:
            drive_moving(self.period, self.moving)
        self._judge()
        self._sense(before, 0, self.worlds)

    def _judge(self) -> None:
        """Tell who has collided, also without contact, and how near everybody has come."""
        gap, touched = self.measurements.gap, self.physics.touched
        if self.robot.collision_distance is not None:
            touched |= gap < self.robot.collision_distance - self.radii
        if self.robot.outline:  # corners may be away from what is inside of the circle about them
            np.maximum(gap, 0.0, out=gap)
        gap[self.physics.touched] = 0.0

    def _sense(self, before: NDArray[np.float64], first: int, last: int) -> None:
        waited = self.measurements.since_scan + self.period
        sense(
            first, last, before, self.physics.poses, self.goals, self.period, self._scanner, self.streams,
            self.moving.states, self.moving.counts, float(self.moving.radius[0]), self.measurements,
        )  # fmt: skip
        if self.known is not None:
            fresh = waited >= 1.0 / self.beam.rate - 1e-9  # as ``scan_is_due`` has it
            decisions = max(1.0 / (self.beam.rate * self.period), 1.0)
            learn(first, last, self._moves(before, fresh, decisions), self.known)

    def _moves(self, before: NDArray[np.float64], fresh: NDArray[np.bool_], decisions: float) -> Moves:
        return Moves(
            before, self.physics.poses, self.goals, self.radii, self.measurements.scans, fresh, self.step_length,
            decisions, self.directions, self.beam,
        )  # fmt: skip

    @property
    def approaches(self) -> NDArray[np.float64]:
        """What each robot came nearer to its lookahead point in the last step (worlds,) [m]; 0 without a map."""
        return np.zeros(self.worlds) if self.known is None else self.known.ways.approach

    @property
    def approach(self) -> float:
        """Clearance below which the reward's term of that name counts [m]."""
        return 2.0 * self.step_length

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Every array that makes up the worlds' state, by name; ``load_arrays`` writes them back."""
        own = {"poses": self.physics.poses, "drawn": self.drawn, "streams": self.streams, "turns": self.turns}
        if self.moving.number:
            own |= {f"moving.{name}": array for name, array in self.moving._asdict().items()}
        if self.known is not None:
            kept = (("map", self.known.seen), ("tracks", self.known.tracks), ("way", self.known.ways))
            own |= {f"{part}.{name}": array for part, arrays in kept for name, array in arrays._asdict().items()}
        return own | {"touched": self.physics.touched} | self.measurements._asdict()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another core with the same options."""
        self.drawn[:] = saved["drawn"]
        for world in range(self.worlds):
            self._take_scenario(world)
        for name, array in self.arrays().items():
            array[...] = saved[name]
