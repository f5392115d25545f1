"""The GraphML of the CSTNU Tool: STN and STNU files, read and written."""

import math
import re
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree
from xml.parsers import expat

from lidarena.base.errors import TemporalError, suggest
from lidarena.base.files import write_text
from lidarena.temporal.edges import ContingentLink, shown
from lidarena.temporal.plain_text import put_origin_first
from lidarena.temporal.stn import STN
from lidarena.temporal.stnu import STNU

_SPACE = "http://graphml.graphdrawing.org/xmlns/graphml"
_LABELLED = re.compile(r"(LC|UC)\((.+)\):\s*(-?[\d.]+)")
_KEYS = {
    "graph": {
        "nContingent": "Contingent links",
        "NetworkType": "STN or STNU",
        "nEdges": "Edges",
        "nVertices": "Points",
    },
    "edge": {
        "Type": "contingent or requirement",
        "Value": "A number",
        "LabeledValue": "LC(NAME):number, UC(NAME):number",
    },
}
_KEYS["graph"]["Name"] = "Graph name"


class _Edge(NamedTuple):
    """An edge of a file, its data still as text."""

    tail: str
    head: str
    data: dict[str, str]


def read_graphml(path: str | Path, *, origin: str | None = "Z") -> STN:
    """Read a network of the CSTNU Tool.

    Edges of the type ``derived`` are left out: the others imply them.

    Args:
        path: The file, such as ``.stn`` or ``.stnu``.
        origin: The point before all others, where the network has one of that name; None if no point is.

    Returns:
        An `STNU`, or an `STN` where the file says that it is one.

    Raises:
        TemporalError: The file is missing, torn, no such GraphML, or declares entities or a document type.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise TemporalError(f"{str(path)!r} cannot be read as GraphML: {error.strerror}") from error
    return parse_graphml(data, origin=origin, source=str(path))


def parse_graphml(data: bytes, *, origin: str | None = "Z", source: str = "the GraphML") -> STN:
    """Read a network from GraphML, like `read_graphml`.

    Raises:
        TemporalError: It is torn, no such GraphML, or declares entities or a document type; ``source`` is named.
    """
    graph = _graph(data, source)
    about = _data(graph)
    kind = about.get("NetworkType", "STNU")
    if kind not in ("STN", "STNU"):
        raise TemporalError(f"{source} holds a network of the type {kind!r}{suggest(kind, ('STN', 'STNU'))}")
    network: STN = (STNU if kind == "STNU" else STN)(name=about.get("Name", ""))
    for node in _children(graph, "node"):
        network.add_point(node.get("id", ""))
    edges = [_Edge(one.get("source", ""), one.get("target", ""), _data(one)) for one in _children(graph, "edge")]
    _check_counts(about, network, edges, source)
    contingent = [edge for edge in edges if edge.data.get("Type") == "contingent"]
    if contingent and not isinstance(network, STNU):
        raise TemporalError(f"{source} says that it is an STN and holds contingent edges, which only an STNU has")
    for edge in edges:
        if edge.data.get("Type") not in ("contingent", "derived"):
            network.add_requirement(edge.tail, edge.head, upper=_number(edge.data.get("Value", ""), edge, source))
    if isinstance(network, STNU):
        for link in _links(contingent, source):
            network.add_contingent_link(link.activation, link.contingent, link.lower, link.upper)
    put_origin_first(network, origin)
    return network


def write_graphml(path: str | Path, network: STN) -> Path:
    """Write a network as the CSTNU Tool's GraphML.

    Raises:
        WriteError: The place is not writable.
    """
    return write_text(path, format_graphml(network))


def format_graphml(network: STN) -> str:
    """A network as the CSTNU Tool's GraphML."""
    links = network.contingent_links if isinstance(network, STNU) else ()
    rows = [_Edge(one.tail, one.head, {"Type": "requirement", "Value": shown(one.weight)}) for one in network.edges]
    for link in links:
        lower, upper = f"LC({link.contingent}):{shown(link.lower)}", f"UC({link.contingent}):{shown(-link.upper)}"
        rows.append(_Edge(link.activation, link.contingent, {"Type": "contingent", "LabeledValue": lower}))
        rows.append(_Edge(link.contingent, link.activation, {"Type": "contingent", "LabeledValue": upper}))
    root = ElementTree.Element("graphml", xmlns=_SPACE)
    for part, keys in _KEYS.items():
        for key, what in keys.items():
            ElementTree.SubElement(ElementTree.SubElement(root, "key", {"id": key, "for": part}), "desc").text = what
    graph = ElementTree.SubElement(root, "graph", edgedefault="directed")
    about = {"nContingent": str(len(links)), "NetworkType": network.kind, "nEdges": str(len(rows))}
    _put_data(graph, about | {"nVertices": str(len(network)), "Name": network.name})
    for point in network.points:
        ElementTree.SubElement(graph, "node", id=point)
    for number, row in enumerate(rows):
        edge = ElementTree.SubElement(graph, "edge", id=f"e{number}", source=row.tail, target=row.head)
        _put_data(edge, row.data)
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _graph(data: bytes, source: str) -> ElementTree.Element:
    """The graph element of a file without a document type, and so without entities of its own."""

    def refuse(name: str, *_: object) -> None:
        raise TemporalError(f"{source} declares the document type {name!r}, which may hold entities; none is allowed")

    checker = expat.ParserCreate()
    checker.StartDoctypeDeclHandler = refuse
    try:
        checker.Parse(data, True)
        root = ElementTree.fromstring(data)
    except (expat.ExpatError, ElementTree.ParseError) as error:
        raise TemporalError(f"{source} is torn or no XML: {error}") from error
    graph = next(iter(_children(root, "graph")), None)
    if graph is None:
        raise TemporalError(f"{source} is no GraphML of a temporal network: it has no element 'graph'")
    return graph


