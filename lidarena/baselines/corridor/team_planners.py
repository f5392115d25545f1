"""Planned fleets: the methods of Bennewitz & Burgard as policies that execute their plans in the world, in time."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, TeamError
from lidarena.baselines.corridor.deviation_model import DeviationModel, shipped_model
from lidarena.baselines.corridor.robot_interface import Fleet, FleetState
from lidarena.baselines.corridor.team_driving import ClockDriving, centred
from lidarena.baselines.corridor.wall_fitting import WallTracker
from lidarena.baselines.registry import register
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.envs.corridor.starts_and_goals import CELL
from lidarena.planning.grid.inflation import clearance
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.plan import Method, plan_team
from lidarena.planning.team.team_plan import TeamPlan

_SPARE = (0.05, 0.02, 0.012, 0.0)
"""Room beside the robots that discs have where larger ones do not fit [m]."""
_LEAST_SPARE = 0.045
"""Room beside a robot, in truth, in the cells that it is planned through where there are others [m]."""
ROOM = 0.2
"""Robots are planned as discs of at least this radius [m]."""
_KEEPS_UP = 0.4
"""Robots that are slower than this take as much longer for a step of the plan [m/s]."""
_CAREFUL = 2.5
"""Cells that are smaller because corridors are narrow take so many times their share of a step's time."""
_COMFORT, _WALL_COST = 0.5, 1.0
"""Cells nearer to a wall than this [m] cost more, right at the wall so many steps: the blurred P(occ)."""


def wall_costs(grid: FloorGrid) -> NDArray[np.float64]:
    """Return what being in a cell costs besides the step, (rows, cols) in steps: more beside walls."""
    if grid.clearance is not None:  # in narrow corridors the middle counts, not which cells their walls touch
        return np.asarray(_WALL_COST * np.clip(1.0 - grid.clearance.astype(np.float64) / _COMFORT, 0.0, 1.0))
    occupancy = np.where(grid.blocked, 100, 0).astype(np.int8)
    away = clearance(occupancy, grid.resolution, reach=_COMFORT + grid.resolution).astype(np.float64)
    return _WALL_COST * np.clip(1.0 - away / _COMFORT, 0.0, 1.0)


