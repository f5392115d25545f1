"""Kernels of distance graphs: all distances, and a negative cycle where there is one."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.temporal.back_propagation import FAR

Ints = NDArray[np.int64]


@kernel
def find_negative_cycle(tail: Ints, head: Ints, weight: Ints, nodes: int) -> Ints:
    """Bellman and Ford: the numbers of the edges of a negative cycle, in the order in which it is walked.

    Args:
        tail: (m,) where each edge begins.
        head: (m,) where each edge ends.
        weight: (m,) [ticks].
        nodes: How many nodes there are.

    Returns:
        (c,) edge numbers; none where there is no such cycle.
    """
    distance = np.zeros(nodes, np.int64)
    via = np.full(nodes, -1, np.int64)
    last = -1
    for _ in range(nodes):
        last = -1
        for edge in range(tail.size):
            if distance[tail[edge]] + weight[edge] < distance[head[edge]]:
                distance[head[edge]] = distance[tail[edge]] + weight[edge]
                via[head[edge]] = edge
                last = head[edge]
        if last < 0:
            return np.empty(0, np.int64)
    for _ in range(nodes):
        last = tail[via[last]]
    cycle = np.empty(nodes, np.int64)
    node, length = last, 0
    while True:
        cycle[length] = via[node]
        node = tail[via[node]]
        length += 1
        if node == last:
            return cycle[:length][::-1].copy()


@kernel
def all_distances(tail: Ints, head: Ints, weight: Ints, nodes: int) -> Ints:
    """Floyd and Warshall: ``[i, j]`` is the length of the shortest path from ``i`` to ``j``, `FAR` without one.

    Args:
        tail: (m,) where each edge begins.
        head: (m,) where each edge ends.
        weight: (m,) [ticks]; without negative cycles.
        nodes: How many nodes there are.

    Returns:
        (nodes, nodes) [ticks].
    """
    distance = np.full((nodes, nodes), FAR, np.int64)
    for node in range(nodes):
        distance[node, node] = 0
    for edge in range(tail.size):
        distance[tail[edge], head[edge]] = min(distance[tail[edge], head[edge]], weight[edge])
    for middle in range(nodes):
        for start in range(nodes):
            first = distance[start, middle]
            if first == FAR:
                continue
            for end in range(nodes):
                second = distance[middle, end]
                if second != FAR and first + second < distance[start, end]:
                    distance[start, end] = first + second
    return distance
