"""Dynamic controllability: whether all requirements can be met while contingent durations are only observed."""

from typing import NamedTuple

from lidarena.base.errors import TemporalError
from lidarena.temporal.back_propagation import NormalForm, Propagation, back_propagate
from lidarena.temporal.edges import TICK, NegativeCycle, TemporalEdge
from lidarena.temporal.stn import STN
from lidarena.temporal.stnu import STNU

_LONGEST_CYCLE = 1000
"""Edges of a reason; such a cycle can be exponentially long (Hunsberger 2013), derived edges then stay whole."""


class Controllability(NamedTuple):
    """The answer, true or false in a condition, and the reason for a no."""

    controllable: bool
    cycle: NegativeCycle | None
    """A semi-reducible negative cycle, in the points of the network; None where it is controllable"""

    def __bool__(self) -> bool:
        return self.controllable

    def __str__(self) -> str:
        return "dynamically controllable" if self.controllable else f"not dynamically controllable: {self.cycle}"


def check_controllability(network: STN) -> Controllability:
    """Decide dynamic controllability in O(n³), with a reaction that takes no time (Morris 2014).

    Args:
        network: An `STNU`; a plain `STN` is controllable if it is consistent.

    Returns:
        The answer and, for a no, the semi-reducible negative cycle.
    """
    form, found = propagate(network)
    return Controllability(found.controllable, None if found.controllable else _reason(network, form, found))


def require_controllable(network: STN) -> None:
    """Refuse a network that is not dynamically controllable.

    Raises:
        TemporalError: It is not; the message names the negative cycle.
    """
    answer = check_controllability(network)
    if not answer:
        raise TemporalError(f"the network is {answer}")


def propagate(network: STN) -> tuple[NormalForm, Propagation]:
    """The normal form of a network, and what back-propagation through it found."""
    form = network.normal_form() if isinstance(network, STNU) else _plain_form(network)
    return form, back_propagate(form)


def _plain_form(network: STN) -> NormalForm:
    arrays = network.edge_arrays()
    none = arrays.tail[:0]
    return NormalForm(*arrays, none, none, len(network))


def _reason(network: STN, form: NormalForm, found: Propagation) -> NegativeCycle:
    """The paths between the nodes that were under way, from the one that came again back to itself."""
    pending = [int(node) for node in found.pending]
    at = pending.index(found.again)
    steps: list[tuple[int, int, int]] = []
    node = found.again
    for source in reversed(pending[at:]):
        steps += _path(form, found, node, source)
        node = source
    for _ in range(len(steps) + _LONGEST_CYCLE):
        expanded = [part for step in steps for part in _expanded(form, found, step)]
        if len(expanded) == len(steps) or len(expanded) > _LONGEST_CYCLE:
            break
        steps = expanded
    return NegativeCycle(_named(network, form, found, steps))


def _path(form: NormalForm, found: Propagation, start: int, source: int) -> list[tuple[int, int, int]]:
    """The edges (tail, head, number) of the reduced path from a node to a negative node."""
    rows = slice(found.start[source], found.stop[source])
    via, node = dict(zip(found.tail[rows].tolist(), found.via[rows].tolist(), strict=True)), start
    steps: list[tuple[int, int, int]] = []
    while not steps or node != source:
        edge = int(via[node])
        following = _head(form, edge)
        steps.append((node, following, edge))
        node = following
    return steps


def _head(form: NormalForm, edge: int) -> int:
    edges, links = form.head.size, form.contingent.size
    if edge <= -2:
        return -2 - edge
    if edge < edges:
        return int(form.head[edge])
    if edge < edges + links:
        return int(form.contingent[edge - edges])
    return form.points + edge - edges - links


def _expanded(form: NormalForm, found: Propagation, step: tuple[int, int, int]) -> list[tuple[int, int, int]]:
    tail, head, edge = step
    return _path(form, found, tail, head) if edge <= -2 else [step]


def _named(
    network: STN, form: NormalForm, found: Propagation, steps: list[tuple[int, int, int]]
) -> tuple[TemporalEdge, ...]:
    """The edges in the network's own points: ``A'`` is told as ``A``, the ``x`` between them added to the weights."""
    links = network.contingent_links if isinstance(network, STNU) else ()
    names = [*network.points, *(link.activation for link in links)]
    later = [0.0] * len(network) + [link.lower for link in links]
    edges = []
    for tail, head, edge in steps:
        weight = _weight(form, found, step=(tail, head, edge)) * TICK + later[tail] - later[head]
        if names[tail] != names[head] or tail == head:  # from A to its own A' there is no step
            edges.append(TemporalEdge(names[tail], names[head], _clean(weight), _kind(form, edge)))
    return tuple(edges)


def _weight(form: NormalForm, found: Propagation, step: tuple[int, int, int]) -> int:
    tail, head, edge = step
    edges, links = form.head.size, form.contingent.size
    if edge <= -2:
        rows = slice(found.start[head], found.stop[head])
        return int(found.length[rows][found.tail[rows] == tail][0])
    if edge < edges:
        return int(form.weight[edge])
    return 0 if edge < edges + links else -int(form.slack[edge - edges - links])


def _kind(form: NormalForm, edge: int) -> str:
    if edge <= -2:
        return "derived"
    if edge < form.head.size:
        return "requirement"
    return "lower" if edge < form.head.size + form.contingent.size else "upper"


def _clean(weight: float) -> float:
    """The nearest whole number of ticks, written without the error of the sum."""
    return round(round(weight / TICK) * TICK, 6)
