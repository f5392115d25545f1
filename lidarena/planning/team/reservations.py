"""Reservation tables: which moves from which place at which time would conflict with the paths planned so far.

One look-up in them (see ``search_arrays.Reservations``) answers for all robots, discs and points alike; an entry costs
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
def _mark(path: NDArray[np.int32], length: int, graph: GraphArrays, reserved: Reservations, taken: bool) -> None:
    """Reserve the moves that conflict with a path, or empty every place that has some of them."""
    for t in range(length):
        m = move_between(graph.neighbours, path[t], path[t + 1])
        for e in range(graph.begins[m], graph.begins[m + 1]):
            place = graph.padded[graph.at[path[t]] + graph.entries[e, 0]]
            if place < 0:
                continue
            if taken:
                reserved.table[place, t] |= np.uint16(graph.entries[e, 1])
                reserved.until[place] = max(reserved.until[place], t + 1)
            else:
                reserved.table[place, t] = np.uint16(0)
                reserved.until[place] = 0
    for e in range(graph.begins[0], graph.begins[1]):
        place = graph.padded[graph.at[path[length]] + graph.entries[e, 0]]
        if place < 0:
            continue
        for b in range(9):
            if not taken:
                reserved.since[place, b] = 2**30
            elif graph.entries[e, 1] >> b & 1:
                reserved.since[place, b] = min(reserved.since[place, b], length)


@leaf
def reserve(path: NDArray[np.int32], length: int, graph: GraphArrays, reserved: Reservations) -> None:
    """Enter a path (at least ``length`` + 1,) of places; the robot stays at the last from time ``length`` on."""
    _mark(path, length, graph, reserved, True)


@leaf
def clear(path: NDArray[np.int32], length: int, graph: GraphArrays, reserved: Reservations) -> None:
    """Empty every place that a path has entries in; other robots that have some there must be reserved again."""
    _mark(path, length, graph, reserved, False)
