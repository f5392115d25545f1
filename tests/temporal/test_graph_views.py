import sys

import matplotlib
import pytest
from matplotlib import pyplot

from lidarena.base.errors import TemporalError
from lidarena.temporal import draw, to_networkx
from tests.temporal.networks import build

matplotlib.use("Agg")
NETWORK = build(["start", "end", "robot"], [("end", -2, 3, "robot")], [("start", 4, 10, "end")])


def test_the_graph_holds_every_edge() -> None:
    pytest.importorskip("networkx")
    graph = to_networkx(NETWORK)
    assert graph.nodes["end"]["contingent"] and not graph.nodes["robot"]["contingent"]
    found = {(tail, head, data["kind"]): data["weight"] for tail, head, data in graph.edges(data=True)}
    assert found == {
        ("start", "end", "lower"): 4,
        ("end", "start", "upper"): -10,
        ("end", "robot", "requirement"): 3,
        ("robot", "end", "requirement"): 2,
    }


def test_without_networkx_it_says_what_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "networkx", None)
    with pytest.raises(TemporalError, match="pip install networkx"):
        to_networkx(NETWORK)


def test_the_drawing_shows_points_and_bounds() -> None:
    axes = draw(NETWORK)
    texts = {text.get_text() for text in axes.texts}
    assert {"start", "end", "robot", "[4, 10]", "[−2, 3]"} <= texts
    pyplot.close("all")


def test_an_inconsistent_network_can_be_drawn_too() -> None:
    network = build(["A", "B"], [("A", 3, None, "B"), ("A", None, 1, "B")], [])
    figure, axes = pyplot.subplots()
    assert draw(network, axes) is axes
    pyplot.close(figure)
