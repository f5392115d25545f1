"""The quickest way of one robot past everything that is reserved, by safe intervals (SIPP, Phillips & Likhachev 2011).

Where time alone is to be saved, a robot that reaches a place earlier can do all that one which comes later can, as long
as it may wait there. So a state is a place in a stretch of time during which nobody comes too close, not a place at a
time: a robot that has to wait a hundred steps for another costs one state, not a hundred times the whole map.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.route import at_least, free_from
from lidarena.planning.team.search_arrays import Reservations, SearchMemory, counts_at, entry_of

_NONE = 2**62
"""A rank behind all others."""


@inlined
def _begin(reserved: Reservations, place: int, t: int) -> int:
    """When the stretch of waiting in ``place`` begins that ``t`` belongs to."""
    begin = min(t, int(reserved.until[place]))
    while begin > 0:
        row = reserved.rows[place, (begin - 1) >> 4]
        if row == 0:  # nobody comes close in this span
            begin = (begin - 1) & ~15
        elif reserved.counts[row, (begin - 1) & 15] & 15:
            break
        else:
            begin -= 1
    return begin


@inlined
def _end(reserved: Reservations, place: int, t: int) -> int:
    """The last time that a robot in ``place`` at ``t`` can be there without a move; 2**30 = for ever."""
    final = int(reserved.since[place, 0])
    last, end = min(int(reserved.until[place]), final), t
    while end < last:
        row = reserved.rows[place, end >> 4]
        if row == 0:
            end = (end | 15) + 1
        elif reserved.counts[row, end & 15] & 15:
            return end
        else:
            end += 1
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


class _Expansion(NamedTuple):
    """A state whose moves are offered.

    Attributes:
        entry: Of the state.
        place: Its place.
        begin: When the robot is there at the earliest.
        leave: When it has to leave at the latest.
        rest: As ``at_least`` takes it.
        level: Greatest cost of what is offered now; what costs more is put off.
        again: Whether some of its moves were put off before, so that what costs less has been offered.
    """

    entry: int
    place: int
    begin: int
    leave: int
    rest: int
    level: int
    again: bool


@inlined
def _key(cost: int, ahead: int) -> int:
    """The rank of a state in the open list: by its cost, equal ones by what is still ahead."""
    return (cost << 31) + ahead


@inlined
def _offer(memory: SearchMemory, state: int, spent: int, before: int, key: int, rest: int, size: int) -> int:
    """Put a state on the open list unless it was reached as cheaply before; return the list's size.

    As long as the goal is not free yet all states cost the same, and the search makes for the goal whatever the time.
    Closed states to which there is an earlier way come behind all others then, by time: each of them only once.
    """
    nodes, stamp = memory.nodes, memory.limits[2]
    entry = entry_of(nodes, state, stamp)
    if nodes[entry, 1] < stamp:
        memory.limits[4] += 1
    elif nodes[entry, 2] <= spent:
        return size
    elif nodes[entry, 1] > stamp and key >> 31 == at_least(np.int64(0), rest):
        key = _key(key >> 31, 2**30 + spent // 4096)
    nodes[entry, 0], nodes[entry, 1], nodes[entry, 2], nodes[entry, 3] = state, stamp, spent, before
    return push(memory.keys, memory.items, size, key, entry)


@inlined
def _depart(
    there: int,
    m: int,
    ahead: NDArray[np.int32],
    reserved: Reservations,
    of: _Expansion,
    memory: SearchMemory,
    size: int,
) -> int:
    """Offer what a move leads to: the first departure into each stretch of time there.

    Args:
        there: Where it leads.
        m: The move.
        ahead: (n,) cost of the way from each place.
        reserved: Moves that are taken.
        of: Where from.
        memory: As ``find_quick_route`` takes it; the state's node gets the least rank of what is put off.
        size: Of the open list.

    Returns:
        The open list's size, -1 when it is full; sets the sign of ``memory.limits[0]`` where the bound was in the way.
    """
    nodes, limits = memory.nodes, memory.limits
    times = reserved.rows.shape[1] * 16
    here, t = of.place, of.begin
    small = (nodes[of.entry, 2] & 4095) + (1 if m > 4 else 0)
    most = limits[0] if limits[0] >= 0 else ~limits[0]
    while t <= of.leave and t < reserved.since[here, m]:
        later = t + 1
        spent = later * 4096 + small
        cost = at_least(spent + ahead[there], of.rest)
        if cost > most:
            limits[0] = ~most
            return size
        if cost > of.level:
            nodes[of.entry, 4] = min(nodes[of.entry, 4], _key(cost, int(ahead[there])))
            return size
        if t >= reserved.until[here] or not counts_at(reserved, here, t) >> 4 * m & 15:
            if size + 2 >= len(memory.keys) or 4 * limits[4] >= 3 * len(nodes):
                return -1
            if not of.again or cost == of.level:
                following = there * times + _begin(reserved, there, later)
                size = _offer(memory, following, spent, of.entry, _key(cost, int(ahead[there])), of.rest, size)
            later = max(_end(reserved, there, later), later)
        t = later
    return size


@leaf
def find_quick_route(  # noqa: C901 - the loop of a search
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
    nodes, limits = memory.nodes, memory.limits
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
    key = _key(cost, int(ahead[start]))
    size = _offer(memory, start * times, delay * 4096, np.int64(-1), key, rest, np.int64(0))
    while size > 0:
        key, entry = memory.keys[0], int(memory.items[0])
        size = pop(memory.keys, memory.items, size)
        again = nodes[entry, 1] > stamp
        if again and nodes[entry, 4] != key:
            continue
        nodes[entry, 1] = stamp + 1
        here = nodes[entry, 0] // times
        if here == goal and nodes[entry, 0] % times == rest:
            return _trace(nodes, entry, times, path)
        limits[3] += 1
        if limits[3] > limits[1]:
            return -2
        t = int(nodes[entry, 2]) // 4096
        of = _Expansion(entry, here, t, _end(reserved, here, t), rest, key >> 31, again)
        nodes[entry, 4] = _NONE
        for m in range(1, 9):
            if neighbours[here, m] >= 0 and size >= 0:
                size = _depart(int(neighbours[here, m]), m, ahead, reserved, of, memory, size)
        if size < 0:
            limits[5] = 1  # search_arrays.NO_STATES
            return -2
        if nodes[entry, 4] < _NONE:
            size = push(memory.keys, memory.items, size, nodes[entry, 4], entry)
    return -2 if limits[0] < 0 else -1
