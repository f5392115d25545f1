"""Teams that get a new goal whenever they reach one: a rolling horizon (lifelong MAPF).

A plan reaches some steps ahead, as that of Li et al. (2021, "Lifelong multi-agent path finding in large-scale
warehouses"). In every time step it is prolonged by a step of priority inheritance (``pibt``, Okumura et al. 2022), so
that there always is one; a few futures that are played through with priority inheritance alone may replace it; and it
is repaired (``lifelong_window``). Then its first step is taken and goals that were reached are replaced.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import TeamError
from lidarena.base.jit import kernel
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph, grid_graph_of
from lidarena.planning.team.lifelong_window import adopt_if_cheaper, improve, waiting_team
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
) -> None:
    """Play one future through; path (steps + 1, k) begins with where the robots are.

    A robot that has reached its goal makes room for everybody else.
    """
    team = len(order)
    constraints, done, first = np.zeros(team, np.int64), np.zeros(team, np.bool_), order.copy()
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
        place = 0
        for late in range(2):  # whoever is done goes last
            for k in range(team):
                if done[order[k]] == (late == 1):
                    first[place] = order[k]
                    place += 1


class LifelongTeam:
    """A team on a grid whose robots get new goals.

    Args:
        graph: Where the robots can go.
        starts: (k,) places.
        goals: (k,) places.
        futures: How many are played through in a step.
        horizon: Steps that are planned ahead.
        repairs: Neighbourhoods that are planned anew in a step.
        seed: Of the ties and of the neighbourhoods.

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
        futures: int = 1,
        horizon: int = 16,
        repairs: int = 200,
        seed: int = 0,
    ) -> None:
        self._graph, self._futures, self._horizon, self._repairs = graph, futures, horizon, repairs
        self.places, self.goals = starts.astype(np.int32), goals.astype(np.int64)
        self.waited = np.zeros(len(starts), np.int64)
        self._step = team_step(graph.arrays, self.goals, seed)
        self._ahead = np.stack([graph.ahead(int(goal)) for goal in goals])
        self._plan = waiting_team(self.places, len(graph), horizon)

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
        graph, plan = self._graph.arrays, self._plan
        for _ in range(self._futures):
            future = self._play(order, self.places, self._horizon)
            adopt_if_cheaper(future, self.goals, graph, self._ahead, plan, False)
        improve(self._repairs, self.goals, graph, self._ahead, plan, self._step.random)
        self.places = plan.paths[:, 1].copy()
        future = np.vstack([plan.paths[:, 1:].T, self._play(order, plan.paths[:, -1], 1)[1:]])
        adopt_if_cheaper(np.ascontiguousarray(future), self.goals, graph, self._ahead, plan, True)
        reached: NDArray[np.bool_] = self.places == self.goals
        self.waited = np.where(reached, 0, self.waited + 1)
        return reached

    def _play(self, order: NDArray[np.int16], places: NDArray[np.int32], steps: int) -> NDArray[np.int32]:
        """Some steps (steps + 1, k) of priority inheritance from some places (k,) on."""
        path = np.zeros((steps + 1, len(order)), np.int32)
        path[0] = places
        _play(order, np.int64(steps), self._graph.arrays, self._ahead, self._step, path)
        return path


def plan_lifelong(
    grid: ArrayLike,
    starts: ArrayLike,
    next_goal: NextGoal,
    steps: int,
    *,
    connectivity: int = 4,
    radius: float = 0.0,
    futures: int = 1,
    horizon: int = 16,
    repairs: int = 200,
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
        futures: How many futures are played through in a step, from 0 on.
        horizon: Steps that are planned ahead.
        repairs: Neighbourhoods of robots that are planned anew in a step, from 0 on; more cost time and find better
            plans.
        seed: Of the ties and of the neighbourhoods.

    Raises:
        TeamError: Fewer places than two, a start or goal where no robot can be, or a number out of range.
    """
    blocked, first = np.asarray(grid, np.bool_), np.asarray(starts, np.int64)
    if blocked.ndim != 2 or first.ndim != 2 or first.shape[1:] != (2,) or not len(first):
        raise TeamError(f"a grid of shape {blocked.shape} and starts of shape {first.shape} are no team on a grid")
    for name, value, least in (
        ("steps", steps, 1),
        ("futures", futures, 0),
        ("horizon", horizon, 1),
        ("repairs", repairs, 0),
    ):
        if not isinstance(value, int | np.integer) or value < least:
            raise TeamError(f"{name} = {value!r} is not possible; a whole number from {least} on is needed")
    graph = grid_graph_of(np.ascontiguousarray(blocked), connectivity, float(radius))
    if len(graph) < 2:
        raise TeamError(f"a grid with room for a robot in {len(graph)} places has no goals to go on to; 2 are needed")
    places = np.array([_place(graph, "start", robot, cell) for robot, cell in enumerate(first)], np.int64)
    goals = [_place(graph, "goal", robot, next_goal(robot, cell)) for robot, cell in enumerate(first)]
    team = LifelongTeam(graph, places, places, futures, horizon, repairs, seed)
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
