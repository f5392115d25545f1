"""Well-formed problems: ones that every order of priority solves (Čáp, Novák, Kleiner & Selecký 2015).

A team's problem is well-formed if every robot has a way from its start to its goal that keeps clear of everybody else's
start and goal. Then it is solvable: let the robots go one after the other.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.team.grid_graph import GridGraph


@leaf
def _reaches(
    neighbours: NDArray[np.int32],
    closed: NDArray[np.bool_],
    start: int,
    goal: int,
    queue: NDArray[np.int32],
    met: NDArray[np.bool_],
) -> bool:
    """Whether a flood from ``start`` over places that are not ``closed`` (n,) comes to ``goal``."""
    met[:] = False
    met[start] = True
    queue[0] = start
    head, tail = 0, 1
    while head < tail:
        here = queue[head]
        head += 1
        if here == goal:
            return True
        for m in range(1, 9):
            there = neighbours[here, m]
            if there >= 0 and not met[there] and not closed[there]:
                met[there] = True
                queue[tail] = there
                tail += 1
    return False


def is_well_formed(graph: GridGraph, starts: NDArray[np.int64], goals: NDArray[np.int64]) -> bool:
    """Return whether a problem is well-formed.

    Args:
        graph: Where the robots can go.
        starts: (k,) places.
        goals: (k,) places.
    """
    cells = graph.cells.astype(np.float64)
    apart = max(graph.apart, 1.0) - 1e-9
    ends = np.stack([starts, goals])  # (2, k)
    near = np.hypot(*(cells[:, None, None] - cells[ends][None]).transpose(3, 0, 1, 2)) < apart  # (n, 2, k)
    queue, met = np.empty(len(graph), np.int32), np.empty(len(graph), np.bool_)
    ends_near = near.sum(axis=(1, 2))
    for robot in range(len(starts)):
        closed = ends_near > near[:, :, robot].sum(axis=1)  # somebody else's end is near
        blocked = closed[starts[robot]] or closed[goals[robot]]
        if blocked or not _reaches(graph.neighbours, closed, starts[robot], goals[robot], queue, met):
            return False
    return True