def _children(element: ElementTree.Element, tag: str) -> list[ElementTree.Element]:
    return [child for child in element if child.tag.rpartition("}")[2] == tag]


def _data(element: ElementTree.Element) -> dict[str, str]:
    return {one.get("key", ""): (one.text or "").strip() for one in _children(element, "data")}


def _put_data(element: ElementTree.Element, data: dict[str, str]) -> None:
    for key, value in data.items():
        ElementTree.SubElement(element, "data", key=key).text = value


def _check_counts(about: dict[str, str], network: STN, edges: list[_Edge], source: str) -> None:
    """Refuse a file with fewer points or edges than it tells."""
    for key, found in (("nVertices", len(network)), ("nEdges", len(edges))):
        told = about.get(key, "")
        if told.isdigit() and int(told) > found:
            raise TemporalError(f"{source} is torn: it tells {key} {told} and holds {found}")


def _number(text: str, edge: _Edge, source: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise TemporalError(
            f"the edge from {edge.tail!r} to {edge.head!r} in {source} needs a number as its Value, got {text!r}"
        ) from None


def _links(edges: list[_Edge], source: str) -> list[ContingentLink]:
    """Contingent links from pairs of edges: labelled ``LC(C):x`` and ``UC(C):-y``, or the plain values y and −x."""
    bounds: dict[tuple[str, str], list[float]] = {}
    for edge in edges:
        labelled = _LABELLED.fullmatch(edge.data.get("LabeledValue", ""))
        value = float(labelled[3]) if labelled else _number(edge.data.get("Value", ""), edge, source)
        forward = labelled[1] == "LC" if labelled else value > 0
        pair = (edge.tail, edge.head) if forward else (edge.head, edge.tail)
        is_lower = forward if labelled else not forward
        bounds.setdefault(pair, [math.nan, math.nan])[0 if is_lower else 1] = abs(value)
    for (start, end), (lower, upper) in bounds.items():
        if math.isnan(lower + upper):
            raise TemporalError(f"the contingent link from {start!r} to {end!r} in {source} lacks one of its two edges")
    return [ContingentLink(start, lower, upper, end) for (start, end), (lower, upper) in bounds.items()]
