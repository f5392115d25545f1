"""The quickest way of one robot past everything that is reserved, by safe intervals (SIPP, Phillips & Likhachev 2011).

Where time alone is to be saved, a robot that reaches a place earlier can do all that one which comes later can, as long
as it may wait there. So a state is a place in a stretch of time during which nobody comes too close, not a place at a
time: a robot that has to wait a hundred steps for another costs one state, not a hundred times the whole map.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.route import at_least, free_from
from lidarena.planning.team.search_arrays import Reservations, SearchMemory, counts_at, entry_of


@leaf
def _begin(reserved: Reservations, place: int, t: int) -> int:
    """When the stretch of waiting in ``place`` begins that ``t`` belongs to."""
    begin = min(t, int(reserved.until[place]))
    while begin > 0 and not counts_at(reserved, place, begin - 1) & 15:
        begin -= 1
    return begin


@leaf
def _end(reserved: Reservations, place: int, t: int) -> int:
    """The last time that a robot in ``place`` at ``t`` can be there without a move; 2**30 = for ever."""
    final = int(reserved.since[place, 0])
    for end in range(t, min(int(reserved.until[place]), final)):
        if counts_at(reserved, place, end) & 15:
            return end
    return max(final, t)


@leaf
def _trace(nodes: NDArray[np.int64], entry: int, times: int, path: NDArray[np.int32]) -> int:
    """Write the places that lead to the state of ``entry``, waits included; return the steps, or GAVE_UP."""
    length = int(nodes[entry, 2]) // 4096
    if length >= len(path):
        return -2
    at, end = entry, length
    while at >= 0:
        arrival = int(nodes[at, 2]) // 4096
        if nodes[at, 3] < 0:
            arrival = 0  # it starts there, with a delay if there is one
        for t in range(arrival, end + 1):
            path[t] = nodes[at, 0] // times
        end = arrival - 1
        at = int(nodes[at, 3])
    return length


@leaf
def _offer(memory: SearchMemory, stamp: int, state: int, spent: int, before: int, cost: int, size: int) -> int:
    """Put a state on the open list unless it was reached as cheaply before; return the list's size."""
    nodes = memory.nodes
    entry = entry_of(nodes, state, stamp)
    if nodes[entry, 1] < stamp:
        memory.limits[4] += 1
    elif nodes[entry, 2] <= spent:
        return size
    nodes[entry, 0], nodes[entry, 1], nodes[entry, 2], nodes[entry, 3] = state, stamp, spent, before
    return push(memory.keys, memory.items, size, (cost << 31) - (spent ^ 4095), entry)


@leaf
def _depart(
    neighbours: NDArray[np.int32],
    ahead: NDArray[np.int32],
    reserved: Reservations,
    entry: int,
    m: int,
    rest: int,
    stamp: int,
    memory: SearchMemory,
    size: int,
) -> int:
    """Offer what move ``m`` from the state of ``entry`` leads to: the first departure into each stretch of time there.

    Returns:
        The open list's size, -1 when it is full; sets the sign of ``memory.limits[0]`` where the bound was in the way.
    """
    until, since, limits = reserved.until, reserved.since, memory.limits
    times = reserved.rows.shape[1] * 16
    here, spent = memory.nodes[entry, 0] // times, int(memory.nodes[entry, 2])
    there, t = int(neighbours[here, m]), spent // 4096
    small = (spent & 4095) + (1 if m > 4 else 0)
    most = limits[0] if limits[0] >= 0 else ~limits[0]
    while t < since[here, m]:
        later = t + 1
        if t >= until[here] or not counts_at(reserved, here, t) >> 4 * m & 15:
            cost = at_least(later * 4096 + small + ahead[there], rest)
            if cost > most:
                limits[0] = ~most
                return size
            if size + 1 >= len(memory.keys) or 4 * limits[4] >= 3 * len(memory.nodes):
                return -1
            following = there * times + _begin(reserved, there, later)
            size = _offer(memory, stamp, following, later * 4096 + small, entry, cost, size)
            later = max(_end(reserved, there, later), later)
            if later >= 2**30:
                return size
        while t < later and t < since[here, 0] and (t >= until[here] or not counts_at(reserved, here, t) & 15):
            t += 1
        if t < later:
            return size
    return size


@leaf
def find_quick_route(
    neighbours: NDArray[np.int32],
    ahead: NDArray[np.int32],
    reserved: Reservations,
    ends: NDArray[np.int64],
    delay: int,
    memory: SearchMemory,
    path: NDArray[np.int32],
) -> int:
    """Find the way from ``ends[0]`` to ``ends[1]`` with the fewest steps, among those the fewest diagonals.

    Arguments and result as ``route.find_route``; a place's state is numbered by when its stretch of time begins. The
    robot leaves its start at ``delay`` at the earliest, unless somebody comes too close there before.
    """
    nodes, limits, since = memory.nodes, memory.limits, reserved.since
    times = reserved.rows.shape[1] * 16
    start, goal = ends[0], ends[1]
    stamp = limits[2] + 2
    limits[2], limits[3], limits[4] = stamp, 0, 0
    rest = free_from(reserved, goal)
    if rest < 0 or ahead[start] >= 2**30:
        return -1
    delay = min(delay, _end(reserved, start, np.int64(0)))
    cost = at_least(delay * 4096 + ahead[start], rest)
    if cost > limits[0]:
        return -2
    size = _offer(memory, stamp, start * times, delay * 4096, np.int64(-1), cost, np.int64(0))
    while size > 0:
        entry = int(memory.items[0])
        size = pop(memory.keys, memory.items, size)
        if nodes[entry, 1] > stamp:
            continue
        nodes[entry, 1] = stamp + 1
        here = nodes[entry, 0] // times
        if here == goal and nodes[entry, 0] % times == rest:
            return _trace(nodes, entry, times, path)
        limits[3] += 1
        if limits[3] > limits[1]:
            return -2
        spent = int(nodes[entry, 2])
        for m in range(1, 9):
            if neighbours[here, m] >= 0 and spent // 4096 < since[here, m]:
                size = _depart(neighbours, ahead, reserved, entry, m, rest, stamp, memory, size)
                if size < 0:
                    limits[5] = 1  # search_arrays.NO_STATES
                    return -2
    return -2 if limits[0] < 0 else -1
