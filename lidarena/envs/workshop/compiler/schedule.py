"""Plans in time: when everything ends that is done in a given order, and the best orders, found depth first."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel, leaf

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
_SAME = 2e-3
"""Plans that pass at other times but are the same differ by less [s]."""
_NEXT = 1e-6
"""Who passes comes so much after the other [s]."""


class PlanProblem(NamedTuple):
    """What a schedule needs to know of ``n`` actions at ``L`` locations."""

    before: NDArray[np.bool_]
    """(n, n)"""
    capable: NDArray[np.bool_]
    """(2, n)"""
    usual: Floats
    """(2, n) time of the work [s]"""
    stops: Ints
    """(n, S)"""
    stop_count: Ints
    """(n,)"""
    share: Floats
    """(n, S)"""
    time: Floats
    """(2, L, L, L + 1) of the ways, see ``WorkspaceMotion`` [s]"""
    near: NDArray[np.bool_]
    """(L, L)"""
    tail: Floats
    """(n,) least time of the work from the beginning of each to the end of all that comes after it [s]"""
    order: Ints
    """(n,) the actions, the longest tail first"""


class Snapshot(NamedTuple):
    """What has been done so far, and when each agent is free; of the beginning: nothing, at once."""

    free: Floats
    """(2,) [s]"""
    place: Ints
    """(2,) location at which each is then; -1 for somewhere else, see ``first``"""
    first: Floats
    """(2, L) time of the ways from where each is now [s]"""
    begun: Floats
    """(n,) [s]; infinite for what is open"""
    ended: Floats
    """(n,) [s], of what is under way as it is expected; infinite for what is open"""
    stays: Floats
    """(2, S, 3) location, begin and end of the work at the last locations of each [s]; location -1 for none"""


class Schedule(NamedTuple):
    """When everything happens."""

    makespan: float
    begun: Floats
    """(n,) [s]"""
    ended: Floats
    """(n,) [s]"""
    ways: Floats
    """(n, S) time of the way to each location, waiting for the other to leave it included [s]; NaN of what is done"""
    idle: Floats
    """(2,) time of waiting for each other [s]"""


@inlined
def _beside(stays: Floats, other: int, time: float, nobody: int) -> int:
    """Where the other works at a time; ``nobody`` if it does not."""
    for k in range(stays.shape[1]):
        if stays[other, k, 0] >= 0.0 and stays[other, k, 1] <= time < stays[other, k, 2]:
            return int(stays[other, k, 0])
    return nobody


@leaf
def _do(
    problem: PlanProblem, agent: int, action: int, first: Floats, free: Floats, place: Ints, begun: Floats,
    ended: Floats, stays: Floats, ways: Floats,
) -> float:  # fmt: skip
    """Let an agent do an action as soon as it is free; everything else is updated. Returns how long it waits [s]."""
    time, nobody, waits = free[agent], problem.time.shape[1], 0.0
    begun[action] = time
    here, other, count = place[agent], 1 - agent, problem.stop_count[action]
    for k in range(stays.shape[1]):
        stays[agent, k, 0] = -1.0
    for k in range(count):
        there = problem.stops[action, k]
        alone = first[agent, there] if here < 0 else problem.time[agent, here, there, nobody]
        beside = _beside(stays, other, time + 0.5 * alone, nobody)
        way = alone if here < 0 else problem.time[agent, here, there, beside]
        arrival = time + way
        beside = _beside(stays, other, arrival, nobody)
        if beside != nobody and (problem.near[there, beside] if agent == 0 else problem.near[beside, there]):
            for i in range(stays.shape[1]):
                if stays[other, i, 0] == beside:
                    arrival = max(arrival, stays[other, i, 2])
        ways[action, k] = arrival - time
        start = arrival
        if k == count - 1:
            for i in range(begun.shape[0]):
                if problem.before[i, action]:
                    start = max(start, ended[i])
        waits += start - arrival
        time = start + problem.usual[agent, action] * problem.share[action, k]
        stays[agent, k, 0], stays[agent, k, 1], stays[agent, k, 2] = there, start, time
        here = there
    ended[action], free[agent], place[agent] = time, time, here
    return waits


@inlined
def _has_begun(problem: PlanProblem, begun: Floats, action: int) -> bool:
    """Whether everything that must come before an action has been begun."""
    begins = True
    for i in range(begun.shape[0]):
        begins = begins and not (problem.before[i, action] and begun[i] == np.inf)
    return begins


@kernel
def predict(problem: PlanProblem, snapshot: Snapshot, plan: Ints) -> Schedule:
    """When everything happens if both go on by a plan as soon as they can.

    Args:
        problem: What is to be done.
        snapshot: What has been done so far.
        plan: (2, n) sequences of what is left, -1 behind the last one.

    Returns:
        The schedule; its makespan is infinite if the plan cannot be carried out.
    """
    free, place, stays = snapshot.free.copy(), snapshot.place.copy(), snapshot.stays.copy()
    begun, ended, idle = snapshot.begun.copy(), snapshot.ended.copy(), np.zeros(2)
    ways, at = np.full(problem.share.shape, np.nan), np.zeros(2, np.int64)
    while True:
        left0 = at[0] < plan.shape[1] and plan[0, at[0]] >= 0
        left1 = at[1] < plan.shape[1] and plan[1, at[1]] >= 0
        if not (left0 or left1):
            break
        agent = 0 if left0 and (not left1 or free[0] <= free[1]) else 1
        if not _has_begun(problem, begun, plan[agent, at[agent]]):
            agent = 1 - agent
            if not (left0 if agent == 0 else left1) or not _has_begun(problem, begun, plan[agent, at[agent]]):
                return Schedule(np.inf, begun, ended, ways, idle)
        action = plan[agent, at[agent]]
        for i in range(begun.shape[0]):
            if problem.before[i, action] and begun[i] > free[agent]:
                idle[agent] += begun[i] - free[agent]
                free[agent] = begun[i]
        idle[agent] += _do(problem, agent, action, snapshot.first, free, place, begun, ended, stays, ways)
        at[agent] += 1
    return Schedule(ended.max(), begun, ended, ways, idle)


@kernel
def predict_all(problem: PlanProblem, snapshot: Snapshot, plans: Ints) -> Floats:
    """The makespans (P,) of plans (P, 2, n) [s], see ``predict``."""
    spans = np.empty(plans.shape[0])
    for p in range(plans.shape[0]):
        spans[p] = predict(problem, snapshot, plans[p]).makespan
    return spans


@leaf
def _bound(problem: PlanProblem, free: Floats, begun: Floats, ended: Floats) -> float:
    """No plan that goes on from here ends sooner [s]."""
    least, soonest = 0.0, min(free[0], free[1])
    work = 0.0
    for a in range(begun.shape[0]):
        if begun[a] < np.inf:
            least = max(least, ended[a])
        else:
            least = max(least, soonest + problem.tail[a])
            quickest = np.inf
            for agent in range(2):
                if problem.capable[agent, a]:
                    quickest = min(quickest, problem.usual[agent, a])
            work += quickest
    return max(least, 0.5 * (free[0] + free[1] + work)) if work > 0.0 else least


@inlined
def _is_same(first: Ints, second: Ints) -> bool:
    """Whether two plans (2, n) are the same."""
    same = True
    for agent in range(2):
        for k in range(first.shape[1]):
            same = same and first[agent, k] == second[agent, k]
    return same


@inlined
def _copy(source: Ints, target: Ints) -> None:
    """Write one plan (2, n) over another."""
    for agent in range(2):
        for k in range(source.shape[1]):
            target[agent, k] = source[agent, k]


@leaf
def _keep(spans: Floats, plans: Ints, found: int, span: float, plan: Ints) -> int:
    """Put a plan among the best ones, unless it is there; returns how many there are."""
    most = spans.shape[0]
    for p in range(found):
        if abs(spans[p] - span) < _SAME and _is_same(plans[p], plan):
            return found
    if found == most and span >= spans[most - 1]:
        return found
    found = min(found + 1, most)
    at = found - 1
    while at > 0 and spans[at - 1] > span:
        spans[at] = spans[at - 1]
        _copy(plans[at - 1], plans[at])
        at -= 1
    spans[at] = span
    _copy(plan, plans[at])
    return found


@leaf
def _next_option(problem: PlanProblem, agent: int, k: int, begun: Floats) -> int:
    """The place in ``order``, from ``k`` on, of the next action that an agent may begin; n if there is none."""
    while k < begun.shape[0]:
        action = problem.order[k]
        if begun[action] == np.inf and problem.capable[agent, action] and _has_begun(problem, begun, action):
            break
        k += 1
    return k


@kernel
def search_plans(problem: PlanProblem, snapshot: Snapshot, most: int, nodes: int) -> tuple[Floats, Ints, bool]:
    """The plans of least makespan, by depth-first branch and bound: shared beginnings are scheduled once.

    Args:
        problem: What is to be done.
        snapshot: What has been done so far.
        most: How many plans are wanted.
        nodes: Beginnings of plans that are looked at, at most; the longest chains are looked at first.

    Returns:
        Makespans (P,), the best first [s]; sequences of what is left (P, 2, n), -1 behind the last one; whether no
        other plan is better.
    """
    count, stops = problem.before.shape[0], problem.share.shape[1]
    deep = 2 * count + 3
    free, place = np.zeros((deep, 2)), np.zeros((deep, 2), np.int64)
    begun, ended = np.zeros((deep, count)), np.zeros((deep, count))
    stays, ways = np.zeros((deep, 2, stops, 3)), np.zeros((count, stops))
    cursor, who, passed = np.zeros(deep, np.int64), np.zeros(deep, np.int64), np.zeros(deep, np.bool_)
    length = np.zeros((deep, 2), np.int64)
    plan = np.full((2, count), -1, np.int64)
    spans, plans = np.full(most, np.inf), np.full((most, 2, count), -1, np.int64)
    free[0], place[0], begun[0], ended[0] = snapshot.free, snapshot.place, snapshot.begun, snapshot.ended
    stays[0] = snapshot.stays
    depth, found, looked = 0, 0, 0
    while depth >= 0:
        if cursor[depth] == 0:
            looked += 1
            if looked > nodes:
                return spans[:found], plans[:found], False
            bound = _bound(problem, free[depth], begun[depth], ended[depth])
            complete = begun[depth].max() < np.inf
            if complete:
                plan[0, length[depth, 0] :] = -1
                plan[1, length[depth, 1] :] = -1
                found = _keep(spans, plans, found, ended[depth].max(), plan)
            if complete or (found == most and bound >= spans[most - 1]):
                depth -= 1
                continue
            who[depth] = 0 if free[depth, 0] <= free[depth, 1] else 1
        agent = who[depth]
        k = _next_option(problem, agent, cursor[depth], begun[depth])
        if k > count or (k == count and passed[depth]):
            depth -= 1
            continue
        cursor[depth] = k + 1
        below = depth + 1
        free[below], place[below], begun[below], ended[below] = free[depth], place[depth], begun[depth], ended[depth]
        stays[below], length[below] = stays[depth], length[depth]
        cursor[below], passed[below] = 0, k == count
        if k < count:
            action = problem.order[k]
            _do(problem, agent, action, snapshot.first, free[below], place[below], begun[below], ended[below],
                stays[below], ways)  # fmt: skip
            plan[agent, length[below, agent]] = action
            length[below, agent] += 1
        else:
            free[below, agent] = max(free[depth, agent], free[depth, 1 - agent]) + _NEXT
        depth = below
    return spans[:found], plans[:found], True
