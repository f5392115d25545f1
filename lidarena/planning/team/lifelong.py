"""Teams that get a new goal whenever they reach one: a rolling horizon of sampled steps (lifelong MAPF).

In every time step several futures of a few steps each are played through with priority inheritance (``pibt``), which
differ in how ties are broken; the first step of the best is taken, then goals that were reached are replaced. Okumura
et al. (2022) plan one step ahead, Li et al. (2021, "Lifelong multi-agent path finding in large-scale warehouses") a
window; this is between the two: no step can lead to a conflict, whatever the horizon.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import TeamError
from lidarena.base.jit import kernel
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph, grid_graph_of
from lidarena.planning.team.pibt import TeamStep, next_configuration, team_step
from lidarena.planning.team.search_arrays import GraphArrays

NextGoal = Callable[[int, NDArray[np.int64]], Sequence[int]]
"""A robot's next goal [row, column], from its number and its cell."""


@dataclass(frozen=True)
class LifelongPlan:
    """What a team did.

    Attributes:
        cells: (steps + 1, k, 2) where the robots were.
        reached: (steps + 1, k) bool, whether a robot reached its goal then.
    """

    cells: NDArray[np.int64]
    reached: NDArray[np.bool_]

    @property
    def throughput(self) -> float:
        """Goals that were reached in a step, on average."""
        return float(self.reached[1:].sum()) / max(len(self.reached) - 1, 1)


@kernel
def _play(
    order: NDArray[np.int16],
    steps: int,
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    step: TeamStep,
    path: NDArray[np.int32],
) -> int:
    """Play one future through; path (steps + 1, k) begins with where the robots are. Return the sum of what is left.

    A robot that has reached its goal is worth nothing more, and makes room for everybody else.
    """
    team = len(order)
    constraints, done, first = np.zeros(team, np.int64), np.zeros(team, np.bool_), order.copy()
    total = np.int64(0)
    for t in range(steps):
        for robot in range(team):
            step.here[robot] = path[t, robot]
            step.occupant[path[t, robot]] = robot
        next_configuration(first, constraints, np.int64(0), graph, ahead, step)
        for robot in range(team):
            step.occupant[path[t, robot]] = -1
        for robot in range(team):
            path[t + 1, robot] = graph.neighbours[path[t, robot], step.moves[robot]]
            done[robot] = done[robot] or path[t + 1, robot] == step.goals[robot]
            total += 0 if done[robot] else ahead[robot, path[t + 1, robot]] // 4096
        place = 0
        for late in range(2):  # whoever is done goes last
            for k in range(team):
                if done[order[k]] == (late == 1):
                    first[place] = order[k]
                    place += 1
    return int(total)


class LifelongTeam:
    """A team on a grid whose robots get new goals.

    Args:
        graph: Where the robots can go.
        starts: (k,) places.
        goals: (k,) places.
        futures: How many are played through in a step.
        horizon: Steps of each.
        seed: Of the ties.

    Attributes:
        places: (k,) int32 where the robots are.
        goals: (k,) int64 their goals; several may have the same.
        waited: (k,) int64 steps since each reached a goal: its priority.
    """

    def __init__(
        self,
        graph: GridGraph,
        starts: NDArray[np.int64],
        goals: NDArray[np.int64],
        futures: int = 8,
        horizon: int = 6,
        seed: int = 0,
    ) -> None:
        self._graph, self._futures, self._horizon = graph, futures, horizon
        self.places, self.goals = starts.astype(np.int32), goals.astype(np.int64)
        self.waited = np.zeros(len(starts), np.int64)
        self._step = team_step(graph.arrays, self.goals, seed)
        self._ahead = np.stack([graph.ahead(int(goal)) for goal in goals])

    def set_goal(self, robot: int, goal: int) -> None:
        """Give a robot a new goal.

        Raises:
            TeamError: No way leads there.
        """
        ahead = self._graph.ahead(goal)
        if ahead[self.places[robot]] >= UNREACHABLE:
            here, there = (tuple(self._graph.cells[p].tolist()) for p in (self.places[robot], goal))
            raise TeamError(f"robot {robot} cannot reach its next goal {there} from {here}")
        self.goals[robot] = self._step.goals[robot] = goal
        self._ahead[robot] = ahead

    def advance(self) -> NDArray[np.bool_]:
        """Take a step; return who is at its goal then (k,)."""
        order = np.argsort(-self.waited, kind="stable").astype(np.int16)
        best, least = self.places, -1
        path = np.zeros((self._horizon + 1, len(order)), np.int32)
        for _ in range(self._futures):
            path[0] = self.places
            left = _play(order, np.int64(self._horizon), self._graph.arrays, self._ahead, self._step, path)
            if least < 0 or left < least:
                best, least = path[1].copy(), left
        self.places = best
        reached: NDArray[np.bool_] = self.places == self.goals
        self.waited = np.where(reached, 0, self.waited + 1)
        return reached


