"""An independent check of dynamic controllability: edges with labels, and rules until nothing changes.

Morris and Muscettola (2005), with a reaction that takes no time. Slow on purpose, and written from the rules alone.
"""

import math

from lidarena.temporal import STNU, ContingentLink

Edges = dict[tuple[str, str], float]
Waits = dict[tuple[str, str], float]
"""By the point that waits and the contingent point for which it waits"""


def is_controllable(network: STNU) -> bool:
    """Whether the rules come to rest without a negative cycle among the longest durations."""
    links = {link.contingent: link for link in network.contingent_links}
    edges: Edges = {(edge.tail, edge.head): edge.weight for edge in network.edges}
    waits: Waits = {}
    for link in links.values():
        if link.lower == link.upper:
            _tighten(edges, (link.activation, link.contingent), link.upper)
            _tighten(edges, (link.contingent, link.activation), -link.lower)
    loose = {name: link for name, link in links.items() if link.lower < link.upper}
    for link in loose.values():
        waits[link.contingent, link.contingent] = -link.upper
        _tighten(edges, (link.activation, link.contingent), link.upper)
        _tighten(edges, (link.contingent, link.activation), -link.lower)
    while True:
        longest = dict(edges)
        for (point, label), weight in waits.items():
            _tighten(longest, (point, loose[label].activation), weight)
        if _has_negative_cycle(network.points, longest):
            return False
        if not _apply(edges, waits, loose):
            return True


def _apply(edges: Edges, waits: Waits, links: dict[str, ContingentLink]) -> bool:  # noqa: C901 - one loop a rule
    """Every rule once on everything; whether anything became tighter."""
    changed = False
    for (first, middle), one in list(edges.items()):
        for (start, end), other in list(edges.items()):
            if start == middle:  # no case
                changed |= _tighten(edges, (first, end), one + other)
        for (start, label), other in list(waits.items()):
            if start == middle:  # upper case
                changed |= _tighten(waits, (first, label), one + other)
    for name, link in links.items():
        for (start, end), weight in list(edges.items()):
            if start == name and weight < 0:  # lower case
                changed |= _tighten(edges, (link.activation, end), link.lower + weight)
        for (start, label), weight in list(waits.items()):
            if start == name and weight < 0 and label != name:  # cross case
                changed |= _tighten(waits, (link.activation, label), link.lower + weight)
    for (start, label), weight in list(waits.items()):
        if weight >= -links[label].lower:  # label removal
            changed |= _tighten(edges, (start, links[label].activation), weight)
    return changed


def _tighten(edges: Edges, key: tuple[str, str], weight: float) -> bool:
    if weight >= edges.get(key, math.inf):
        return False
    edges[key] = weight
    return True


def _has_negative_cycle(points: tuple[str, ...], edges: Edges) -> bool:
    distance = dict.fromkeys(points, 0.0)
    for _ in points:
        changed = False
        for (tail, head), weight in edges.items():
            if distance[tail] + weight < distance[head]:
                distance[head], changed = distance[tail] + weight, True
        if not changed:
            return False
    return True
