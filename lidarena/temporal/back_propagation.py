"""The kernel of Morris's check of dynamic controllability: back-propagation from every negative node, O(n³).

In normal form every contingent link ``(A, x, y, C)`` with ``x < y`` has a point ``A'`` of its own, exactly ``x`` after
``A``: its lower-case edge is ``A' –c:0→ C``, its upper-case edge ``C –C:−(y − x)→ A'``. Only such a point is entered by
an upper-case edge, so that whatever is derived towards it stems from that edge, and towards any other point does not.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel

FAR = np.iinfo(np.int64).max // 4
"""The distance of what is not connected."""
NO_EDGE = -1

Ints = NDArray[np.int64]


class NormalForm(NamedTuple):
    """An STNU as the kernel takes it, times in ticks: ``n`` points, ``m`` ordinary edges, ``k`` contingent links.

    Edge ``e`` says that ``head − tail ≤ weight``. The point ``A'`` of link ``j`` is ``n + j``; the edges that tie it to
    ``A``, and those of a link whose bounds are equal, are among the ordinary ones.
    """

    tail: Ints
    """(m,)"""
    head: Ints
    """(m,)"""
    weight: Ints
    """(m,) [ticks]"""
    contingent: Ints
    """(k,) the point ``C`` of each link"""
    slack: Ints
    """(k,) ``y − x`` [ticks]; 0 where the link is a plain requirement"""
    points: int
    """``n``"""


class Propagation(NamedTuple):
    """What back-propagation found, for the ``r`` negative nodes in rows of ``p = n + k`` nodes.

    ``via[row, u]`` is the first edge of the shortest reduced path from ``u`` to the row's node: an ordinary edge's
    number, ``m + j`` the lower-case and ``m + k + j`` the upper-case edge of link ``j``, ``−2 − v`` one derived to
    ``v``.
    """

    controllable: bool
    row: Ints
    """(p,) the row of a negative node, −1 of others"""
    distance: Ints
    """(r, p) [ticks], `FAR` where there is no such path"""
    via: Ints
    """(r, p)"""
    pending: Ints
    """The nodes whose back-propagation was under way when one of them came again, the first one outermost."""
    again: int
    """The node that came again; −1 where none did."""


@inlined
def _rise(heap: Ints, place: Ints, distance: Ints, at: int) -> None:
    """Move a node up in the heap (p,) until its parent is nearer; ``place`` (p,) says where each node is."""
    node = heap[at]
    while at > 0:
        above = (at - 1) >> 1
        if distance[heap[above]] <= distance[node]:
            break
        heap[at] = heap[above]
        place[heap[at]] = at
        at = above
    heap[at] = node
    place[node] = at


@inlined
def _take_least(heap: Ints, place: Ints, distance: Ints, size: int) -> None:
    """Take the nearest of ``size`` nodes out of the heap."""
    place[heap[0]] = -1
    node, at, size = heap[size - 1], 0, size - 1
    if size == 0:
        return
    while True:
        below = 2 * at + 1
        if below >= size:
            break
        if below + 1 < size and distance[heap[below + 1]] < distance[heap[below]]:
            below += 1
        if distance[heap[below]] >= distance[node]:
            break
        heap[at] = heap[below]
        place[heap[at]] = at
        at = below
    heap[at] = node
    place[node] = at


@kernel
def _sorted_by_head(head: Ints, weight: Ints, nodes: int, negative: bool) -> tuple[Ints, Ints]:
    """The negative or the other edges, grouped by where they end: starts (nodes + 1,), edge numbers."""
    starts = np.zeros(nodes + 1, np.int64)
    for edge in range(head.size):
        if (weight[edge] < 0) == negative:
            starts[head[edge] + 1] += 1
    for node in range(nodes):
        starts[node + 1] += starts[node]
    filled = starts.copy()
    edges = np.empty(starts[nodes], np.int64)
    for edge in range(head.size):
        if (weight[edge] < 0) == negative:
            edges[filled[head[edge]]] = edge
            filled[head[edge]] += 1
    return starts, edges


@inlined
def _lower(node: int, length: int, edge: int, distance: Ints, via: Ints, heap: Ints, place: Ints, size: int) -> int:
    """Note a shorter path from a node; the heap holds only nodes at negative distance. Returns the heap's size."""
    if length >= distance[node]:
        return size
    distance[node], via[node] = length, edge
    if length >= 0:
        return size
    if place[node] < 0:
        heap[size], place[node] = node, size
        size += 1
    _rise(heap, place, distance, place[node])
    return size