def plan_lifelong(
    grid: ArrayLike,
    starts: ArrayLike,
    next_goal: NextGoal,
    steps: int,
    *,
    connectivity: int = 4,
    radius: float = 0.0,
    futures: int = 8,
    horizon: int = 6,
    seed: int = 0,
) -> LifelongPlan:
    """Let a team work for a number of steps; a robot that reaches its goal gets the next one.

    Args:
        grid: (rows, cols) bool, True = blocked.
        starts: (k, 2) int [row, column].
        next_goal: Tells a robot's next goal; also the first ones.
        steps: Time steps.
        connectivity: 4 or 8 neighbours.
        radius: Of every robot, in cells; 0 = points.
        futures: How many futures are played through in a step; more cost time and may find better ones.
        horizon: Steps of each future.
        seed: Of the ties.

    Raises:
        TeamError: Fewer places than two, a start or goal where no robot can be, or a number out of range.
    """
    blocked, first = np.asarray(grid, np.bool_), np.asarray(starts, np.int64)
    if blocked.ndim != 2 or first.ndim != 2 or first.shape[1:] != (2,) or not len(first):
        raise TeamError(f"a grid of shape {blocked.shape} and starts of shape {first.shape} are no team on a grid")
    for name, value in (("steps", steps), ("futures", futures), ("horizon", horizon)):
        if not isinstance(value, int | np.integer) or value < 1:
            raise TeamError(f"{name} = {value!r} is not possible; a whole number from 1 on is needed")
    graph = grid_graph_of(np.ascontiguousarray(blocked), connectivity, float(radius))
    if len(graph) < 2:
        raise TeamError(f"a grid with room for a robot in {len(graph)} places has no goals to go on to; 2 are needed")
    places = np.array([_place(graph, "start", robot, cell) for robot, cell in enumerate(first)], np.int64)
    goals = [_place(graph, "goal", robot, next_goal(robot, cell)) for robot, cell in enumerate(first)]
    team = LifelongTeam(graph, places, places, futures, horizon, seed)
    for robot, goal in enumerate(goals):
        team.set_goal(robot, goal)
    cells, reached = [graph.cells[team.places]], [np.zeros(len(first), np.bool_)]
    for _ in range(steps):
        reached.append(team.advance())
        cells.append(graph.cells[team.places])
        for robot in np.flatnonzero(reached[-1]).tolist():
            team.set_goal(robot, _place(graph, "goal", robot, next_goal(robot, cells[-1][robot])))
    return LifelongPlan(np.array(cells), np.array(reached))


def _place(graph: GridGraph, kind: str, robot: int, cell: Sequence[int] | NDArray[np.int64]) -> int:
    row, col = (int(x) for x in cell)
    inside = 0 <= row < graph.index.shape[0] and 0 <= col < graph.index.shape[1]
    if not inside or graph.index[row, col] < 0:
        raise TeamError(f"the {kind} of robot {robot} at ({row}, {col}) is in a wall, too near to one, or off the grid")
    return int(graph.index[row, col])
