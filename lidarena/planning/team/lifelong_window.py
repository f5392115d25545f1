"""Plans of a few steps for a team that goes on for ever, repaired in large neighbourhoods.

Li et al. (2021, "Lifelong multi-agent path finding in large-scale warehouses") plan a window of steps ahead and forget
about conflicts beyond it. So does this; but a plan is kept from one step to the next, and a few robots at a time are
planned anew past all others (Li et al. 2021, "Anytime multi-agent path finding via large neighborhood search"), so that
it gets better for as long as the window lasts.

What a path costs is the step at which it reaches the robot's goal, or the window and the way that is left after it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel, leaf
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.pibt import random_below
from lidarena.planning.team.reservations import move_between
from lidarena.planning.team.search_arrays import GraphArrays

_LARGEST = 6
"""Robots of a neighbourhood, at most."""


class WindowPlan(NamedTuple):
    """What a team is going to do in the next W steps; k robots, n places.

    Attributes:
        paths: (k, W + 1) int32 places, where each is now first.
        moves: (k, W) int64 the moves between them.
        occupant: (W + 1, n) int32 the robot in each place at each time, -1 nobody.
        costs: (k,) int64 what each path costs.
        group: (L,) int64 scratch: the robots that are planned anew; ``kept`` (L, W + 1) int32 their old paths.
        kept: See ``group``.
        met: (W + 1, n, 2) int32 scratch: the search that met a place at a time, before and after the goal.
        before: (W + 1, n, 2) int32 scratch: the place before, plus n if the goal had been reached there.
        keys: (m,) int64 scratch: the open list; ``items`` (m,) int32.
        items: See ``keys``.
        search: (1,) int32 number of the last search.
    """

    paths: NDArray[np.int32]
    moves: NDArray[np.int64]
    occupant: NDArray[np.int32]
    costs: NDArray[np.int64]
    group: NDArray[np.int64]
    kept: NDArray[np.int32]
    met: NDArray[np.int32]
    before: NDArray[np.int32]
    keys: NDArray[np.int64]
    items: NDArray[np.int32]
    search: NDArray[np.int32]


def waiting_team(places: NDArray[np.int32], count: int, window: int) -> WindowPlan:
    """The plan of a team (k,) that waits where it is, on a graph of ``count`` places."""
    team, states = len(places), 2 * (window + 1) * count
    plan = WindowPlan(
        paths=np.repeat(places[:, None], window + 1, axis=1).astype(np.int32),
        moves=np.zeros((team, window), np.int64),
        occupant=np.full((window + 1, count), -1, np.int32),
        costs=np.zeros(team, np.int64),
        group=np.zeros(_LARGEST, np.int64),
        kept=np.zeros((_LARGEST, window + 1), np.int32),
        met=np.zeros((window + 1, count, 2), np.int32),
        before=np.zeros((window + 1, count, 2), np.int32),
        keys=np.zeros(states, np.int64),
        items=np.zeros(states, np.int32),
        search=np.zeros(1, np.int32),
    )
    plan.occupant[:, places] = np.arange(team, dtype=np.int32)
    return plan


@leaf
def path_cost(path: NDArray[np.int32], goal: int, ahead: NDArray[np.int32]) -> int:
    """What a path (W + 1,) costs a robot, see above; ``ahead`` (n,) is the rest of its way."""
    window = len(path) - 1
    for t in range(1, window + 1):
        if path[t] == goal:
            return t
    return window + int(ahead[path[window]]) // 4096


@inlined
def _is_taken(place: int, move: int, t: int, graph: GraphArrays, plan: WindowPlan) -> bool:
    """Whether a move from a place at a time conflicts with somebody's."""
    base = graph.at[place]
    for e in range(graph.begins[move], graph.begins[move + 1]):
        near = graph.padded[base + graph.entries[e, 0]]
        if near >= 0:
            other = plan.occupant[t, near]
            if other >= 0 and graph.entries[e, 1] >> plan.moves[other, t] & 1:
                return True
    return False


