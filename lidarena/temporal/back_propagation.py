"""The kernel of Morris's check of dynamic controllability: back-propagation from every negative node, O(n³).

In normal form every contingent link ``(A, x, y, C)`` with ``x < y`` has a point ``A'`` of its own, exactly ``x`` after
``A``: its lower-case edge is ``A' –c:0→ C``, its upper-case edge ``C –C:−(y − x)→ A'``. Only such a point is entered by
an upper-case edge, so that whatever is derived towards it stems from that edge, and towards any other point does not.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.heap import pop, push
from lidarena.base.jit import inlined, kernel

FAR = np.iinfo(np.int64).max // 4
"""The distance of what is not connected."""
NO_EDGE = -1
NEW, UNDER_WAY, DONE = 0, 1, 2
"""How far back-propagation from a node is."""

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


class _Graph(NamedTuple):
    """The edges by where they end: those into node ``v`` are ``edge[start[v]]`` to ``edge[start[v + 1] − 1]``."""

    in_start: Ints
    """(n + k + 1,) of the edges that are not negative"""
    in_edge: Ints
    cut_start: Ints
    """(n + k + 1,) of the negative ones"""
    cut_edge: Ints
    lower_link: Ints
    """(n + k,) the link whose lower-case edge ends in a node; −1 where none does"""
    negative: NDArray[np.bool_]
    """(n + k,) whether a negative or an upper-case edge ends in a node"""


class _Frame(NamedTuple):
    """The back-propagation from one node, all arrays but the last one (n + k,)."""

    far: Ints
    """The shortest way from every node [ticks]; ``FAR`` where there is none yet"""
    via: Ints
    """Its first edge"""
    heap: Ints
    """The nodes at negative distance that are still to be gone through, see ``base.heap``"""
    place: Ints
    touched: Ints
    """The nodes that have a way"""
    sizes: Ints
    """(2,) how many nodes are in ``heap`` and in ``touched``"""


class _Paths(NamedTuple):
    """The paths as in `Propagation`; those of a node that are not negative come first, up to ``bend`` (n + k,)."""

    start: Ints
    bend: Ints
    stop: Ints
    tail: Ints
    length: Ints
    via: Ints


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


@kernel
def _graph_of(form: NormalForm) -> _Graph:
    links, nodes = form.contingent.size, form.points + form.contingent.size
    in_start, in_edge = _sorted_by_head(form.head, form.weight, nodes, False)
    cut_start, cut_edge = _sorted_by_head(form.head, form.weight, nodes, True)
    lower_link, negative = np.full(nodes, -1, np.int64), np.zeros(nodes, np.bool_)
    for link in range(links):
        if form.slack[link] > 0:
            lower_link[form.contingent[link]] = link
            negative[form.points + link] = True
    for node in range(nodes):
        negative[node] |= cut_start[node + 1] > cut_start[node]
    return _Graph(in_start, in_edge, cut_start, cut_edge, lower_link, negative)


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
    for k in range(array.size):
        larger[k] = array[k]
    return larger


@kernel
def _deeper(frames: NDArray[np.int64], depth: int) -> NDArray[np.int64]:
    """The frames (depths, 5, n + k), or twice as many with the same ones in front."""
    if depth < frames.shape[0]:
        return frames
    larger = np.empty((2 * frames.shape[0], 5, frames.shape[2]), np.int64)
    for number in range(frames.size):  # as far as they go; assigning slices takes seconds to compile
        larger.flat[number] = frames.flat[number]
    return larger


@inlined
def _lower(frame: _Frame, node: int, length: int, edge: int) -> None:
    """Note a shorter path from a node."""
    if length >= frame.far[node]:
        return
    if frame.far[node] == FAR:
        frame.touched[frame.sizes[1]] = node
        frame.sizes[1] += 1
    frame.far[node], frame.via[node] = length, edge
    if length < 0:
        frame.sizes[0] = push(frame.heap, frame.place, frame.far, frame.sizes[0], node)


@inlined
def _begin(form: NormalForm, graph: _Graph, frame: _Frame, source: int) -> None:
    """Start at a node, with the negative edges and the upper-case edge into it."""
    frame.far[:], frame.place[:], frame.sizes[:] = FAR, -1, 0
    frame.far[source], frame.via[source] = 0, NO_EDGE
    for entry in range(graph.cut_start[source], graph.cut_start[source + 1]):
        edge = graph.cut_edge[entry]
        _lower(frame, form.tail[edge], form.weight[edge], edge)
    link = source - form.points
    if link >= 0 and form.slack[link] > 0:
        _lower(frame, form.contingent[link], -form.slack[link], form.head.size + form.slack.size + link)


@inlined
def _go_on(form: NormalForm, graph: _Graph, paths: _Paths, frame: _Frame, source: int, state: Ints) -> int:
    """Shorten paths to the source until none is negative, or one leads through a negative node that is not done.

    Returns:
        That node; −1 where the source is done.
    """
    while frame.sizes[0] > 0:
        node = frame.heap[0]
        if state[node] == UNDER_WAY or (graph.negative[node] and state[node] == NEW):
            return int(node)
        pop(frame.heap, frame.place, frame.far, frame.sizes[0])
        frame.sizes[0] -= 1
        length = frame.far[node]
        for entry in range(graph.in_start[node], graph.in_start[node + 1]):
            edge = graph.in_edge[entry]
            _lower(frame, form.tail[edge], length + form.weight[edge], edge)
        for entry in range(paths.start[node], paths.bend[node]):
            _lower(frame, paths.tail[entry], length + paths.length[entry], -2 - node)
        link = graph.lower_link[node]
        if link >= 0 and form.points + link != source:
            _lower(frame, form.points + link, length, form.head.size + link)
    return -1


@inlined
def _keep(paths: _Paths, frame: _Frame, source: int, used: int) -> int:
    """Write the paths to a node behind the ``used`` ones; returns how many there are then."""
    paths.start[source] = used
    for negative in (False, True):
        if negative:
            paths.bend[source] = used
        for at in range(frame.sizes[1]):
            node = frame.touched[at]
            if (frame.far[node] < 0) == negative:
                paths.tail[used], paths.length[used], paths.via[used] = node, frame.far[node], frame.via[node]
                used += 1
    if frame.far[source] < 0:  # the negative cycle itself
        paths.tail[used], paths.length[used], paths.via[used] = source, frame.far[source], frame.via[source]
        used += 1
    paths.stop[source] = used
    return used


@kernel
def back_propagate(form: NormalForm) -> Propagation:
    """Morris (2014), Fig. 2: shorten every path that ends in a negative edge until its length is non-negative.

    Returns:
        Whether the network is dynamically controllable; if not, ``pending`` and ``again`` hold a semi-reducible
        negative cycle.
    """
    graph = _graph_of(form)
    nodes = graph.negative.size
    order = _latest_first(form, graph.negative)
    frames, sizes = np.empty((4, 5, nodes), np.int64), np.zeros((order.size, 2), np.int64)
    state, stack = np.full(nodes, NEW, np.int64), np.empty(order.size, np.int64)
    start, bend, stop = np.zeros(nodes, np.int64), np.zeros(nodes, np.int64), np.zeros(nodes, np.int64)
    tail, length, via = np.empty(8 * nodes, np.int64), np.empty(8 * nodes, np.int64), np.empty(8 * nodes, np.int64)
    used, again, depth, deepest = 0, -1, 0, 0
    for first in order:
        if state[first] == NEW:
            depth, stack[0] = 1, first
        while depth > 0:
            source, rows = stack[depth - 1], frames[depth - 1]
            frame = _Frame(rows[0], rows[1], rows[2], rows[3], rows[4], sizes[depth - 1])
            paths = _Paths(start, bend, stop, tail, length, via)
            if state[source] == NEW:
                state[source] = UNDER_WAY
                _begin(form, graph, frame, source)
            waits_for = _go_on(form, graph, paths, frame, source, state) if again < 0 else -1
            if waits_for >= 0 and state[waits_for] == NEW:
                stack[depth], frames, depth = waits_for, _deeper(frames, depth), depth + 1
                continue
            if waits_for >= 0:
                again, deepest = waits_for, depth
            wanted = used + nodes + 1
            tail, length, via = _grown(tail, wanted), _grown(length, wanted), _grown(via, wanted)
            used = _keep(_Paths(start, bend, stop, tail, length, via), frame, source, used)
            if again == source:
                break
            state[source] = DONE
            depth -= 1
        if again >= 0:
            break
    pending = stack[depth - 1 : deepest] if again >= 0 else stack[:0]
    return Propagation(again < 0, start, stop, tail[:used], length[:used], via[:used], pending.copy(), again)
