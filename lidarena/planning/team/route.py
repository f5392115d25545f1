"""A* in space and time: the cheapest way of one robot past everything that is reserved, where places cost by time.

Bennewitz & Burgard's second search (its section 2), in which a state is a place at a time. Three things make it fast:
the exact distance to the goal as heuristic instead of the straight line; look-ups instead of other robots' paths; and
one single layer of states for all times after the last other robot has come to rest, since nothing changes any more.
With that layer the search needs no horizon: a robot for which it finds nothing has no way, whatever the number of
steps.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.search_arrays import PlaceCosts, Reservations, SearchMemory, counts_at, entry_of

NO_WAY = -1
"""Every state has been searched."""
GAVE_UP = -2
"""The limit of states, the bound on the cost, or the room for the path was too small."""


@leaf
def free_from(reserved: Reservations, goal: int) -> int:
    """The first time from which on nobody comes too close to ``goal``; -1 if somebody rests there."""
    if reserved.since[goal, 0] < 2**30:
        return -1
    t = int(reserved.until[goal])
    while t > 0:
        row = reserved.rows[goal, (t - 1) >> 4]
        if row == 0:  # nobody comes close in this span
            t = (t - 1) & ~15
        elif reserved.counts[row, (t - 1) & 15] & 15:
            break
        else:
            t -= 1
    return t


@inlined
def at_least(cost: int, rest: int) -> int:
    """A cost that ends at ``rest`` or later, all its small units set, which then do not rank what is equally late."""
    return max(cost, rest * 4096 + 4095 if rest > 0 else 0)


@leaf
def _trace(nodes: NDArray[np.int64], entry: int, times: int, path: NDArray[np.int32]) -> int:
    """Write the places that lead to the state of ``entry`` into ``path``; return the number of steps, or GAVE_UP."""
    length = 0
    at = entry
    while nodes[at, 3] >= 0:
        at = nodes[at, 3]
        length += 1
    if length >= len(path):
        return -2
    at = entry
    for t in range(length, -1, -1):
        path[t] = nodes[at, 0] // times
        at = nodes[at, 3]
    return length


@leaf
def _expand(
    neighbours: NDArray[np.int32],
    costs: PlaceCosts,
    reserved: Reservations,
    last: int,
    rest: int,
    stamp: int,
    entry: int,
    memory: SearchMemory,
    size: int,
) -> int:
    """Offer what the free moves from the state of ``entry`` lead to; return the open list's size.

    Sets the sign of ``memory.limits[0]`` where the bound was in the way. The other arguments are ``find_route``'s.
    """
    nodes, limits, layer = memory.nodes, memory.limits, costs.layer
    times = reserved.rows.shape[1] * 16
    here, t = nodes[entry, 0] // times, nodes[entry, 0] % times
    later, row = min(t + 1, last), min(t + 1, len(layer) - 1)
    taken = counts_at(reserved, here, t) if t < last else 0
    most = limits[0] if limits[0] >= 0 else ~limits[0]
    for m in range(9):
        there = int(neighbours[here, m])
        if there < 0 or taken >> 4 * m & 15 or t >= reserved.since[here, m]:
            continue
        spent = int(nodes[entry, 2]) + 4096 + (1 if m > 4 else 0) + costs.base[there] + layer[row, there]
        following = entry_of(nodes, there * times + later, stamp)
        met = nodes[following, 1] >= stamp
        if met and nodes[following, 2] <= spent:
            continue  # one that is closed is opened again if it can be had for less: ``rest`` hides what that costs
        cost = at_least(spent + costs.ahead[there], rest)
        if cost > most:
            limits[0] = ~most
            continue
        limits[4] += 0 if met else 1
        nodes[following, 0], nodes[following, 1] = there * times + later, stamp
        nodes[following, 2], nodes[following, 3] = spent, entry
        size = push(memory.keys, memory.items, size, (cost << 31) - (spent ^ 4095), following)
    return size


@leaf
def find_route(
    neighbours: NDArray[np.int32],
    costs: PlaceCosts,
    reserved: Reservations,
    last: int,
    ends: NDArray[np.int64],
    memory: SearchMemory,
    path: NDArray[np.int32],
) -> int:
    """Find a way from ``ends[0]`` to ``ends[1]``.

    Args:
        neighbours: (n, 9) where moves lead.
        costs: Of the robot: ``ahead`` is (n,).
        reserved: Moves that are taken.
        last: Time at which the last of the other robots has come to rest, below the times of ``reserved``.
        ends: (2,) start and goal.
        memory: The search's limits and memory.
        path: (length,) gets the places, one a time step.

    Returns:
        The number of steps, or NO_WAY or GAVE_UP.
    """
    nodes, keys, items, limits = memory.nodes, memory.keys, memory.items, memory.limits
    times = reserved.rows.shape[1] * 16
    start, goal = ends[0], ends[1]
    stamp = limits[2] + 2  # of a state that was met; one more means that it is closed
    limits[2], limits[3], limits[4] = stamp, 0, 1
    rest = free_from(reserved, goal)
    if rest < 0 or costs.ahead[start] >= 2**30:
        return -1
    entry = entry_of(nodes, start * times, stamp)
    nodes[entry, 0], nodes[entry, 1], nodes[entry, 2], nodes[entry, 3] = start * times, stamp, 0, -1
    cost = at_least(np.int64(costs.ahead[start]), rest)
    if cost > limits[0]:
        return -2
    size = push(keys, items, np.int64(0), cost << 31, entry)
    while size > 0:
        entry = int(items[0])
        size = pop(keys, items, size)
        if nodes[entry, 1] > stamp:
            continue
        nodes[entry, 1] = stamp + 1
        here, t = nodes[entry, 0] // times, nodes[entry, 0] % times
        if here == goal and t >= rest:
            return _trace(nodes, entry, times, path)
        limits[3] += 1
        if limits[3] > limits[1]:
            return -2
        if size + 9 > len(keys) or 4 * (limits[4] + 9) > 3 * len(nodes):
            limits[5] = 1  # search_arrays.NO_STATES
            return -2
        size = _expand(neighbours, costs, reserved, last, rest, stamp, entry, memory, size)
    return -2 if limits[0] < 0 else -1