@leaf
def _find_path(
    robot: int,
    goal: int,
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    plan: WindowPlan,
    random: NDArray[np.uint64],
) -> int:
    """Find the cheapest path of a robot that is not entered, into ``plan.paths``; return its cost, -1 without one."""
    window, count = plan.moves.shape[1], len(ahead)
    plan.search[0] += 1
    stamp, start = plan.search[0], np.int64(plan.paths[robot, 0])
    plan.met[0, start, 0] = stamp
    size = push(plan.keys, plan.items, np.int64(0), np.int64(0), 2 * start)
    while size > 0:
        key, item = plan.keys[0], np.int64(plan.items[0])
        size = pop(plan.keys, plan.items, size)
        t, here, done = item // (2 * count), item // 2 % count, item % 2
        cost = key >> 32
        if t == window:
            while t > 0:
                plan.paths[robot, t] = here
                back = np.int64(plan.before[t, here, done])
                here, done, t = back % count, back // count, t - 1
            return int(cost)
        for m in range(9):
            there = np.int64(graph.neighbours[here, m])
            if there < 0 or _is_taken(here, m, t, graph, plan):
                continue
            reached = done if done == 1 or there != goal else np.int64(1)
            if plan.met[t + 1, there, reached] == stamp:
                continue
            plan.met[t + 1, there, reached] = stamp
            plan.before[t + 1, there, reached] = here + done * count
            new = cost
            if done == 0:
                new = t + 1 + (0 if reached == 1 else np.int64(ahead[there]) // 4096)
            rank = (new << 32) + ((window - t) << 12) + random_below(random, 4096)
            size = push(plan.keys, plan.items, size, rank, 2 * ((t + 1) * count + there) + reached)
    return -1


@leaf
def enter(robot: int, neighbours: NDArray[np.int32], plan: WindowPlan) -> None:
    """Enter a robot's path (see ``plan.paths``) where the others' searches see it."""
    window = plan.moves.shape[1]
    for t in range(window + 1):
        plan.occupant[t, plan.paths[robot, t]] = robot
        if t < window:
            plan.moves[robot, t] = move_between(neighbours, plan.paths[robot, t], plan.paths[robot, t + 1])


@inlined
def _take_out(robot: int, plan: WindowPlan) -> None:
    for t in range(plan.paths.shape[1]):
        plan.occupant[t, plan.paths[robot, t]] = -1


@inlined
def _copy(source: NDArray[np.int32], one: int, target: NDArray[np.int32], other: int) -> None:
    for t in range(source.shape[1]):
        target[other, t] = source[one, t]


@leaf
def _replan(
    size: int,
    goals: NDArray[np.int64],
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    plan: WindowPlan,
    random: NDArray[np.uint64],
) -> None:
    """Plan the first ``size`` robots of ``plan.group`` anew, one after the other; keep what is no dearer."""
    budget, planned = np.int64(0), np.int64(0)
    for i in range(size):
        robot = plan.group[i]
        _copy(plan.paths, robot, plan.kept, np.int64(i))
        budget += plan.costs[robot]
        _take_out(robot, plan)
    left = budget
    for i in range(size):
        robot = plan.group[i]
        cost = _find_path(robot, goals[robot], graph, ahead[robot], plan, random)
        if cost < 0 or cost > left:
            break
        left -= cost
        planned += 1
        enter(robot, graph.neighbours, plan)
    if planned < size:
        for i in range(planned):
            _take_out(plan.group[i], plan)
        for i in range(size):
            _copy(plan.kept, np.int64(i), plan.paths, plan.group[i])
            enter(plan.group[i], graph.neighbours, plan)
        return
    for i in range(size):
        robot = plan.group[i]
        plan.costs[robot] = path_cost(plan.paths[robot], goals[robot], ahead[robot])


@leaf
def _add(robot: int, size: int, plan: WindowPlan) -> int:
    """Put a robot into the neighbourhood unless it is there or that is full; return the size."""
    if size == len(plan.group):
        return size
    for i in range(size):
        if plan.group[i] == robot:
            return size
    plan.group[size] = robot
    return size + 1


@leaf
def _gather(
    first: int, most: int, graph: GraphArrays, ahead: NDArray[np.int32], plan: WindowPlan, random: NDArray[np.uint64]
) -> int:
    """Gather a late robot and those in the way of a shortest way of its into ``plan.group``; return how many."""
    size, here = _add(first, np.int64(0), plan), np.int64(plan.paths[first, 0])
    for t in range(plan.moves.shape[1]):
        least, best = ahead[first, here], np.int64(0)
        offset = random_below(random, 8)
        for i in range(8):
            m = 1 + (i + offset) % 8
            there = graph.neighbours[here, m]
            if there >= 0 and ahead[first, there] < least:
                least, best = ahead[first, there], np.int64(m)
        base = graph.at[here]
        for e in range(graph.begins[best], graph.begins[best + 1]):
            near = graph.padded[base + graph.entries[e, 0]]
            other = plan.occupant[t, near] if near >= 0 else np.int32(-1)
            if other >= 0 and graph.entries[e, 1] >> plan.moves[other, t] & 1 and size < most:
                size = _add(np.int64(other), size, plan)
        here = np.int64(graph.neighbours[here, best])
    return int(size)


@kernel
def improve(
    rounds: int,
    goals: NDArray[np.int64],
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    plan: WindowPlan,
    random: NDArray[np.uint64],
) -> int:
    """Plan late robots anew, then neighbourhoods; return what all paths cost together.

    Args:
        rounds: Neighbourhoods.
        goals: (k,) places.
        graph: Where moves lead, and which conflict.
        ahead: (k, n) cost of the rest of each robot's way.
        plan: The plan, everybody entered; changed in place.
        random: (1,) state of the generator.
    """
    team, total = len(goals), np.int64(0)
    for robot in range(team):
        plan.costs[robot] = path_cost(plan.paths[robot], goals[robot], ahead[robot])
    for i in range(team + rounds):
        first = np.int64(i) if i < team else np.int64(random_below(random, team))
        if plan.costs[first] <= ahead[first, plan.paths[first, 0]] // 4096:
            continue
        most = 1 if i < team else min(2 + random_below(random, len(plan.group) - 1), team)
        size = _gather(first, most, graph, ahead, plan, random)
        while size < most:
            size = _add(random_below(random, team), size, plan)
        for j in range(size - 1, 0, -1):
            other = random_below(random, j + 1)
            plan.group[j], plan.group[other] = plan.group[other], plan.group[j]
        _replan(size, goals, graph, ahead, plan, random)
    for robot in range(team):
        total += plan.costs[robot]
    return int(total)


@leaf
def adopt_if_cheaper(
    future: NDArray[np.int32],
    goals: NDArray[np.int64],
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    plan: WindowPlan,
    always: bool,
) -> bool:
    """Put another plan in the place of one that is dearer.

    Args:
        future: (W + 1, k) the other plan's places.
        goals: (k,) places.
        graph: Where moves lead.
        ahead: (k, n) cost of the rest of each robot's way.
        plan: The plan, everybody entered; changed in place.
        always: Whether to take the other one whatever it costs.
    """
    gain = np.int64(0)
    for robot in range(len(goals)):
        gain += path_cost(plan.paths[robot], goals[robot], ahead[robot])
        gain -= path_cost(future[:, robot], goals[robot], ahead[robot])
    if gain <= 0 and not always:
        return False
    for robot in range(len(goals)):
        _take_out(robot, plan)
    for robot in range(len(goals)):
        for t in range(len(future)):
            plan.paths[robot, t] = future[t, robot]
        enter(robot, graph.neighbours, plan)
    return True