class PlannedFleet:
    """Plans once, when an episode begins, and drives by the clock.

    Args:
        env: The fleet's environment, or what wraps it.
        planning_radius: How much room a robot is given [m]; None: what its own radius needs.
        step: The time that a move from one place to the next is given [s].
        time_limit: How long planning may take [s].

    Raises:
        ConfigError: A number is out of range.

    Attributes:
        finished: Whether there is no plan to drive by; ``message`` says why.
        message: What the planner has to say of its plan.
        plan: The last plan, None before the first action of an episode.
    """

    method: Method = "independent_astar"
    needs_solution = True
    attempts: tuple[tuple[bool, bool], ...] = ((True, True), (False, True))
    """Until there is a plan: whether to keep to cells with room in truth; whether to keep off walls where one can."""

    def __init__(self, env: Any, planning_radius: float | None, step: float, time_limit: float) -> None:
        self.fleet = Fleet(env)
        self.radius = max(ROOM, self.fleet.radius + 0.05) if planning_radius is None else planning_radius
        if not self.fleet.radius <= self.radius <= 2.0:
            raise ConfigError(
                f"planning_radius = {self.radius} m is out of range; from the robots' own {self.fleet.radius} to 2 m"
            )
        if not 0.1 <= step <= 10.0:
            raise ConfigError(f"step = {step} s is out of range; a number from 0.1 to 10 is allowed")
        if not 0.0 < time_limit <= 3600.0:
            raise ConfigError(f"time_limit = {time_limit} s is out of range; more than 0 and at most 3600 is allowed")
        self.step = step * max(1.0, _KEEPS_UP / self.fleet.robot.max_speed)
        self.time_limit, self._wanted_radius = time_limit, self.radius
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; ``seed`` is of the planner's random choices."""
        self.fleet.begin()
        self._tracker = WallTracker(self.fleet)
        self.seed = 0 if seed is None else seed
        self.finished, self.message = False, ""
        self.radius, self._keeps_spare, self._keeps_off_walls = self._wanted_radius, True, True
        self.plan: TeamPlan | None = None

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the team's next actions."""
        state = self.fleet.read(info)
        if self.plan is None:
            self.grid = self.fleet.grid(info)
        state = self._tracker.look(state, info, self.grid)
        if self.plan is None:
            self.plan = self._plan_or_say_why(state, self.grid)
            self.message = self.plan.message
            pathless = not all(len(path) for path in self.plan.paths)
            self.finished = not self.plan.solved and (self.needs_solution or pathless)
            if not self.finished:
                self.begin_driving()
            elif self.fleet.drawn:
                self.fleet.show(TeamSketch(note=self.message))
        if self.finished:
            return self.fleet.actions(np.zeros((self.fleet.robots, 2)), state)
        commands = self.drive(state, info)
        self._tracker.drive(commands)
        return self.fleet.actions(commands, state)

    def _plan_or_say_why(self, state: FleetState, grid: FloorGrid) -> TeamPlan:
        """Plan, for smaller discs where the team has no room for the wanted ones; without any, the message says so."""
        plan: TeamPlan | None = None
        for attempt in self.attempts:
            self._keeps_spare, self._keeps_off_walls = attempt
            for spare in (math.inf, *_SPARE):
                self.radius = min(self._wanted_radius, self.fleet.radius + spare)
                try:
                    plan = self.plan_from(state, grid)
                except TeamError as error:
                    refusal = error
                    continue
                if plan.solved or not self.needs_solution:
                    return plan
                break
        if plan is not None:
            return plan
        self.radius = self._wanted_radius
        return self._refused(grid, refusal)

    def _refused(self, grid: FloorGrid, error: TeamError) -> TeamPlan:
        paths = [np.empty((0, 2), np.int64)] * self.fleet.robots
        discs = f"discs of radius {self.radius:g} m, nor for smaller ones down to {self.fleet.radius:g} m,"
        words = f"Nothing was planned for {discs} in cells of {grid.resolution:g} m: {error}."
        return TeamPlan(False, paths, math.inf, 0.0, False, words)

    def plan_from(self, state: FleetState, grid: FloorGrid) -> TeamPlan:
        """Plan from where the robots are."""
        self.grid, graph = grid, self.graph_of(grid, state, self.radius)
        ends = grid.standing(state.poses[:, :2], graph), grid.standing(state.goals, graph)
        return plan_team(
            graph, *ends, self.method, time_limit=self.time_limit, seed=self.seed, **self.extras(grid)
        )  # fmt: skip

    def graph_of(
        self, grid: FloorGrid, state: FleetState, radius: float, taken: NDArray[np.bool_] | None = None
    ) -> GridGraph:
        """Where robots are planned: not where a wall reaches nearer into a cell than they can be sure to drive by.

        Where there is no way but such, it stays open.

        Args:
            grid: The cells.
            state: The team; where it stands and goes stays open.
            radius: Of the discs that are planned for [m].
            taken: (rows, cols) cells that are blocked besides; None = none.
        """
        if grid.away is None or not self._keeps_spare:
            return grid.graph(radius, taken)
        closed = grid.away < self.fleet.radius + min(_LEAST_SPARE, radius - self.fleet.radius)
        for points in (state.poses[:, :2], state.goals):
            closed[tuple(grid.cells(points).T)] = False
        return grid.graph(radius, taken, closed)

    def extras(self, grid: FloorGrid) -> dict[str, Any]:
        """What else the planner is told."""
        return {"cell_costs": wall_costs(grid)} if self._keeps_off_walls else {}

    def begin_driving(self) -> None:
        """Take up a new plan."""
        assert self.plan is not None
        curves, room = centred(self.plan.paths, self.grid, self.fleet.radius)
        pace = self.step if room is None else self.step * _CAREFUL * self.grid.resolution / CELL
        self.driving = ClockDriving(curves, pace, narrow=room is not None)

    def drive(self, state: FleetState, info: dict[str, Any]) -> NDArray[np.float64]:
        """Commands (k, 2) for now."""
        if self.fleet.drawn:
            curves = {robot: self.driving.remaining(robot, state) for robot in np.flatnonzero(state.active).tolist()}
            self.fleet.show(TeamSketch(curves, self._meetings(state), (), self.message))
        return self.driving.commands(state)

    def _meetings(self, state: FleetState) -> NDArray[np.float64]:
        """Where planned positions come too close from now on, (n, 2) [m]."""
        curves = self.driving.curves
        longest = max(len(curve) for curve in curves)
        table = np.stack([np.pad(curve, ((0, longest - len(curve)), (0, 0)), "edge") for curve in curves])
        ahead = table[:, min(int(state.time / self.driving.step), longest - 1) :]
        gaps = ahead[:, None] - ahead[None]
        near = np.triu((gaps**2).sum(axis=-1).transpose(2, 0, 1) < (2 * self.radius - 1e-6) ** 2, 1)
        times, one, other = np.nonzero(near)
        points: NDArray[np.float64] = 0.5 * (ahead[one, times] + ahead[other, times])
        return points


