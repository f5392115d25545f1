"""Reservation tables: which moves from which place at which time would conflict with the paths planned so far.

One look-up in them (see ``search_arrays.Reservations``) answers for all robots, discs and points alike; a step costs
as many writes as the robots' discs have cells.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.planning.team.search_arrays import GraphArrays, Reservations


@leaf
def move_between(neighbours: NDArray[np.int32], here: int, there: int) -> int:
    """Which move leads from one place to another, by ``neighbours`` (n, 9); -1 if none does."""
    for m in range(9):
        if neighbours[here, m] == there:
            return m
    return -1


@inlined
def row_of(reserved: Reservations, place: int, t: int) -> int:
    """The row of the counts for a place at a time, a new one where there is none."""
    row = int(reserved.rows[place, t >> 4])
    if row == 0:
        row = int(reserved.used[0])
        reserved.used[0] += 1
        reserved.rows[place, t >> 4] = row
        reserved.owners[row] = place * reserved.rows.shape[1] + (t >> 4)
    return row


@leaf
def has_room(length: int, graph: GraphArrays, reserved: Reservations) -> bool:
    """Whether a path of so many steps can be reserved, however many rows it needs."""
    most = np.int64(0)
    for m in range(len(graph.begins) - 1):
        most = max(most, graph.begins[m + 1] - graph.begins[m])
    return bool(reserved.used[0] + (length + 1) * most < len(reserved.counts))


@inlined
def _count(path: NDArray[np.int32], length: int, graph: GraphArrays, reserved: Reservations, sign: int) -> None:
    """Add or take off what the moves of a path are in the way of."""
    for t in range(length):
        m = move_between(graph.neighbours, path[t], path[t + 1])
        for e in range(graph.begins[m], graph.begins[m + 1]):
            place = graph.padded[graph.at[path[t]] + graph.entries[e, 0]]
            if place >= 0:
                reserved.counts[row_of(reserved, place, t), t & 15] += sign * graph.entries[e, 2]
                reserved.until[place] = max(reserved.until[place], t + 1)


@leaf
def rest(place: int, time: int, graph: GraphArrays, reserved: Reservations) -> None:
    """Enter that a robot stays in a place from a time on."""
    for e in range(graph.begins[0], graph.begins[1]):
        near = graph.padded[graph.at[place] + graph.entries[e, 0]]
        if near >= 0:
            for b in range(9):
                if graph.entries[e, 1] >> b & 1:
                    reserved.since[near, b] = min(reserved.since[near, b], time)


@leaf
def reserve(path: NDArray[np.int32], length: int, graph: GraphArrays, reserved: Reservations) -> None:
    """Enter a path (at least ``length`` + 1,) of places; the robot stays at the last from time ``length`` on.

    There must be room for it, see ``has_room``.
    """
    _count(path, length, graph, reserved, 1)
    rest(path[length], length, graph, reserved)


@leaf
def clear(path: NDArray[np.int32], length: int, graph: GraphArrays, reserved: Reservations) -> None:
    """Take a path out. Whoever rests near the end of it must be entered again with ``rest``."""
    _count(path, length, graph, reserved, -1)
    for e in range(graph.begins[0], graph.begins[1]):
        near = graph.padded[graph.at[path[length]] + graph.entries[e, 0]]
        if near >= 0:
            for b in range(9):
                reserved.since[near, b] = 2**30


@leaf
def release(reserved: Reservations) -> None:
    """Give all rows back, once nothing is reserved any more."""
    blocks = reserved.rows.shape[1]
    for row in range(1, reserved.used[0]):
        reserved.rows[reserved.owners[row] // blocks, reserved.owners[row] % blocks] = 0
    reserved.used[0] = 1
    for place in range(len(reserved.until)):
        reserved.until[place] = 0
