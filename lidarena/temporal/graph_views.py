"""Temporal networks for other eyes: a networkx graph, and a drawing."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import TemporalError
from lidarena.temporal.edges import ContingentLink, shown
from lidarena.temporal.stn import STN
from lidarena.temporal.stnu import STNU

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_OURS, _NATURES = "#1f5f99", "#c4622d"


def to_networkx(network: STN) -> Any:
    """The distance graph as a ``networkx.MultiDiGraph``.

    Nodes carry ``contingent``, edges ``weight`` and ``kind`` (``requirement``, ``lower``, ``upper``).

    Raises:
        TemporalError: networkx is not installed.
    """
    try:
        import networkx
    except ImportError as error:
        raise TemporalError("to_networkx needs the package 'networkx': pip install networkx") from error
    links = _links(network)
    nature = {link.contingent for link in links}
    graph = networkx.MultiDiGraph(name=network.name)
    for point in network.points:
        graph.add_node(point, contingent=point in nature)
    for edge in network.edges:
        graph.add_edge(edge.tail, edge.head, weight=edge.weight, kind=edge.kind)
    for link in links:
        graph.add_edge(link.activation, link.contingent, weight=link.lower, kind="lower")
        graph.add_edge(link.contingent, link.activation, weight=-link.upper, kind="upper")
    return graph


def draw(network: STN, axes: "Axes | None" = None) -> "Axes":
    """Draw a network with Matplotlib: left to right by how early a point can be, bounds at the arrows.

    Requirements are blue; contingent links and the points that they end in are orange, the links double.

    Args:
        network: The network; an inconsistent one is drawn in the order of its points.
        axes: Where to draw; a new figure where there are none.

    Returns:
        The axes.
    """
    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.subplots(figsize=(max(6.0, 1.4 * len(network) ** 0.75), 4.5), layout="constrained")[1]
    places = dict(zip(network.points, _layout(network), strict=True))
    links = {(link.activation, link.contingent): link for link in _links(network)}
    pairs = {tuple(sorted((edge.tail, edge.head), key=network.points.index)) for edge in network.edges}
    for start, end in sorted(pairs - set(links)):
        low, high = network.bounds(start, end)
        if high < 0 or (high == 0 and low < 0):  # told in the direction in which time passes
            start, end, low, high = end, start, -high, -low
        _arrow(axes, places[start], places[end], f"[{_bound(low)}, {_bound(high)}]", _OURS)
    for (start, end), link in links.items():
        _arrow(axes, places[start], places[end], f"[{_bound(link.lower)}, {_bound(link.upper)}]", _NATURES, 2.5)
    nature = {link.contingent for link in links.values()}
    for point, place in places.items():
        box = {"boxstyle": "circle", "facecolor": "white", "edgecolor": _NATURES if point in nature else _OURS}
        axes.annotate(point, (float(place[0]), float(place[1])), ha="center", va="center", bbox=box, zorder=3)
    axes.margins(0.12, 0.25)
    axes.set_axis_off()
    axes.set_title(network.name)
    return axes


def _links(network: STN) -> tuple[ContingentLink, ...]:
    return network.contingent_links if isinstance(network, STNU) else ()


def _bound(bound: float) -> str:
    return {"inf": "∞", "-inf": "−∞"}.get(str(bound)) or shown(bound).replace("-", "−")


def _arrow(
    axes: "Axes", start: NDArray[np.float64], end: NDArray[np.float64], text: str, colour: str, width: float = 1.2
) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "linewidth": width, "shrinkA": 14, "shrinkB": 14}
    axes.annotate("", tuple(end.tolist()), tuple(start.tolist()), arrowprops=style)
    middle = 0.5 * (start + end)
    box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.85}
    axes.text(float(middle[0]), float(middle[1]), text, color=colour, ha="center", va="center", fontsize=9, bbox=box)
    axes.plot(*np.stack([start, end]).T, alpha=0.0)  # so that the axes know how far it reaches


def _layout(network: STN) -> NDArray[np.float64]:
    """A place (n, 2) for every point: columns by rank of the earliest time, rows within a column spread evenly."""
    count = len(network)
    early = list(network.earliest_times().values()) if network.is_consistent() else list(range(count))
    _, column = np.unique(np.asarray(early, np.float64), return_inverse=True)
    places = np.empty((count, 2))
    for one in np.unique(column):
        members = np.flatnonzero(column == one)
        spread = np.arange(members.size) - 0.5 * (members.size - 1)
        lift = 0.35 * (-1.0) ** one  # so that arrows past a column do not run through its points
        places[members] = np.column_stack([np.full(members.size, 1.0 * one), spread + lift])
    return places
