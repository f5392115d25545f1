from lidarena.temporal import NegativeCycle, TemporalEdge
from lidarena.temporal.edges import shown, ticks


def test_edges_are_told_as_sentences() -> None:
    assert str(TemporalEdge("A", "B", 3)) == "B at most 3 after A"
    assert str(TemporalEdge("A", "B", -2.5)) == "A at least 2.5 after B"
    assert str(TemporalEdge("A", "C", 2, "lower")) == "C may come only 2 after A"
    assert str(TemporalEdge("C", "A", -8, "upper")) == "C may come as late as 8 after A"


def test_a_cycle_tells_its_points_and_by_how_much_it_misses() -> None:
    cycle = NegativeCycle((TemporalEdge("A", "B", 0.1), TemporalEdge("B", "A", -0.3)))
    assert cycle.points == ("A", "B") and str(cycle).startswith("A → B → A (") and str(cycle).endswith("0.2 too much)")


def test_times_are_shown_without_loss() -> None:
    assert [shown(time) for time in (5.0, 0.25, float("inf"))] == ["5", "0.25", "inf"]
    assert ticks(0.1) + ticks(0.2) == ticks(0.3)
