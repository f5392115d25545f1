"""The paths of a team and the tables that they fill: what every method of this folder plans with."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf, merged
from lidarena.planning.team.grid_graph import STEP, UNREACHABLE, GridGraph
from lidarena.planning.team.interval_route import find_quick_route
from lidarena.planning.team.reservations import clear, has_room, release, reserve, rest
from lidarena.planning.team.route import find_route
from lidarena.planning.team.search_arrays import (
    NO_ROWS,
    GraphArrays,
    PlaceCosts,
    Reservations,
    SearchMemory,
    TeamPaths,
    with_more_room,
)

FlatArrays = tuple[NDArray[Any], ...]
NO_BOUND = np.int64(2**31 - 1)
_SPARE = 32  # steps that paths may get longer than those that are taken over


@merged
def _plan_in_order(
    order: NDArray[np.int64],
    graph: GraphArrays,
    costs: PlaceCosts,
    reserved: Reservations,
    memory: SearchMemory,
    team: TeamPaths,
    timed: bool,
    budget: int,
) -> int:
    """Plan the robots of ``order`` one after the other past those that are placed, and place them.

    ``costs`` are those of the whole team; the other arguments as in ``_plan_group``.

    Returns:
        How many were placed before one failed.
    """
    ahead, ends = costs.ahead, team.ends
    after = np.int64(0)  # what the robots still to come need at least
    for k in range(len(order)):
        after += ahead[order[k], ends[order[k], 0]] // 4096
    for k in range(len(order)):
        robot = order[k]
        last = np.int64(0)
        for other in range(len(team.lengths)):
            if team.placed[other]:
                last = max(last, team.lengths[other])
        after -= ahead[robot, ends[robot, 0]] // 4096
        memory.limits[0] = (budget - after) * 4096 + 4095 if budget >= 0 else 2**31 - 1
        path = team.paths[robot]
        if timed:
            own = PlaceCosts(ahead[robot], costs.base, costs.layer)
            steps = find_route(graph.neighbours, own, reserved, last, ends[robot], memory, path)
        else:
            delay = team.delays[robot]
            steps = find_quick_route(graph.neighbours, ahead[robot], reserved, ends[robot], delay, memory, path)
        if steps < 0:
            return k
        if not has_room(steps, graph, reserved):
            memory.limits[5] = 2  # search_arrays.NO_ROWS
            return k
        budget = budget - steps if budget >= 0 else budget
        team.lengths[robot] = steps
        team.placed[robot] = True
        reserve(path, steps, graph, reserved)
    return len(order)


@leaf
def _rest_all(graph: GraphArrays, reserved: Reservations, team: TeamPaths) -> None:
    for robot in range(len(team.lengths)):
        if team.placed[robot]:
            rest(team.paths[robot, team.lengths[robot]], team.lengths[robot], graph, reserved)


@leaf
def _clear_some(robots: NDArray[np.int64], graph: GraphArrays, reserved: Reservations, team: TeamPaths) -> None:
    for k in range(len(robots)):
        clear(team.paths[robots[k]], team.lengths[robots[k]], graph, reserved)


@leaf
def _remove(robots: NDArray[np.int64], arrays: FlatArrays) -> None:
    """Take robots' paths out of the reservations; arguments as ``_plan_group``."""
    graph, reserved, team = GraphArrays(*arrays[0:5]), Reservations(*arrays[8:14]), TeamPaths(*arrays[18:25])
    for k in range(len(robots)):
        if team.placed[robots[k]]:
            clear(team.paths[robots[k]], team.lengths[robots[k]], graph, reserved)
            team.placed[robots[k]] = False
    _rest_all(graph, reserved, team)


@leaf
def _place(robots: NDArray[np.int64], arrays: FlatArrays) -> None:
    """Enter robots' paths into the reservations; arguments as ``_plan_group``."""
    graph, reserved, team = GraphArrays(*arrays[0:5]), Reservations(*arrays[8:14]), TeamPaths(*arrays[18:25])
    for k in range(len(robots)):
        reserve(team.paths[robots[k]], team.lengths[robots[k]], graph, reserved)
        team.placed[robots[k]] = True


