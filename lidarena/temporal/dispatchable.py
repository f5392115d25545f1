"""The dispatchable form of a network: what an executor must look at, and nothing else, to meet every requirement."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import TemporalError
from lidarena.base.jit import kernel
from lidarena.temporal.back_propagation import FAR, NormalForm, Propagation
from lidarena.temporal.controllability import check_controllability, propagate
from lidarena.temporal.edges import TICK, ContingentLink, TemporalEdge
from lidarena.temporal.stn import STN
from lidarena.temporal.stnu import STNU

Ints = NDArray[np.int64]


class Wait(NamedTuple):
    """``point`` waits until ``duration`` after ``activation``, or until ``contingent`` has come, if that is earlier."""

    point: str
    activation: str
    duration: float
    contingent: str


class DispatchableNetwork(NamedTuple):
    """An extended STNU (Morris 2014) that can be executed by looking at neighbours only, see `RealTimeExecution`."""

    points: tuple[str, ...]
    edges: tuple[TemporalEdge, ...]
    """Ordinary edges, those of the contingent links included"""
    waits: tuple[Wait, ...]
    contingent_links: tuple[ContingentLink, ...]

    @property
    def size(self) -> int:
        """How many ordinary edges and waits it has."""
        return len(self.edges) + len(self.waits)


def make_dispatchable(network: STN, *, reduce: bool = True) -> DispatchableNetwork:
    """The dispatchable form of a dynamically controllable network.

    Back-propagation yields it: every edge and wait on the way of a path is kept. Then an ordinary edge goes that two
    edges of the same sign imply, and a wait that an edge, or an edge and a wait, imply: the paths on which execution
    relies (negative edges first, then the others; Morris 2016) stay such paths. That is smaller, not always minimal.

    Args:
        network: An `STNU`, or a consistent `STN`.
        reduce: Whether implied edges and waits are left out.

    Raises:
        TemporalError: The network is not dynamically controllable (the message names the negative cycle), or a
            contingent point may come before its activation.
    """
    _check_causal(network)
    form, found = propagate(network)
    if not found.controllable:
        raise TemporalError(f"the network has no dispatchable form, it is {check_controllability(network)}")
    links = network.contingent_links if isinstance(network, STNU) else ()
    start = np.array([network.points.index(link.activation) for link in links], np.int64)
    low = np.array([round(link.lower / TICK) for link in links], np.int64)
    high = np.array([round(link.upper / TICK) for link in links], np.int64)
    edges, waits = _gather(form, found, start, low)
    fixed = _contingent_edges(edges, form, start, low, high)
    if reduce:
        _reduce_edges(edges, _longest_first(edges), fixed)
        _reduce_waits(waits, _longest_first(waits), edges, start, form.contingent)
    _bound_with_their_ends(edges, start[high == 0], form.contingent[high == 0])
    return _named(network, edges, waits, links)


def _check_causal(network: STN) -> None:
    for link in network.contingent_links if isinstance(network, STNU) else ():
        if link.lower < 0:
            raise TemporalError(
                f"{link.contingent!r} may come before {link.activation!r}, which activates it, and so cannot be "
                f"executed: the lower bound must be at least 0, got {link.lower:g}"
            )


@kernel
def _gather(form: NormalForm, found: Propagation, start: Ints, low: Ints) -> tuple[Ints, Ints]:
    """All edges (n, n) and waits (n, k), each as a weight [ticks]; every ``A'`` is merged into its ``A`` (k,).

    Args:
        form: The normal form.
        found: What back-propagation derived from it.
        start: (k,) the points ``A``.
        low: (k,) the durations ``x`` by which ``A'`` follows ``A``.
    """
    count, links = form.points, start.size
    edges, waits = np.full((count, count), FAR, np.int64), np.full((count, links), FAR, np.int64)
    for node in range(count):
        edges[node, node] = 0
    for edge in range(form.tail.size):
        tail, head, weight = form.tail[edge], form.head[edge], form.weight[edge]
        if tail < count and head < count:
            edges[tail, head] = min(edges[tail, head], weight)
    for source in range(found.start.size):
        link = source - count
        head, before = (source, 0) if link < 0 else (start[link], low[link])
        for path in range(found.start[source], found.stop[source]):
            node, length = found.tail[path], found.length[path]
            tail, after = (node, 0) if node < count else (start[node - count], low[node - count])
            if tail == head:
                continue
            weight = length + after - before
            if link < 0 or length >= 0:
                edges[tail, head] = min(edges[tail, head], weight)
            elif tail != form.contingent[link]:
                waits[tail, link] = min(waits[tail, link], weight)
    return edges, waits


def _contingent_edges(edges: Ints, form: NormalForm, start: Ints, low: Ints, high: Ints) -> NDArray[np.bool_]:
    """Put in the bounds of the contingent links; returns which edges (n, n) are such bounds."""
    fixed = np.zeros(edges.shape, np.bool_)
    for begin, end, least, most in zip(start, form.contingent, low, high, strict=True):
        edges[begin, end] = min(edges[begin, end], most)
        edges[end, begin] = min(edges[end, begin], -least)
        fixed[begin, end] = fixed[end, begin] = True
    return fixed


def _bound_with_their_ends(edges: Ints, start: Ints, end: Ints) -> None:
    """Bound, in place, an activation by what bounds its contingent point, where that comes at the same instant.

    An executor looks at its own points only; of longer links back-propagation bounds the activation already.
    """
    for _ in start:
        for activation, contingent in zip(start, end, strict=True):
            np.minimum(edges[:, activation], edges[:, contingent], out=edges[:, activation])


def _longest_first(weights: Ints) -> Ints:
    """Where the weights are (m, 2), the longest first: what implies an edge is still there when its turn comes."""
    rows, columns = np.nonzero(weights < FAR)
    order = np.argsort(-np.abs(weights[rows, columns]), kind="stable")
    return np.column_stack([rows[order], columns[order]]).astype(np.int64)


@kernel
def _reduce_edges(edges: Ints, order: Ints, fixed: NDArray[np.bool_]) -> None:
    """Take out, in place, every edge (n, n) that two others of its own sign imply."""
    for at in range(order.shape[0]):
        tail, head = order[at, 0], order[at, 1]
        weight = edges[tail, head]
        if tail == head or fixed[tail, head]:
            continue
        for middle in range(edges.shape[0]):
            first, second = edges[tail, middle], edges[middle, head]
            if middle in (tail, head) or first == FAR or second == FAR or first + second > weight:
                continue
            if (first < 0) == (weight < 0) and (second < 0) == (weight < 0):
                edges[tail, head] = FAR
                break


@kernel
def _reduce_waits(waits: Ints, order: Ints, edges: Ints, start: Ints, end: Ints) -> None:
    """Take out, in place, every wait (n, k) that an edge, or an edge and another wait, imply."""
    for at in range(order.shape[0]):
        point, link = order[at, 0], order[at, 1]
        weight = waits[point, link]
        implied = edges[point, start[link]] <= weight or edges[point, end[link]] < 0
        for middle in range(edges.shape[0]):
            if implied:
                break
            first, second = edges[point, middle], waits[middle, link]
            implied = middle != point and first < 0 and second != FAR and first + second <= weight
        if implied:
            waits[point, link] = FAR


def _named(network: STN, edges: Ints, waits: Ints, links: tuple[ContingentLink, ...]) -> DispatchableNetwork:
    names, nature = network.points, {link.contingent for link in links}
    ends = [(int(tail), int(head)) for tail, head in zip(*np.nonzero(edges < FAR), strict=True) if tail != head]
    kept = [TemporalEdge(names[tail], names[head], _time(edges[tail, head])) for tail, head in ends]
    places = [(int(point), int(link)) for point, link in zip(*np.nonzero(waits < FAR), strict=True)]
    found = [
        Wait(names[point], links[link].activation, -_time(waits[point, link]), links[link].contingent)
        for point, link in places
        if names[point] not in nature  # nature keeps these by itself
    ]
    return DispatchableNetwork(names, tuple(kept), tuple(found), links)


def _time(weight: int) -> float:
    time = round(int(weight) * TICK, 6)
    return 0.0 if math.isclose(time, 0.0, abs_tol=TICK / 2) else time
