"""Prioritized search in the world: the plan's order is kept, robots that are late or blocked are planned around."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import TeamError
from lidarena.baselines.corridor.robot_interface import FleetState
from lidarena.baselines.corridor.team_driving import OrderedDriving, centred
from lidarena.baselines.corridor.team_planners import PlannedFleet, wall_costs
from lidarena.baselines.registry import register
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.plan import Method, plan_team
from lidarena.planning.team.precedence import Precedence
from lidarena.planning.team.team_plan import TeamPlan

_HELD_UP = 3.0  # a robot that may go on but has not moved for so long is held up (s)
_DEADLOCK = 8.0  # if nobody has completed a step for so long, nobody will (s)
_REST = 2.0  # least time between two plans (s)
_ASIDE = 0.2  # a robot that stops farther than this from its goal is planned around, where it really is (m)
_MOVED = 0.06  # less is no motion: localisation jitters (m)
_SQUEEZE = (1.0, 0.75, 0.55)  # shares of the planning radius, where robots stand too close for the whole


def block_disc(blocked: NDArray[np.bool_], grid: FloorGrid, place: NDArray[np.float64], radius: float) -> None:
    """Block the cells (rows, cols) that a robot at x, y [m] covers: its own and those whose centre is in it."""
    row, col = grid.cells(place)[0]
    blocked[row, col] = True
    reach = math.ceil(radius / grid.resolution)
    rows, cols = np.mgrid[row - reach : row + reach + 1, col - reach : col + reach + 1].reshape(2, -1)
    inside = (rows >= 0) & (cols >= 0) & (rows < blocked.shape[0]) & (cols < blocked.shape[1])
    around = np.stack([rows, cols], axis=1)[inside]
    covered = around[np.hypot(*(grid.points(around) - place).T) < radius]
    blocked[covered[:, 0], covered[:, 1]] = True


@register("prioritized_search", family="corridor")
class SearchingFleet(PlannedFleet):
    """Looks for a good order of priority and repairs the plan; drives in the plan's order rather than by the clock.

    A robot begins a step when everybody who is to pass there first has done so, so that nobody's being late leads to a
    collision. When robots wait for one that is held up, or for one that has come to a stand for good, and when
    nobody has moved on for a while (a deadlock), the team is replanned from where it stands.

    Attributes:
        replans: How often the team was replanned in this episode.
    """

    method: Method = "prioritized_search"
    # where costs do not count, safe intervals do for a search, which then is many times faster
    attempts = ((True, True), (True, False), (False, True), (False, False))

    def __init__(
        self,
        env: Any,
        *,
        replan: bool = True,
        iterations: int = 200,
        planning_radius: float | None = None,
        time_limit: float = 1.0,
    ) -> None:
        """Make it for an environment of the corridor family.

        Args:
            env: A ``corridor_v0.parallel_env`` or ``lidarena/CorridorCentral-v0``.
            replan: Whether the team may be replanned on its way.
            iterations: Greatest number of orders and of neighbourhoods that a plan may take.
            planning_radius: Of the discs that are planned for [m]; None leaves some room beside the robots.
            time_limit: Of a plan [s].

        Raises:
            ConfigError: An option is out of range.
        """
        self.may_replan, self.iterations = replan, iterations
        super().__init__(env, planning_radius, 0.8, time_limit)

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; ``seed`` is of the planner's random choices."""
        super().reset(seed)
        self.replans = 0
        self._planned_at = 0.0
        robots = self.fleet.robots
        self._anchor = np.full((robots, 3), np.inf)  # where each robot was when it last moved
        self._moved_at, self._stepped_at = np.zeros(robots), 0.0
        self._around = np.zeros(robots, np.bool_)  # who was planned around
        self._placed = np.zeros(robots, np.bool_)  # who arrived beside its goal, and was planned around since

    def extras(self, grid: FloorGrid) -> dict[str, Any]:
        """Wall costs, and the bounds of the search."""
        return super().extras(grid) | {"iterations": self.iterations}

    def begin_driving(self) -> None:
        """Take up a new plan of the team."""
        assert self.plan is not None
        self._take_up(self.plan, self.radius)

    def _take_up(self, plan: TeamPlan, radius: float) -> None:
        curves, room = centred(plan.paths, self.grid, self.fleet.radius)
        precedence = Precedence(plan, 2.0 * self.grid.in_cells(radius))
        self.ordered = OrderedDriving(curves, precedence, self.fleet.radius, room)

    def drive(self, state: FleetState, info: dict[str, Any]) -> NDArray[np.float64]:
        """Commands (k, 2) for now, after a look at who is late."""
        before = self.ordered.completed.copy()
        self.ordered.note(state)
        if (self.ordered.completed > before).any():
            self._stepped_at = state.time
        commands = self.ordered.commands(state)
        self._watch(state)
        if self.may_replan and self._should_replan(state):
            self._replan(state)
            commands = self.ordered.commands(state)
        if self.fleet.drawn:
            curves = {robot: self.ordered.remaining(robot) for robot in np.flatnonzero(state.active).tolist()}
            self.fleet.show(TeamSketch(curves, np.empty((0, 2)), self.ordered.waits, self._note()))
        return commands

    def _note(self) -> str:
        return f"{self.message}  Replanned {self.replans} times." if self.replans else self.message

    def _watch(self, state: FleetState) -> None:
        """Note who moves."""
        shift = np.hypot(*(state.poses - self._anchor)[:, :2].T)
        turn = np.where(np.isfinite(shift), state.poses[:, 2] - self._anchor[:, 2], 0.0)
        moving = (shift > _MOVED) | (np.abs(np.angle(np.exp(1j * turn))) > 4 * _MOVED)
        self._anchor[moving] = state.poses[moving]
        self._moved_at[moving] = state.time

    def _held_up(self, state: FleetState) -> NDArray[np.bool_]:
        """Who could go on but does not, or never will: (k,)."""
        waiting = np.zeros(self.fleet.robots, np.bool_)
        for robot, _ in self.ordered.waits:
            waiting[robot] = True
        still = state.time - self._moved_at > _HELD_UP
        crashed = ~state.active & ~state.arrived
        return (state.active & still & ~waiting) | crashed

    def _should_replan(self, state: FleetState) -> bool:
        if state.time - self._planned_at < _REST:
            return False
        held_up = self._held_up(state)
        waited_for = np.zeros(self.fleet.robots, np.bool_)
        for _, other in self.ordered.waits:
            waited_for[other] = True
        in_the_way = held_up & waited_for & ~self._around
        freed = self._around & ~held_up & state.active
        aside = state.arrived & ~self._placed & (np.hypot(*(state.poses[:, :2] - state.goals).T) > _ASIDE)
        self._placed |= aside
        return bool(in_the_way.any() or freed.any() or aside.any() or self._deadlocked(state))

    def _deadlocked(self, state: FleetState) -> bool:
        return state.time - max(self._stepped_at, self._planned_at) > _DEADLOCK

    def _replan(self, state: FleetState) -> None:
        """Replan the robots that move, from where they are, around the others; keep the old plan if that fails."""
        around = self._held_up(state)
        if self._deadlocked(state):  # who was planned around is told to stand: only a new plan shows whether it can go
            around &= ~state.active
        self._planned_at = state.time
        movers = np.flatnonzero(state.active & ~around)
        if not len(movers):
            return
        for share in _SQUEEZE:
            radius = max(share * self.radius, self.fleet.radius)
            plan = self._plan_some(state, movers, radius)
            if plan is not None:
                self.plan, self.replans, self._around = plan, self.replans + 1, around
                self._take_up(plan, radius)
                return

    def _plan_some(self, state: FleetState, movers: NDArray[np.int64], radius: float) -> TeamPlan | None:
        """A plan of the team in which only ``movers`` move; None if there is none."""
        grid = self.grid
        taken = np.zeros_like(grid.blocked)
        for robot in set(range(self.fleet.robots)) - set(movers.tolist()):
            block_disc(taken, grid, state.poses[robot, :2], self.fleet.radius)
        graph = self.graph_of(grid, state, radius, taken)
        cells, goals = grid.standing(state.poses[:, :2], graph), grid.standing(state.goals, graph)
        try:
            plan = plan_team(
                graph, cells[movers], goals[movers], self.method, time_limit=self.time_limit,
                seed=self.seed + self.replans + 1, iterations=self.iterations, cell_costs=wall_costs(grid),
            )  # fmt: skip
        except TeamError:  # a start or goal that is taken, or out of reach, by now
            return None
        if not plan.solved:
            return None
        paths = [cells[robot][None] for robot in range(self.fleet.robots)]
        for robot, path in zip(movers, plan.paths, strict=True):
            paths[int(robot)] = path
        self.message = plan.message
        return TeamPlan(True, paths, plan.cost, plan.lower_bound, plan.optimal, plan.message)
