"""Conflict-based search (Sharon et al. 2015) for discs: the optimum of a small team, with a certificate.

A node of the search tree has constraints for each robot and the cheapest paths that obey them; the sum of their steps
is a lower bound for every plan that does. The best node is split at a conflict; a node without conflicts is optimal.
Three additions: the plan of prioritized search is an upper bound, so that the search may also end because nothing can
be cheaper; of a node's conflicts the one is split that raises the cost in both children, if there is one (cardinal
conflicts, Boyarski et al. 2015); and a child that costs the same and conflicts less replaces its parent (bypassing).
"""

import heapq
import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.team.budget import Budget
from lidarena.planning.team.constraints import Constraint, forbid, permit, split
from lidarena.planning.team.grid_graph import STEP
from lidarena.planning.team.prioritized import conflicts_of
from lidarena.planning.team.route import GAVE_UP, find_route
from lidarena.planning.team.search_arrays import NO_ROWS, PlaceCosts
from lidarena.planning.team.traffic import NO_BOUND, Traffic

_LOOKED_AT = 4  # conflicts of a node whose children are compared


@leaf
def _add_presence(
    path: NDArray[np.int32],
    length: int,
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    weight: int,
    layer: NDArray[np.int32],
) -> None:
    """Add ``weight`` wherever a robot would stand too close to one on a path, in every row of ``layer`` (times, n)."""
    for t in range(len(layer)):
        for e in range(begins[0], begins[1]):
            if entries[e, 1] & 1:
                place = padded[at[path[min(t, length)]] + entries[e, 0]]
                if place >= 0:
                    layer[t, place] += weight


@dataclass
class _Node:
    """Constraints and the cheapest paths that obey them."""

    constraints: tuple[Constraint, ...]
    paths: NDArray[np.int32]
    lengths: NDArray[np.int64]
    conflicts: list[tuple[int, int, int]]

    @property
    def cost(self) -> int:
        return int(self.lengths.sum())


@dataclass(frozen=True)
class CbsResult:
    """What the search has proved.

    Attributes:
        lower_bound: No plan costs less.
        nodes: Nodes that were split.
        found: Whether ``traffic`` has got a plan that the search found.
    """

    lower_bound: int
    nodes: int
    found: bool