@leaf
def _plan_group(group: NDArray[np.int64], arrays: FlatArrays, timed: bool, budget: int, replan: bool) -> int:
    """Plan robots; where ``replan``, they are placed, and keep their old paths unless the sum of steps is no larger.

    One kernel for both, since the searches in it take long to compile.

    Args:
        group: The robots, first the one with the highest priority.
        arrays: Those of ``GraphArrays``, ``PlaceCosts`` (``ahead`` is (k, n)), ``Reservations``, ``SearchMemory`` and
            ``TeamPaths``, one after the other: handing five named tuples over takes as long as a small search.
        timed: Whether to search places at times, not safe intervals.
        budget: Greatest number of steps of all robots of ``group`` together; -1 = any.
        replan: Whether ``group`` is placed.

    Returns:
        How many robots were placed before one failed; where ``replan`` the steps saved, -1 if the old paths were kept.
    """
    graph, costs = GraphArrays(*arrays[0:5]), PlaceCosts(*arrays[5:8])
    reserved, memory, team = Reservations(*arrays[8:14]), SearchMemory(*arrays[14:18]), TeamPaths(*arrays[18:25])
    if replan:
        budget = 0
        for k in range(len(group)):
            robot = group[k]
            budget += int(team.lengths[robot])
            _copy_path(team.paths, team.lengths, team.kept_paths, team.kept_lengths, robot)
        _clear_some(group, graph, reserved, team)
        for k in range(len(group)):
            team.placed[group[k]] = False
        _rest_all(graph, reserved, team)
    planned = _plan_in_order(group, graph, costs, reserved, memory, team, timed, budget)
    if not replan:
        return planned
    if planned == len(group):
        for k in range(len(group)):
            budget -= int(team.lengths[group[k]])
        return budget
    _clear_some(group[:planned], graph, reserved, team)
    for k in range(len(group)):
        team.placed[group[k]] = True
        _copy_path(team.kept_paths, team.kept_lengths, team.paths, team.lengths, group[k])
        reserve(team.paths[group[k]], team.lengths[group[k]], graph, reserved)
    _rest_all(graph, reserved, team)
    return -1


@inlined
def _copy_path(
    source: NDArray[np.int32],
    source_lengths: NDArray[np.int64],
    target: NDArray[np.int32],
    target_lengths: NDArray[np.int64],
    robot: int,
) -> None:
    target_lengths[robot] = source_lengths[robot]
    for t in range(source_lengths[robot] + 1):
        target[robot, t] = source[robot, t]


