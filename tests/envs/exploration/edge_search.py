"""A slow search for the edge of a map, which the searches of the observations are compared with."""

import heapq
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

UNKNOWN, WALL = -1, 100
Square = tuple[int, int]


def squares_of(grid: NDArray[np.int8]) -> NDArray[np.int64]:
    """The largest of every 2 × 2 cells."""
    return grid.reshape(grid.shape[0] // 2, 2, grid.shape[1] // 2, 2).max(axis=(1, 3)).astype(np.int64)


def lengths_to_the_edge(
    squares: NDArray[np.int64], start: Square, times: Callable[[Square, Square], int | None]
) -> dict[Square, int]:
    """Lengths of the shortest ways to unknown squares, in half squares.

    Args:
        squares: Unknown ones, walls, and others.
        start: Where ways begin.
        times: How many times longer a step from a square to another one counts; None where there is none.
    """
    done: set[Square] = set()
    edge: dict[Square, int] = {}
    queue = [(0, start)]
    while queue:
        length, here = heapq.heappop(queue)
        if here in done:
            continue
        done.add(here)
        if squares[here] == UNKNOWN and here != start:
            edge[here] = length
            continue
        for there in np.ndindex(squares.shape):
            straight = abs(there[0] - here[0]) + abs(there[1] - here[1]) == 1
            diagonal = abs(there[0] - here[0]) == 1 == abs(there[1] - here[1])
            if not (straight or diagonal) or squares[there] == WALL or (diagonal and squares[there] == UNKNOWN):
                continue
            longer = times(here, there)
            if longer is not None:
                heapq.heappush(queue, (length + (2 if straight else 3) * longer, there))
    return edge
