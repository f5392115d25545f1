"""Which graphs are kept for the next call, and how much memory they may take."""

import numpy as np
import pytest

from lidarena.planning import plan_team
from lidarena.planning.team import grid_graph
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph, grid_graph_of


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grid_graph, "kept_graphs", grid_graph._KeptGraphs())


def hall(side: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).random((side, side)) < 0.1


def test_the_graph_of_an_equal_grid_is_the_same() -> None:
    first = grid_graph_of(hall(20, 0), 4, 0.0)
    assert grid_graph_of(hall(20, 0).copy(), 4, 0.0) is first
    assert grid_graph_of(hall(20, 0), 8, 0.0) is not first
    assert grid_graph_of(hall(20, 1), 4, 0.0) is not first


def test_the_graphs_asked_for_last_are_kept() -> None:
    first = grid_graph_of(hall(10, 0), 4, 0.0)
    for seed in range(1, 16):
        grid_graph_of(hall(10, seed), 4, 0.0)
    assert grid_graph_of(hall(10, 0), 4, 0.0) is first
    grid_graph_of(hall(10, 16), 4, 0.0)
    assert grid_graph_of(hall(10, 0), 4, 0.0) is first  # number 1 had not been asked for longest


def test_plans_on_ever_new_large_maps_do_not_add_up() -> None:
    """Of one map at most more than the bound is kept, since distances and tables come after the graph."""
    rng, largest = np.random.default_rng(0), 0
    for seed in range(6):
        free = np.argwhere(~hall(200, seed))
        graph = grid_graph_of(hall(200, seed), 4, 0.0)
        goal = graph.place(free[0])
        inside = np.flatnonzero(graph.ahead(goal) < UNREACHABLE)
        cells = graph.cells[rng.choice(inside, 400, replace=False)]
        plan = plan_team(graph, cells[:200], cells[200:], "lacam", 4, 0.0, np.inf, iterations=1)
        assert len(plan.paths) in (0, 200)
        largest = max(largest, graph.nbytes)
    assert grid_graph.kept_graphs.nbytes <= grid_graph.KEPT_BYTES + largest


def test_what_is_kept_is_counted() -> None:
    graph = GridGraph(hall(60, 3), 4, 0.0)
    before = graph.nbytes
    graph.ahead(0)
    assert graph.nbytes == before + 4 * len(graph)
    graph.give_back(graph.borrow(100))
    assert graph.nbytes > before + 4 * len(graph) + 36 * len(graph)


def test_tables_that_a_long_search_made_large_are_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = GridGraph(hall(20, 3), 4, 0.0)
    monkeypatch.setattr(grid_graph, "_KEPT_TABLE_BYTES", 1000)
    before = graph.nbytes
    graph.give_back(graph.borrow(100))
    assert graph.nbytes == before


@pytest.mark.parametrize("connectivity", [4, 8])
def test_distances_to_many_goals_are_those_to_each(connectivity: int, monkeypatch: pytest.MonkeyPatch) -> None:
    graph, goals = GridGraph(hall(30, 2), connectivity, 0.0), [0, 17, 300, 17]
    rows = graph.ahead_of_all(goals)
    for kept in (24 * 2**20, 1):
        monkeypatch.setattr(grid_graph, "_CACHED_BYTES", kept)
        again = GridGraph(hall(30, 2), connectivity, 0.0)
        np.testing.assert_array_equal(again.ahead_of_all(goals), rows)
        assert len(again._ahead) == (3 if kept > 1 else 0)
    for row, goal in zip(rows, goals, strict=True):
        np.testing.assert_array_equal(row, graph.ahead(goal))
