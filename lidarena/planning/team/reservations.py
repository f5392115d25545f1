"""Reservation tables: which moves from which place at which time would conflict with the paths planned so far.

Bit ``m`` of ``table[place, t]`` says that move ``m`` from ``place`` in the step from ``t`` to ``t + 1`` is taken, by
robots on their way; from time ``until[place]`` on no bit is set. Robots at their goals stay there: move ``m`` from
``place`` is taken from time ``since[place, m]`` on.
One look-up thus answers for all robots, discs and points alike; an entry costs as many writes as the robots' discs
have cells.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

NEVER = np.int32(2**30)


@leaf
def move_between(neighbours: NDArray[np.int32], here: int, there: int) -> int:
    """Which move leads from one place to another, by ``neighbours`` (n, 9); -1 if none does."""
    for m in range(9):
        if neighbours[here, m] == there:
            return m
    return -1


@leaf
def reserve(
    path: NDArray[np.int32],
    length: int,
    neighbours: NDArray[np.int32],
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    table: NDArray[np.uint16],
    until: NDArray[np.int32],
    since: NDArray[np.int32],
) -> None:
    """Enter a path (at least ``length`` + 1,) of places; the robot stays at the last from time ``length`` on.

    The other arrays are ``GridGraph``' and the tables (n, times), (n,) and (n, 9).
    """
    for t in range(length):
        m = move_between(neighbours, path[t], path[t + 1])
        for e in range(begins[m], begins[m + 1]):
            place = padded[at[path[t]] + entries[e, 0]]
            if place >= 0:
                table[place, t] |= np.uint16(entries[e, 1])
                until[place] = max(until[place], t + 1)
    for e in range(begins[0], begins[1]):
        place = padded[at[path[length]] + entries[e, 0]]
        if place >= 0:
            for b in range(9):
                if entries[e, 1] >> b & 1:
                    since[place, b] = min(since[place, b], length)


@leaf
def clear(
    path: NDArray[np.int32],
    length: int,
    neighbours: NDArray[np.int32],
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    begins: NDArray[np.int64],
    entries: NDArray[np.int64],
    table: NDArray[np.uint16],
    until: NDArray[np.int32],
    since: NDArray[np.int32],
) -> None:
    """Empty every place that a path has entries in; whoever else has some there must be reserved again.

    Arguments as ``reserve``.
    """
    for t in range(length):
        m = move_between(neighbours, path[t], path[t + 1])
        for e in range(begins[m], begins[m + 1]):
            place = padded[at[path[t]] + entries[e, 0]]
            if place >= 0:
                table[place, t] = np.uint16(0)
                until[place] = 0
    for e in range(begins[0], begins[1]):
        place = padded[at[path[length]] + entries[e, 0]]
        if place >= 0:
            since[place, :] = 2**30