class Traffic:
    """A team on its graph: paths, which of them are placed in the reservation tables, and room for searches.

    Args:
        graph: Where the robots can go.
        ends: (k, 2) start and goal places.
        surcharge: (n,) units that being in a place for a step costs more; None = nothing.
        timed: Whether places cost by time, so that waiting is not the same everywhere: search places at times, not
            safe intervals. Always so with a surcharge.

    Attributes:
        paths: (k, capacity) int32 places, one a time step, valid up to ``lengths``.
        lengths: (k,) steps until each robot stays at its goal.
        placed: (k,) bool, whose paths are in the tables.
        reserved: The reservation tables.
        memory: Limits and memory of the searches.
        delays: (k,) steps that each robot waits at its start before it leaves, so that others get past; 0 unless set.
        ahead: (k, n) int32 what the rest of the way costs from every place.
        alone: (k,) steps that each robot needs without the others.
    """

    def __init__(
        self, graph: GridGraph, ends: NDArray[np.int64], surcharge: NDArray[np.int32] | None = None, timed: bool = False
    ) -> None:
        self.graph, self.ends = graph, ends
        places, team = len(graph), len(ends)
        goals = ends[:, 1].tolist()
        self.ahead = graph.ahead_of_all(goals)
        self.alone: NDArray[np.int64] = self.ahead[np.arange(team), ends[:, 0]].astype(np.int64) // STEP
        if surcharge is not None:
            for robot, goal in enumerate(goals):
                self.ahead[robot] = graph.ahead_with(goal, surcharge)
        # no layer of states beyond it is ever searched: everyone in turn, in the worst order, is far more than needed
        reached = self.alone[self.alone < int(UNREACHABLE // STEP)]
        self.capacity = int(2 * reached.max(initial=0) + 4 * team + 64)
        self.base = np.zeros(places, np.int32) if surcharge is None else surcharge
        self.timed = timed or surcharge is not None
        self.layer = np.zeros((1, places), np.int32)
        self.delays, self.lengths = np.zeros(team, np.int64), np.zeros(team, np.int64)
        self.placed = np.zeros(team, np.bool_)
        self._allocate()

    def __len__(self) -> int:
        """Number of robots."""
        return len(self.ends)

    def _allocate(self) -> None:
        """Get tables and paths with room for ``capacity`` steps."""
        self._tables = self.graph.borrow(self.capacity)
        self.reserved, self.memory = self._tables
        self.memory.limits[:2] = NO_BOUND
        self.paths = np.zeros((len(self), self.capacity), np.int32)
        kept = np.zeros_like(self.paths), np.zeros_like(self.lengths)
        self._team = TeamPaths(self.ends, self.delays, self.paths, self.lengths, self.placed, *kept)

    def adopt(self, paths: NDArray[np.int32], lengths: NDArray[np.int64]) -> None:
        """Take over a plan without conflicts and place everyone; nobody may be placed.

        Args:
            paths: (k, T) places, one a time step, valid up to ``lengths``.
            lengths: (k,) steps until each robot stays at its goal.
        """
        if paths.shape[1] + _SPARE >= self.capacity:
            self.graph.give_back(self._tables)
            self.capacity = paths.shape[1] + paths.shape[1] // 4 + 2 * _SPARE
            if len(self.layer) > 1:
                self.layer = np.zeros((1, len(self.graph)), np.int32)
            self._allocate()
        self.paths[:, : paths.shape[1]] = paths
        self.lengths[:] = lengths
        self.place(np.arange(len(self)))

    def close(self) -> None:
        """Empty the tables and give the room for searches back; the paths stay."""
        placed = self.placed.copy()
        _remove(np.flatnonzero(placed), self._arrays)
        self.placed[:] = placed
        release(self.reserved)
        self.graph.give_back(self._tables)

    def make_room(self) -> bool:
        """Enlarge the tables if the last search had too little room; False if it had enough, or no more can be had."""
        larger = with_more_room(self._tables)
        if larger is not None:
            self._tables = larger
            self.reserved, self.memory = larger
        return larger is not None

    def _plan(self, group: NDArray[np.int64], budget: int, replan: bool) -> int:
        return _plan_group(group, self._arrays, self.timed, budget, replan)

    @property
    def _arrays(self) -> FlatArrays:
        """The arrays that kernels take, see ``_plan_group``."""
        costs = (self.ahead, self.base, self.layer)
        return (*self.graph.arrays, *costs, *self.reserved, *self.memory, *self._team)

    def plan(self, order: NDArray[np.int64], budget: int = -1) -> int:
        """Plan robots one after the other past those that are placed, and place them.

        Args:
            order: The robots, first the one with the highest priority.
            budget: Greatest number of steps of all of them together; -1 = any.

        Returns:
            How many were placed before one failed.
        """
        done = 0
        while True:
            left = budget - int(self.lengths[order[:done]].sum()) if budget >= 0 else -1
            done += self._plan(order[done:], left, False)
            if done == len(order) or not self.make_room():
                return done

    def replan(self, group: NDArray[np.int64]) -> int:
        """Replan robots, all of them placed, in this order; the old paths stay unless the sum is no larger.

        Returns:
            Steps saved; -1 if the old paths were kept.
        """
        gain = self._plan(group, -1, True)
        self.make_room()
        return gain

    def remove(self, robots: NDArray[np.int64]) -> None:
        """Take robots' paths out of the tables; the paths themselves stay where they are."""
        _remove(robots, self._arrays)

    def place(self, robots: NDArray[np.int64]) -> None:
        """Enter robots' paths, as they are, into the tables."""
        for robot in robots:
            while not has_room(self.lengths[robot], self.graph.arrays, self.reserved):
                self.memory.limits[5] = NO_ROWS
                self.make_room()
            _place(np.array([robot]), self._arrays)

    @property
    def expanded(self) -> int:
        """States that the last search expanded."""
        return int(self.memory.limits[3])

    def cost(self) -> int:
        """Steps of all robots together."""
        return int(self.lengths.sum())

    def cells(self) -> list[NDArray[np.int64]]:
        """The paths as cells, (T, 2) each."""
        return [self.graph.cells[path[: n + 1]] for path, n in zip(self.paths, self.lengths, strict=True)]
