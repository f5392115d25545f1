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
    """What back-propagation found: the shortest reduced paths to every negative node, ``e`` of them in all.

    Those to node ``s`` are ``start[s]`` to ``stop[s]``. ``via`` is a path's first edge: an ordinary edge's number,
    ``m + j`` the lower-case and ``m + k + j`` the upper-case edge of link ``j``, ``−2 − v`` one derived to ``v``.
    """

    controllable: bool
    start: Ints
    """(n + k,) where a node's paths begin"""
    stop: Ints
    """(n + k,) where they end"""
    tail: Ints
    """(e,) where each path comes from"""
    length: Ints
    """(e,) [ticks]"""
    via: Ints
    """(e,)"""
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
def _lower(
    node: int, length: int, edge: int, far: Ints, via: Ints, heap: Ints, place: Ints, touched: Ints, sizes: Ints
) -> None:
    """Note a shorter path from a node; the heap holds only nodes at negative distance.

    ``sizes`` (2,) counts the nodes in the heap and those in ``touched``, which have a path.
    """
    if length >= far[node]:
        return
    if far[node] == FAR:
        touched[sizes[1]] = node
        sizes[1] += 1
    far[node], via[node] = length, edge
    if length >= 0:
        return
    if place[node] < 0:
        heap[sizes[0]], place[node] = node, sizes[0]
        sizes[0] += 1
    _rise(heap, place, far, place[node])


@kernel
def _latest_first(form: NormalForm, negative: NDArray[np.bool_]) -> Ints:
    """The negative nodes, each after those that come no earlier by an edge, so that few have to wait for others."""
    count, nodes = form.points, negative.size
    cut_start, cut_edge = _sorted_by_head(form.head, form.weight - 1, nodes, True)
    order, state = np.empty(nodes, np.int64), np.zeros(nodes, np.int64)
    stack, entry = np.empty(nodes, np.int64), np.zeros(nodes, np.int64)
    found = 0
    for first in range(nodes):
        if state[first]:
            continue
        depth, stack[0], state[first] = 1, first, 1
        while depth > 0:
            node = stack[depth - 1]
            at, step = cut_start[node] + entry[node], -1
            if at < cut_start[node + 1]:
                step = form.tail[cut_edge[at]]
            elif at == cut_start[node + 1] and node >= count:
                step = form.contingent[node - count]
            else:
                depth -= 1
                order[found] = node
                found += int(negative[node])
                continue
            entry[node] += 1
            if state[step] == 0:
                stack[depth], state[step] = step, 1
                depth += 1
    return order[:found]


@kernel
def _grown(array: Ints, needed: int) -> Ints:
    """The array, or one of twice the size or more with the same beginning."""
    if needed <= array.size:
        return array
    larger = np.empty(max(needed, 2 * array.size), np.int64)
    larger[: array.size] = array
    return larger


@kernel
def _deeper(frames: Ints, depth: int) -> Ints:
    """The frames (depths, n + k), or twice as many with the same ones in front."""
    if depth < frames.shape[0]:
        return frames
    larger = np.empty((2 * frames.shape[0], frames.shape[1]), np.int64)
    larger[: frames.shape[0]] = frames
    return larger


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
    negative = np.zeros(nodes, np.bool_)
    for link in range(links):
        if form.slack[link] > 0:
            lower_link[form.contingent[link]] = link
            negative[count + link] = True
    for node in range(nodes):
        negative[node] |= cut_start[node + 1] > cut_start[node]
    order = _latest_first(form, negative)
    rows = order.size
    fars, vias = np.empty((4, nodes), np.int64), np.empty((4, nodes), np.int64)
    heaps, places = np.empty((4, nodes), np.int64), np.empty((4, nodes), np.int64)
    touches, sizes = np.empty((4, nodes), np.int64), np.zeros((rows, 2), np.int64)
    state = np.zeros(nodes, np.int64)  # 0 new, 1 under way, 2 done
    stack = np.empty(rows, np.int64)
    start, bend, stop = np.zeros(nodes, np.int64), np.zeros(nodes, np.int64), np.zeros(nodes, np.int64)
    tails, lengths, steps = np.empty(8 * nodes, np.int64), np.empty(8 * nodes, np.int64), np.empty(8 * nodes, np.int64)
    used, again, deepest = 0, -1, 0

    for first in order:
        if state[first] == 2:
            continue
        depth, stack[0] = 1, first
        while depth > 0:
            source = stack[depth - 1]
            far, via, heap, place = fars[depth - 1], vias[depth - 1], heaps[depth - 1], places[depth - 1]
            touched, size = touches[depth - 1], sizes[depth - 1]
            if state[source] == 0:
                state[source] = 1
                far[:], place[:], size[:] = FAR, -1, 0
                far[source], via[source] = 0, NO_EDGE
                for entry in range(cut_start[source], cut_start[source + 1]):
                    edge = cut_edge[entry]
                    _lower(form.tail[edge], form.weight[edge], edge, far, via, heap, place, touched, size)
                if source >= count and form.slack[source - count] > 0:
                    link = source - count
                    end, upper = form.contingent[link], edges + links + link
                    _lower(end, -form.slack[link], upper, far, via, heap, place, touched, size)
            nested = False
            while size[0] > 0 and again < 0:
                node = heap[0]
                if state[node] == 1:
                    again, deepest = node, depth
                    break
                if negative[node] and state[node] == 0:
                    stack[depth] = node
                    fars, vias, touches = _deeper(fars, depth), _deeper(vias, depth), _deeper(touches, depth)
                    heaps, places = _deeper(heaps, depth), _deeper(places, depth)
                    depth += 1
                    nested = True
                    break
                _take_least(heap, place, far, size[0])
                size[0] -= 1
                length = far[node]
                for entry in range(in_start[node], in_start[node + 1]):
                    edge = in_edge[entry]
                    _lower(form.tail[edge], length + form.weight[edge], edge, far, via, heap, place, touched, size)
                for entry in range(start[node], bend[node]):
                    if length + lengths[entry] < far[tails[entry]]:
                        _lower(tails[entry], length + lengths[entry], -2 - node, far, via, heap, place, touched, size)
                link = lower_link[node]
                if link >= 0 and count + link != source:
                    _lower(count + link, length, edges + link, far, via, heap, place, touched, size)
            if nested:
                continue
            tails, lengths, steps = (
                _grown(tails, used + nodes + 1),
                _grown(lengths, used + nodes + 1),
                _grown(steps, used + nodes + 1),
            )  # fmt: skip
            start[source] = used
            for wanted in (1, 0):  # what is not negative comes first: others go through that only
                for at in range(size[1]):
                    node = touched[at]
                    if (far[node] >= 0) == (wanted == 1):
                        tails[used], lengths[used], steps[used] = node, far[node], via[node]
                        used += 1
                if wanted:
                    bend[source] = used
            if far[source] < 0:  # the negative cycle itself
                tails[used], lengths[used], steps[used] = source, far[source], via[source]
                used += 1
            stop[source] = used
            if again < 0:
                state[source] = 2
                depth -= 1
            elif again == source or depth == 1:
                break
            else:
                depth -= 1
        if again >= 0:
            break
    pending = stack[:0]
    if again >= 0:
        pending = stack[depth - 1 : deepest]
    return Propagation(again < 0, start, stop, tails[:used], lengths[:used], steps[:used], pending.copy(), again)
