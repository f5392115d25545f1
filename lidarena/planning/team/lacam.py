"""LaCAM*: a complete search over configurations of a whole team (Okumura 2023, "LaCAM" and "Improving LaCAM").

From a configuration ``pibt`` makes the next one; where that was met before, or leads nowhere, robots are told their
moves one after the other, the one with the highest priority first, until in the end every combination of moves has been
tried; a small team soon goes through all joint moves instead, which leaves out what cannot be. So a plan is found where
there is one, mostly within a few trials for each of its steps; and if nothing is left to try, there is none. With more
time, cheaper ways to configurations that were met make the plan better.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.team.budget import Budget
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.lacam_joint import (
    EXHAUSTED,
    FOUND,
    FULL,
    GOES_ON,
    JointSearch,
    has_room,
    next_joint_move,
)
from lidarena.planning.team.lacam_nodes import (
    SMALL_TEAM,
    LacamNodes,
    add_node,
    connect,
    empty_nodes,
    find_slot,
    with_more_room,
)
from lidarena.planning.team.pibt import TeamStep, next_configuration, random_below, team_step
from lidarena.planning.team.search_arrays import GraphArrays
from lidarena.planning.team.team_plan import TeamPlan, failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic

_MOST_BYTES = 128 * 2**20
_FIRST_NODES = 2048
_RESTARTS = 1000  # one step in so many goes back to the starts once a plan is known
_SLICE = 40_000  # robots' moves between two looks at the clock
_JOINT_SLICE = 128  # joint moves between two looks; one alone may take a millisecond where hardly any is possible


@leaf
def _constraints_of(
    number: int, nodes: LacamNodes, graph: GraphArrays, constraints: NDArray[np.int64], degree: NDArray[np.int64]
) -> int:
    """Decode the next combination of constraints of a configuration; return how many robots it tells, -1 none is left.

    The combinations are numbered breadth first: none, each move of the first robot, each pair of moves of the first
    two, ...
    """
    left, depth, size = nodes.tried[number], 0, np.int64(1)
    team = nodes.places.shape[1]
    while left >= size:
        left -= size
        if depth == team:
            return -1
        size *= degree[nodes.places[number, nodes.order[number, depth]]] + 1
        depth += 1
    nodes.tried[number] += 1
    for d in range(depth):
        place = np.int64(nodes.places[number, nodes.order[number, d]])
        choices = degree[place] + 1
        wanted = (left + number * 7 + d * 3) % choices  # not always the same direction first
        left //= choices
        for m in range(9):
            if graph.neighbours[place, m] >= 0:
                if wanted == 0:
                    constraints[d] = m
                wanted -= 1
    return depth


@kernel
def _search(  # noqa: C901 - the loop of a search
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    nodes: LacamNodes,
    step: TeamStep,
    ranks: NDArray[np.int64],
    iterations: int,
    first: bool,
) -> int:
    """Go on with a search for so many steps, or up to the first plan; return why it stopped."""
    sizes, team = nodes.sizes, len(step.goals)
    constraints, places = np.zeros(team, np.int64), np.zeros(team, np.int32)
    for _ in range(iterations):
        if sizes[2] == 0:
            return 2
        if not has_room(nodes):
            return 3
        here, goal = np.int64(nodes.stack[sizes[2] - 1]), sizes[3]
        if goal >= 0 and nodes.spent[here] + nodes.ahead[here] >= nodes.spent[goal]:
            sizes[2] -= 1
            continue
        depth = _constraints_of(here, nodes, graph, constraints, step.degree)
        for robot in range(team):
            step.here[robot] = nodes.places[here, robot]
            step.occupant[step.here[robot]] = robot
        if depth >= 3 and team <= SMALL_TEAM:
            made = next_joint_move(here, nodes, graph, ahead, step)
            depth = depth if made else -1
        else:
            made = depth >= 0 and next_configuration(nodes.order[here], constraints, depth, graph, ahead, step)
        for robot in range(team):
            step.occupant[step.here[robot]] = -1
        if depth < 0:
            sizes[2] -= 1
        if not made:
            continue
        for robot in range(team):
            places[robot] = graph.neighbours[step.here[robot], step.moves[robot]]
        slot, met = find_slot(nodes, places)
        if met >= 0:
            connect(nodes, here, met, step.goals)
            following = met if goal < 0 or random_below(step.random, 1000) > 0 else 0
        else:
            following = add_node(nodes, places, slot, here, ahead, step.goals, ranks)
        if goal < 0 or nodes.spent[following] + nodes.ahead[following] < nodes.spent[goal]:
            nodes.stack[sizes[2]] = following
            sizes[2] += 1
        if met < 0 and goal < 0 and nodes.ahead[following] == 0:
            at_goals = True
            for robot in range(team):
                at_goals = at_goals and places[robot] == step.goals[robot]
            if at_goals:
                sizes[3] = following
                if first:
                    return 1
    return 0


class Lacam:
    """The search for one team.

    Args:
        traffic: The team; its tables are not touched.
        seed: Of the ties that are broken at random.

    Attributes:
        steps: Configurations that were tried.
    """

    def __init__(self, traffic: Traffic, seed: int) -> None:
        self._traffic, team = traffic, len(traffic)
        self._step = team_step(traffic.graph.arrays, traffic.ends[:, 1], seed)
        self._most = max(_MOST_BYTES // (8 * team + 80), 4 * _FIRST_NODES)
        self._nodes = empty_nodes(team, _FIRST_NODES, 2 * _FIRST_NODES)
        self._ranks = np.zeros(team, np.int64)
        by_length = np.argsort(traffic.alone, kind="stable")
        self._ranks[by_length] = np.arange(team)
        self._nodes.order[0] = by_length[::-1]
        starts = np.ascontiguousarray(traffic.ends[:, 0], np.int32)
        slot, _ = find_slot(self._nodes, starts)
        add_node(self._nodes, starts, slot, -1, traffic.ahead, traffic.ends[:, 1], self._ranks)
        self._nodes.sizes[2] = 1  # the starts, number 0, are stacked
        if (starts == traffic.ends[:, 1]).all():
            self._nodes.sizes[3] = 0
        self.steps = 0
        self._joint: tuple[JointSearch, JointSearch] | None = None

    @property
    def found(self) -> bool:
        """Whether there is a plan."""
        return bool(self._nodes.sizes[3] >= 0)

    def run(self, budget: Budget, first: bool) -> int:
        """Search until the budget is spent, to the first plan or to better ones; GOES_ON, FOUND, EXHAUSTED or FULL.

        Args:
            budget: An iteration is a slice of many configurations.
            first: Whether to stop at the first plan.
        """
        if first and self.found:
            return FOUND
        portion = max(_SLICE // len(self._traffic), 16)
        while budget.take():
            status = self._search(portion, first, budget)
            if status == FULL and not self._grow():
                return FULL
            if status in (FOUND, EXHAUSTED):
                return status
        return GOES_ON

    def _search(self, portion: int, first: bool, budget: Budget) -> int:
        """A slice of the search: depth first, in small teams whose plan is not among the first slice best first."""
        graph, ahead = self._traffic.graph.arrays, self._traffic.ahead
        begun, self.steps = self.steps > 0, self.steps + portion
        if not begun or self.found or len(self._traffic) > SMALL_TEAM:
            return _search(graph, ahead, self._nodes, self._step, self._ranks, portion, first)
        return self._search_both_ways(portion, budget)

    def _search_both_ways(self, portion: int, budget: Budget) -> int:
        if self._joint is None:
            graph, ends, most = self._traffic.graph, self._traffic.ends, self._most
            to_starts = np.stack([graph.ahead(int(start)) for start in ends[:, 0]])
            forth = JointSearch(graph.arrays, self._traffic.ahead, self._nodes, self._step, self._ranks, most)
            self._joint = forth, JointSearch.back(graph.arrays, to_starts, ends, self._ranks, most)
        forth, back = self._joint
        status = GOES_ON
        for turn in range(-(-portion // _JOINT_SLICE)):
            one, other = (back, forth) if turn % 2 == 1 and not back.is_full else (forth, back)
            status = one.run(other, _JOINT_SLICE)
            if status == FOUND:
                forth.join(back, one is forth)
            if status == FULL and one is back:
                status = GOES_ON  # the other one has room
            if status != GOES_ON or budget.spent():
                break
        self._nodes = forth.nodes
        return status

    def _grow(self) -> bool:
        """Make room for twice as many configurations or steps; False at the limit of memory."""
        nodes, edges = len(self._nodes.parent), len(self._nodes.edges)
        if nodes >= self._most or edges >= 4 * self._most:
            return False
        more_nodes = min(2 * nodes, self._most) if self._nodes.sizes[0] + 1 >= nodes else nodes
        self._nodes = with_more_room(self._nodes, more_nodes, 2 * edges)
        return True

    def paths(self) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
        """The best plan: places (k, T) and the steps (k,) after which each robot stays at its goal."""
        way, at = [], int(self._nodes.sizes[3])
        while at >= 0:
            way.append(at)
            at = int(self._nodes.parent[at])
        paths = np.ascontiguousarray(self._nodes.places[way[::-1]].T)
        return paths, steps_of(paths)


def steps_of(paths: NDArray[np.int32]) -> NDArray[np.int64]:
    """Steps (k,) after which each robot stays, of places (k, T)."""
    moving = np.pad(paths[:, :-1] != paths[:, 1:], ((0, 0), (1, 0)), constant_values=True)
    lengths: NDArray[np.int64] = moving.shape[1] - 1 - np.argmax(moving[:, ::-1], axis=1)  # each one's last move
    return lengths


def load_kernels() -> None:
    """Search a slice in every way, so that everything is compiled before somebody's time limit runs."""
    traffic = Traffic(GridGraph(np.zeros((1, 3), np.bool_), 4, 0.0), np.array([(0, 2), (2, 0)]))
    search = Lacam(traffic, 0)
    for _ in range(2):
        search._search_both_ways(1, Budget(np.inf))
    traffic.close()


def plan_lacam(traffic: Traffic, budget: Budget, rng: np.random.Generator) -> TeamPlan:
    """LaCAM* for as long as the budget lasts.

    Args:
        traffic: The team, no robot placed.
        budget: Time and slices of the search.
        rng: Seeds the search.
    """
    search = Lacam(traffic, int(rng.integers(2**31)))
    status = search.run(budget, first=True)
    if not search.found:
        return failed_plan(traffic, why_not(status, search.steps))
    first = int(search.paths()[1].sum())
    status = search.run(budget, first=False)
    traffic.adopt(*search.paths())
    done = "; nothing better is left to try" if status == EXHAUSTED else ""
    return solved_plan(traffic, f"LaCAM* tried {search.steps} configurations; its first plan cost {first}{done}.")


def why_not(status: int, steps: int) -> str:
    """Why LaCAM found no plan."""
    if status == EXHAUSTED:
        return "There is no plan: LaCAM tried every step from every configuration that the team can get to."
    reason = "had no memory left" if status == FULL else "had no time left"
    return f"LaCAM {reason} after {steps} configurations."