@kernel
def back_propagate(form: NormalForm) -> Propagation:  # noqa: C901 - one loop over a stack of frames
    """Morris (2014), Fig. 2: shorten every path that ends in a negative edge until its length is non-negative.

    Returns:
        Whether the network is dynamically controllable; if not, ``pending`` and ``again`` hold a semi-reducible
        negative cycle.
    """
    count, links, edges = form.points, form.contingent.size, form.head.size
    nodes = count + links
    in_start, in_edge = _sorted_by_head(form.head, form.weight, nodes, False)
    cut_start, cut_edge = _sorted_by_head(form.head, form.weight, nodes, True)
    lower_link = np.full(nodes, -1, np.int64)
    for link in range(links):
        if form.slack[link] > 0:
            lower_link[form.contingent[link]] = link
    row, rows = np.full(nodes, -1, np.int64), 0
    for node in range(nodes):
        if cut_start[node + 1] > cut_start[node] or (node >= count and form.slack[node - count] > 0):
            row[node] = rows
            rows += 1
    distance, via = np.empty((rows, nodes), np.int64), np.empty((rows, nodes), np.int64)
    heaps, places = np.empty((rows, nodes), np.int64), np.empty((rows, nodes), np.int64)
    derived_tail, derived_from = np.empty((rows, nodes), np.int64), np.zeros(rows, np.int64)
    state, sizes = np.zeros(rows, np.int64), np.zeros(rows, np.int64)  # state: 0 new, 1 under way, 2 done
    stack = np.empty(rows, np.int64)

    for first in range(nodes):
        if row[first] < 0 or state[row[first]] == 2:
            continue
        depth, stack[0] = 1, first
        while depth > 0:
            source = stack[depth - 1]
            at = row[source]
            far, how = distance[at], via[at]
            heap, place = heaps[depth - 1], places[depth - 1]
            if state[at] == 0:
                state[at], size = 1, 0
                far[:], how[:], place[:] = FAR, NO_EDGE, -1
                far[source] = 0
                for entry in range(cut_start[source], cut_start[source + 1]):
                    edge = cut_edge[entry]
                    size = _lower(form.tail[edge], form.weight[edge], edge, far, how, heap, place, size)
                if source >= count and form.slack[source - count] > 0:
                    link = source - count
                    size = _lower(
                        form.contingent[link], -form.slack[link], edges + links + link, far, how, heap, place, size
                    )
                sizes[depth - 1] = size
            size = sizes[depth - 1]
            nested = False
            while size > 0:
                node = heap[0]
                inner = row[node]
                if inner >= 0 and state[inner] == 1:
                    return Propagation(False, row, distance, via, stack[:depth].copy(), node)
                if inner >= 0 and state[inner] == 0:
                    stack[depth] = node
                    depth += 1
                    nested = True
                    break
                _take_least(heap, place, far, size)
                size -= 1
                length = far[node]
                for entry in range(in_start[node], in_start[node + 1]):
                    edge = in_edge[entry]
                    size = _lower(form.tail[edge], length + form.weight[edge], edge, far, how, heap, place, size)
                if inner >= 0:
                    for entry in range(derived_from[inner]):
                        tail = derived_tail[inner, entry]
                        size = _lower(tail, length + distance[inner, tail], -2 - node, far, how, heap, place, size)
                link = lower_link[node]
                if link >= 0 and count + link != source:
                    size = _lower(count + link, length, edges + link, far, how, heap, place, size)
            sizes[depth - 1 - int(nested)] = size
            if nested:
                continue
            found = 0
            for node in range(nodes):
                if 0 <= far[node] < FAR and node != source:
                    derived_tail[at, found] = node
                    found += 1
            derived_from[at], state[at] = found, 2
            depth -= 1
    return Propagation(True, row, distance, via, stack[:0].copy(), -1)
