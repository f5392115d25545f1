"""The paths of a team and the tables that they fill: what every method of this room plans upon."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf, merged
from lidarena.planning.team.grid_graph import STEP, UNREACHABLE, GridGraph
from lidarena.planning.team.interval_route import find_quick_route
from lidarena.planning.team.reservations import clear, reserve
from lidarena.planning.team.route import find_route

NO_BOUND = np.int64(2**31 - 1)


@merged
def _plan_in_order(
    order: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    ahead: NDArray[np.int32],
    base: NDArray[np.int32],
    layer: NDArray[np.int32],
    table: NDArray[np.uint16],
    until: NDArray[np.int32],
    since: NDArray[np.int32],
    ends: NDArray[np.int64],
    delays: NDArray[np.int64],
    limits: NDArray[np.int64],
    nodes: NDArray[np.int32],
    keys: NDArray[np.int64],
    items: NDArray[np.int32],
    paths: NDArray[np.int32],
    lengths: NDArray[np.int64],
    placed: NDArray[np.bool_],
    timed: bool,
    budget: int,
) -> int:
    """Plan the robots of ``order`` one after the other past those that are ``placed``, and place them.

    ``budget``: greatest number of steps of all robots of ``order`` together; -1 = any.

    Returns:
        How many were placed before one failed.
    """
    after = np.int64(0)  # what the robots still to come need at least
    for k in range(len(order)):
        after += ahead[order[k], ends[order[k], 0]] // 4096
    for k in range(len(order)):
        robot = order[k]
        last = np.int64(0)
        for other in range(len(lengths)):
            if placed[other]:
                last = max(last, lengths[other])
        after -= ahead[robot, ends[robot, 0]] // 4096
        limits[0] = (budget - after) * 4096 + 4095 if budget >= 0 else 2**31 - 1
        if timed:
            steps = find_route(
                neighbours, ahead[robot], base, layer, table, until, since, last, ends[robot],
                limits, nodes, keys, items, paths[robot],
            )  # fmt: skip
        else:
            steps = find_quick_route(
                neighbours, ahead[robot], table, until, since, ends[robot], delays[robot],
                limits, nodes, keys, items, paths[robot],
            )  # fmt: skip
        if steps < 0:
            return k
        budget = budget - steps if budget >= 0 else budget
        lengths[robot] = steps
        placed[robot] = True
        reserve(paths[robot], steps, neighbours, padded, at, begins, entries, table, until, since)
    return len(order)


@leaf
def _place_all(
    neighbours: NDArray[np.int32],
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    table: NDArray[np.uint16],
    until: NDArray[np.int32],
    since: NDArray[np.int32],
    paths: NDArray[np.int32],
    lengths: NDArray[np.int64],
    placed: NDArray[np.bool_],
) -> None:
    for robot in range(len(lengths)):
        if placed[robot]:
            reserve(paths[robot], lengths[robot], neighbours, padded, at, begins, entries, table, until, since)


@leaf
def _clear_some(
    robots: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    table: NDArray[np.uint16],
    until: NDArray[np.int32],
    since: NDArray[np.int32],
    paths: NDArray[np.int32],
    lengths: NDArray[np.int64],
) -> None:
    for k in range(len(robots)):
        r = robots[k]
        clear(paths[r], lengths[r], neighbours, padded, at, begins, entries, table, until, since)


@leaf
def _plan_group(
    group: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    ahead: NDArray[np.int32],
    base: NDArray[np.int32],
    layer: NDArray[np.int32],
    table: NDArray[np.uint16],
    until: NDArray[np.int32],
    since: NDArray[np.int32],
    ends: NDArray[np.int64],
    delays: NDArray[np.int64],
    limits: NDArray[np.int64],
    nodes: NDArray[np.int32],
    keys: NDArray[np.int64],
    items: NDArray[np.int32],
    paths: NDArray[np.int32],
    lengths: NDArray[np.int64],
    placed: NDArray[np.bool_],
    timed: bool,
    budget: int,
    kept_paths: NDArray[np.int32],
    kept_lengths: NDArray[np.int64],
    anew: bool,
) -> int:
    """Plan robots; where ``anew``, they are placed, and keep their old paths unless the sum of steps is no larger.

    One kernel for both, since the searches in it take long to compile. ``kept_paths`` and ``kept_lengths`` have
    ``paths``' and ``lengths``' shapes; they are scratch.

    Returns:
        How many robots were placed before one failed; where ``anew`` the steps saved, -1 if the old paths were kept.
    """
    if anew:
        budget = 0
        for k in range(len(group)):
            robot = group[k]
            budget += int(lengths[robot])
            kept_lengths[robot] = lengths[robot]
            for t in range(lengths[robot] + 1):
                kept_paths[robot, t] = paths[robot, t]
        _clear_some(group, neighbours, padded, at, begins, entries, table, until, since, paths, lengths)
        for k in range(len(group)):
            placed[group[k]] = False
        _place_all(neighbours, padded, at, begins, entries, table, until, since, paths, lengths, placed)
    planned = _plan_in_order(
        group, neighbours, padded, at, begins, entries, ahead, base, layer, table, until, since, ends, delays,
        limits, nodes, keys, items, paths, lengths, placed, timed, budget,
    )  # fmt: skip
    if not anew:
        return planned
    if planned == len(group):
        for k in range(len(group)):
            budget -= int(lengths[group[k]])
        return budget
    _clear_some(group[:planned], neighbours, padded, at, begins, entries, table, until, since, paths, lengths)
    for k in range(len(group)):
        robot = group[k]
        lengths[robot] = kept_lengths[robot]
        placed[robot] = True
        for t in range(lengths[robot] + 1):
            paths[robot, t] = kept_paths[robot, t]
    _place_all(neighbours, padded, at, begins, entries, table, until, since, paths, lengths, placed)
    return -1


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
        delays: (k,) steps that each robot waits at its start before it leaves, so that others get past; 0 unless set.
        ahead: (k, n) int32 what the rest of the way costs from every place.
        alone: (k,) steps that each robot needs without the others.
    """

    def __init__(
        self, graph: GridGraph, ends: NDArray[np.int64], surcharge: NDArray[np.int32] | None = None, timed: bool = False
    ) -> None:
        self.graph, self.ends = graph, ends
        places, team = len(graph), len(ends)
        if surcharge is None:
            self.ahead = np.array([graph.ahead(int(goal)) for _, goal in ends], np.int32).reshape(team, places)
        else:
            self.ahead = np.array([graph.ahead_with(int(goal), surcharge) for _, goal in ends]).reshape(team, places)
        self.alone = np.array([int(graph.ahead(int(goal))[start]) for start, goal in ends], np.int64) // int(STEP)
        # no layer of states beyond it is ever searched: everyone in turn, in the worst order, is far more than needed
        reached = self.alone[self.alone < int(UNREACHABLE // STEP)]
        self.capacity = int(2 * reached.max(initial=0) + 4 * team + 64)
        self.base = np.zeros(places, np.int32) if surcharge is None else surcharge
        self.timed = timed or surcharge is not None
        self.layer = np.zeros((1, places), np.int32)
        self._tables = graph.borrow(self.capacity)
        work = self._tables
        self.table, self.until, self.since = work.table, work.until, work.since
        self.nodes, self.keys, self.items, self.limits = work.nodes, work.keys, work.items, work.limits
        self.limits[:2] = NO_BOUND
        self.delays = np.zeros(team, np.int64)
        self.paths = np.zeros((team, self.capacity), np.int32)
        self.lengths = np.zeros(team, np.int64)
        self.placed = np.zeros(team, np.bool_)
        self._kept_paths, self._kept_lengths = np.zeros_like(self.paths), np.zeros_like(self.lengths)

    def __len__(self) -> int:
        """Number of robots."""
        return len(self.ends)

    def close(self) -> None:
        """Empty the tables and give the room for searches back; the paths stay."""
        _clear_some(
            np.flatnonzero(self.placed),
            self.graph.neighbours,
            *self._footprints,
            self.table,
            self.until,
            self.since,
            self.paths,
            self.lengths,
        )
        self.graph.give_back(self._tables)

    @property
    def _arrays(self) -> tuple[Any, ...]:
        """The arguments that the kernels of planning share, in their order."""
        return (
            self.graph.neighbours,
            *self._footprints,
            self.ahead,
            self.base,
            self.layer,
            self.table,
            self.until,
            self.since,
            self.ends,
            self.delays,
            self.limits,
            self.nodes,
            self.keys,
            self.items,
            self.paths,
            self.lengths,
            self.placed,
            self.timed,
        )

    @property
    def _footprints(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int64], NDArray[np.int64]]:
        return self.graph.padded, self.graph.at, self.graph.begins, self.graph.entries

    def plan(self, order: NDArray[np.int64], budget: int = -1) -> int:
        """Plan robots one after the other past those that are placed, and place them.

        Args:
            order: The robots, first the one with the highest priority.
            budget: Greatest number of steps of all of them together; -1 = any.

        Returns:
            How many were placed before one failed.
        """
        return _plan_group(order, *self._arrays, budget, self._kept_paths, self._kept_lengths, False)

    def replan(self, group: NDArray[np.int64]) -> int:
        """Plan robots, all of them placed, anew in this order; the old paths stay unless the sum is no larger.

        Returns:
            Steps saved; -1 if the old paths were kept.
        """
        saved: int = _plan_group(group, *self._arrays, -1, self._kept_paths, self._kept_lengths, True)
        return saved

    def remove(self, robots: NDArray[np.int64]) -> None:
        """Take robots' paths out of the tables; the paths themselves stay where they are."""
        arrays = (
            self.graph.neighbours,
            *self._footprints,
            self.table,
            self.until,
            self.since,
            self.paths,
            self.lengths,
        )
        _clear_some(robots[self.placed[robots]], *arrays)
        self.placed[robots] = False
        _place_all(*arrays, self.placed)

    def place(self, robots: NDArray[np.int64]) -> None:
        """Enter robots' paths, as they are, into the tables."""
        for robot in robots:
            r = int(robot)
            arrays = (self.graph.neighbours, *self._footprints, self.table, self.until, self.since)
            reserve(self.paths[r], self.lengths[r], *arrays)
        self.placed[robots] = True

    @property
    def expanded(self) -> int:
        """States that the last search expanded."""
        return int(self.limits[3])

    def cost(self) -> int:
        """Steps of all robots together."""
        return int(self.lengths.sum())

    def cells(self) -> list[NDArray[np.int64]]:
        """The paths as cells, (T, 2) each."""
        return [self.graph.cells[path[: n + 1]] for path, n in zip(self.paths, self.lengths, strict=True)]