class ConflictBasedSearch:
    """The search for one team.

    Args:
        traffic: The team; its tables must be empty and are empty again afterwards.
        upper_bound: Cost of a plan that is known; only cheaper ones are looked for. None = no plan is known.
    """

    def __init__(self, traffic: Traffic, upper_bound: int | None = None) -> None:
        self._traffic = traffic
        self._upper = np.inf if upper_bound is None else upper_bound
        self._lost = np.inf  # least bound of the nodes that were dropped for want of room
        self._numbers = itertools.count()
        others = max(len(traffic) - 1, 1)
        # small units must stay below a step, or a path would no longer be the shortest
        self._weight = np.int64(max((int(STEP) - traffic.capacity) // (traffic.capacity * others), 0))
        self._base = np.zeros(len(traffic.graph), np.int32)
        self._layer = np.zeros((traffic.capacity, len(traffic.graph)), np.int32)

    def run(self, budget: Budget) -> CbsResult:
        """Search until the optimum is certified or the budget is spent."""
        root = self._root()
        if root is None:
            return CbsResult(int(self._traffic.alone.sum()), 0, False)
        queue = [self._entry(root)]
        split_nodes = 0
        while queue and queue[0][0] < self._upper:
            if not budget.take():
                return CbsResult(int(min(queue[0][0], self._lost)), split_nodes, False)
            node = heapq.heappop(queue)[-1]
            children = self._expand(node)
            if not node.conflicts:
                self._traffic.paths[:], self._traffic.lengths[:] = node.paths, node.lengths
                return CbsResult(int(min(node.cost, self._lost)), split_nodes, True)
            split_nodes += 1
            for child in children:
                if child.cost < self._upper:
                    heapq.heappush(queue, self._entry(child))
        return CbsResult(int(min(self._upper, self._lost, 2**30)), split_nodes, False)

    def _entry(self, node: _Node) -> tuple[int, int, int, _Node]:
        return node.cost, len(node.conflicts), next(self._numbers), node

    def _root(self) -> _Node | None:
        traffic = self._traffic
        node = _Node((), traffic.paths.copy(), np.zeros(len(traffic), np.int64), [])
        for robot in range(len(traffic)):
            if not self._reroute(node, robot, range(robot)):
                return None
        node.conflicts = self._conflicts(node)
        return node

    def _conflicts(self, node: _Node) -> list[tuple[int, int, int]]:
        """(step, i, j) of each pair's first conflict, the earliest first."""
        self._traffic.paths[:], self._traffic.lengths[:] = node.paths, node.lengths
        times = conflicts_of(self._traffic)
        pairs = np.argwhere(np.triu(times >= 0))
        return sorted((int(times[i, j]), int(i), int(j)) for i, j in pairs)

    def _reroute(self, node: _Node, robot: int, others: range) -> bool:
        """Give a robot the cheapest path that obeys its constraints, past as many of the others as possible."""
        traffic, graph = self._traffic, self._traffic.graph
        mine = [c for c in node.constraints if c.robot == robot]
        last = max([c.time + 1 for c in mine], default=0)
        if self._weight:
            last = max([last, *(int(node.lengths[other]) for other in others if other != robot)])
        if last >= traffic.capacity:
            self._lost = min(
                self._lost, node.cost
            )  # the robot's old path is a bound for the one that is not looked for
            return False
        layer = self._layer[: last + 1]
        for other in others:
            if other != robot and self._weight:
                _add_presence(node.paths[other], node.lengths[other], *graph.arrays[1:], self._weight, layer)
        steps = self._find(robot, last, mine, layer, node.paths[robot])
        for other in others:
            if other != robot and self._weight:
                _add_presence(node.paths[other], node.lengths[other], *graph.arrays[1:], -self._weight, layer)
        if steps == GAVE_UP:
            self._lost = min(self._lost, node.cost)
        node.lengths[robot] = max(steps, 0)
        return steps >= 0

    def _find(
        self, robot: int, last: int, mine: list[Constraint], layer: NDArray[np.int32], path: NDArray[np.int32]
    ) -> int:
        """Find a robot's cheapest path that obeys its constraints, with larger tables where these are too small."""
        traffic = self._traffic
        for c in mine:
            while len(traffic.reserved.counts) <= traffic.reserved.used[0] + len(c.moves):
                traffic.memory.limits[5] = NO_ROWS
                traffic.make_room()
            forbid(c.moves, np.int64(c.time), c.forever, traffic.reserved)
        traffic.memory.limits[:2] = NO_BOUND
        costs, ends = PlaceCosts(traffic.ahead[robot], self._base, layer), traffic.ends[robot]
        while True:
            reserved, memory = traffic.reserved, traffic.memory
            steps = find_route(traffic.graph.neighbours, costs, reserved, np.int64(last), ends, memory, path)
            if steps != GAVE_UP or not traffic.make_room():
                break
        for c in mine:
            permit(c.moves, np.int64(c.time), c.forever, traffic.reserved)
        return steps

    def _expand(self, node: _Node) -> list[_Node]:
        """Children of a node; a node that is bypassed until it has no conflicts has none, and is changed in place."""
        while node.conflicts:
            best: tuple[tuple[int, int], list[_Node]] | None = None
            for conflict in node.conflicts[:_LOOKED_AT]:
                children = [child for c in self._split(node, conflict) if (child := self._child(node, c)) is not None]
                bypass = [c for c in children if c.cost == node.cost and len(c.conflicts) < len(node.conflicts)]
                if bypass:
                    node.paths, node.lengths, node.conflicts = bypass[0].paths, bypass[0].lengths, bypass[0].conflicts
                    break
                rises = sorted([child.cost - node.cost for child in children] + [2**30] * (2 - len(children)))
                if best is None or (rises[0], rises[1]) > best[0]:
                    best = (rises[0], rises[1]), children
                if rises[0] > 0:
                    return children
            else:
                assert best is not None
                return best[1]
        return []

    def _split(self, node: _Node, conflict: tuple[int, int, int]) -> tuple[Constraint, Constraint]:
        t, i, j = conflict
        steps = np.array([[node.paths[r, min(s, node.lengths[r])] for s in (t, t + 1)] for r in (i, j)], np.int64)
        resting = 0 if t >= node.lengths[i] else 1 if t >= node.lengths[j] else -1
        return split(self._traffic.graph, self._traffic.ends, (i, j), t, steps, resting)

    def _child(self, node: _Node, constraint: Constraint) -> _Node | None:
        child = _Node((*node.constraints, constraint), node.paths.copy(), node.lengths.copy(), [])
        if not self._reroute(child, constraint.robot, range(len(self._traffic))):
            return None
        child.conflicts = self._conflicts(child)
        return child