@register("independent_astar", family="corridor")
class IndependentFleet(PlannedFleet):
    """Every robot takes its own shortest way, as if it were alone."""

    needs_solution = False

    def __init__(self, env: Any, *, planning_radius: float | None = None, step: float = 0.8) -> None:
        """Make it for an environment of the corridor family.

        Args:
            env: A ``corridor_v0.parallel_env`` or ``lidarena/CorridorCentral-v0``.
            planning_radius: Of the discs that are planned for [m]; None leaves some room beside the robots.
            step: How long a step of the plan, a cell of 0.2 m, takes a robot of 0.4 m/s or more [s]; a slower one
                takes as much longer.

        Raises:
            ConfigError: An option is out of range.
        """
        super().__init__(env, planning_radius, step, 1.0)


@register("prioritized_astar", family="corridor")
class PrioritizedFleet(PlannedFleet):
    """Bennewitz & Burgard's method: longest way first; who conflicts is replanned, off where others may deviate."""

    method: Method = "prioritized_astar"

    def __init__(
        self,
        env: Any,
        *,
        deviation: bool = True,
        model: DeviationModel | None = None,
        planning_radius: float | None = None,
        step: float = 0.8,
    ) -> None:
        """Make it for an environment of the corridor family.

        Args:
            env: A ``corridor_v0.parallel_env`` or ``lidarena/CorridorCentral-v0``.
            deviation: Whether the model of how robots deviate from their plans is used.
            model: That model; None takes the one that comes with the package.
            planning_radius: Of the discs that are planned for [m]; None leaves some room beside the robots.
            step: How long a step of the plan, a cell of 0.2 m, takes a robot of 0.4 m/s or more [s]; a slower one
                takes as much longer.

        Raises:
            ConfigError: An option is out of range.
        """
        self._model = (model or shipped_model()) if deviation else None
        super().__init__(env, planning_radius, step, 1.0)

    def extras(self, grid: FloorGrid) -> dict[str, Any]:
        """Wall costs, and what it costs to be near where others are planned to be."""
        if self._model is None:
            return super().extras(grid)
        return super().extras(grid) | {"deviation": self._model.costs(grid.resolution, 2.0 * self.fleet.radius)}


@register("coordination", family="corridor")
class CoordinatedFleet(PlannedFleet):
    """The coordination diagram: robots keep to their own shortest paths and choose when to go and when to wait."""

    method: Method = "coordination"

    def __init__(self, env: Any, *, planning_radius: float | None = None, step: float = 0.8) -> None:
        """Make it for an environment of the corridor family; options as ``independent_astar``'s.

        Raises:
            ConfigError: An option is out of range.
        """
        super().__init__(env, planning_radius, step, 1.0)

    def extras(self, grid: FloorGrid) -> dict[str, Any]:
        """Nothing: the method counts steps alone."""
        return {}


@register("joint_astar", family="corridor")
class JointFleet(CoordinatedFleet):
    """The joint optimum of two robots."""

    method: Method = "joint_astar"

    def __init__(
        self, env: Any, *, planning_radius: float | None = None, step: float = 0.8, time_limit: float = 30.0
    ) -> None:
        """Make it for an environment of the corridor family with two robots.

        Args:
            env: A ``corridor_v0.parallel_env`` or ``lidarena/CorridorCentral-v0``.
            planning_radius: Of the discs that are planned for [m]; None leaves some room beside the robots.
            step: How long a step of the plan, a cell of 0.2 m, takes a robot of 0.4 m/s or more [s]; a slower one
                takes as much longer.
            time_limit: A million states each second [s].

        Raises:
            ConfigError: An option is out of range, or there are not two robots.
        """
        PlannedFleet.__init__(self, env, planning_radius, step, time_limit)
        if self.fleet.robots != 2:
            raise ConfigError(f"baseline 'joint_astar' drives 2 robots, not {self.fleet.robots}")
