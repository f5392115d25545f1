import heapq
import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.grid_graph import STEP, UNREACHABLE, GridGraph, grid_graph_of
from lidarena.planning.team.moves import MOVES


@st.composite
def graph(draw: st.DrawFn) -> GridGraph:
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    rows, cols = draw(st.integers(2, 8)), draw(st.integers(2, 8))
    blocked = rng.random((rows, cols)) < 0.3
    blocked[rows // 2, cols // 2] = False
    return GridGraph(blocked, draw(st.sampled_from([4, 8])), draw(st.sampled_from([0.0, 0.5])))


@settings(max_examples=50, deadline=None)
@given(graph())
def test_a_move_leads_to_the_next_place_and_cuts_no_corner(found: GridGraph) -> None:
    rows, cols = found.index.shape

    def place(row: int, col: int) -> int:
        return int(found.index[row, col]) if 0 <= row < rows and 0 <= col < cols else -1

    for here, (row, col) in enumerate(found.cells):
        for m, (dr, dc) in enumerate(MOVES):
            there = place(row + dr, col + dc)
            if m > found.connectivity or (dr and dc and (place(row + dr, col) < 0 or place(row, col + dc) < 0)):
                there = -1
            assert found.neighbours[here, m] == there


@settings(max_examples=30, deadline=None)
@given(graph(), st.data())
def test_the_way_back_is_as_long_as_the_way_there(found: GridGraph, data: st.DataObject) -> None:
    one, other = (data.draw(st.integers(0, len(found) - 1)) for _ in range(2))
    assert found.ahead(one)[other] == found.ahead(other)[one]
    assert found.ahead(one)[one] == 0
    assert found.ahead(one) is found.ahead(one)  # kept


def slow_cost(found: GridGraph, start: int, goal: int, surcharge: np.ndarray) -> int:
    """Dijkstra forwards: every place that is entered costs a step, a unit for a diagonal, and its surcharge."""
    best, queue = {start: 0}, [(0, start)]
    while queue:
        spent, here = heapq.heappop(queue)
        if here == goal:
            return spent
        if spent > best[here]:
            continue
        for m in range(1, 9):
            there = int(found.neighbours[here, m])
            new = spent + int(STEP) + (m > 4) + int(surcharge[there])
            if there >= 0 and new < best.get(there, 2**60):
                best[there] = new
                heapq.heappush(queue, (new, there))
    return int(UNREACHABLE)


@settings(max_examples=30, deadline=None)
@given(graph(), st.data())
def test_surcharged_ways_are_the_cheapest(found: GridGraph, data: st.DataObject) -> None:
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    surcharge = (rng.integers(0, 4, len(found)) * rng.integers(0, int(STEP), len(found))).astype(np.int32)
    goal = data.draw(st.integers(0, len(found) - 1))
    costs = found.ahead_with(goal, surcharge)
    for start in range(len(found)):
        assert costs[start] == slow_cost(found, start, goal, surcharge)


def test_equal_grids_share_their_roads_and_others_do_not() -> None:
    grid = np.zeros((5, 9), bool)
    grid[2, 3] = True
    first = grid_graph_of(grid, 8, 0.5)
    assert grid_graph_of(grid.copy(), 8, 0.5) is first
    changed = grid.copy()
    changed[0, 0] = True
    others = [
        grid_graph_of(changed, 8, 0.5),
        grid_graph_of(grid, 4, 0.5),
        grid_graph_of(grid, 8, 0.4),
        grid_graph_of(grid.T.copy(), 8, 0.5),
    ]
    assert all(other is not first for other in others)
    assert np.array_equal(first.index < 0, GridGraph(grid, 8, 0.5).index < 0)


def test_a_place_is_the_number_of_its_cell() -> None:
    grid = np.zeros((3, 4), bool)
    grid[1, 1] = True
    found = GridGraph(grid, 4, 0.0)
    assert len(found) == 11
    assert [found.place(cell) for cell in found.cells] == list(range(11))
    assert found.place(np.array([1, 1])) == -1


@pytest.mark.parametrize(("first", "second", "same"), [(30, 30, True), (30, 20, True), (20, 40, False)])
def test_tables_are_lent_again_if_it_is_large_enough(first: int, second: int, same: bool) -> None:
    found = GridGraph(np.zeros((3, 3), bool), 4, 0.0)
    one = found.borrow(first)
    found.give_back(one)
    other = found.borrow(second)
    assert (other is one) == same and other.times >= second


def test_nobody_shares_tables_and_few_are_kept() -> None:
    found = GridGraph(np.zeros((3, 3), bool), 4, 0.0)
    lent = [found.borrow(10) for _ in range(4)]
    assert all(a is not b for a, b in itertools.combinations(lent, 2))
    for tables in lent:
        found.give_back(tables)
    again = [found.borrow(10) for _ in range(4)]
    assert sum(any(a is b for b in lent) for a in again) == 2
