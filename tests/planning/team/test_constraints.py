"""Two robots that conflict are kept apart by constraints of which every plan without conflicts obeys one."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.constraints import Constraint, forbid, permit, split
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.moves import MOVES
from lidarena.planning.team.search_arrays import counts_at, empty_tables
from tests.planning.team.problems import is_empty, meet

SIDE, TIMES = 8, 12
GRAPHS = {radius: GridGraph(np.zeros((SIDE, SIDE), bool), 8, radius) for radius in (0.0, 0.5, 0.9)}


def places_and_moves(constraint: Constraint) -> list[tuple[int, int]]:
    """What a constraint forbids, as (place, move)."""
    return [(int(place), m) for place, bits in constraint.moves for m in range(9) if bits >> m & 1]


def together(graph: GridGraph, one: tuple[int, int], other: tuple[int, int]) -> bool:
    """Whether two robots that do these (place, move) conflict."""
    begins = [graph.cells[place] for place, _ in (one, other)]
    ends = [graph.cells[place] + MOVES[move] for place, move in (one, other)]
    return meet(*begins, *ends, graph.apart)


@st.composite
def conflicting(draw: st.DrawFn) -> tuple[GridGraph, tuple[int, int], tuple[int, int]]:
    """Two robots in the middle of a hall whose moves conflict."""
    graph = GRAPHS[draw(st.sampled_from(sorted(GRAPHS)))]
    pairs = []
    one = (graph.place(np.array([4, 4])), draw(st.integers(0, 8)))
    for cell in itertools.product(range(2, 7), repeat=2):
        for move in range(9):
            other = (graph.place(np.array(cell)), move)
            if cell != (4, 4) and together(graph, one, other):
                pairs.append(other)
    return graph, one, draw(st.sampled_from(pairs))


@settings(max_examples=40, deadline=None)
@given(conflicting())
def test_both_moves_are_forbidden_and_any_two_that_are_would_conflict(
    case: tuple[GridGraph, tuple[int, int], tuple[int, int]],
) -> None:
    graph, one, other = case
    steps = np.array([[place, graph.neighbours[place, move]] for place, move in (one, other)], np.int64)
    first, second = split(graph, np.zeros((9, 2), np.int64), (3, 5), 7, steps, -1)
    assert (first.robot, second.robot, first.time, second.time) == (3, 5, 7, 7)
    assert not first.forever and not second.forever
    forbidden = places_and_moves(first), places_and_moves(second)
    assert one in forbidden[0] and other in forbidden[1]
    assert all(together(graph, a, b) for a, b in itertools.product(*forbidden))


@pytest.mark.parametrize("radius", sorted(GRAPHS))
@pytest.mark.parametrize("resting", [0, 1])
def test_one_at_its_goal_is_never_come_close_to_or_arrives_later(radius: float, resting: int) -> None:
    graph = GRAPHS[radius]
    goal = graph.place(np.array([3, 4]))
    ends = np.array([[0, 0], [0, 0]], np.int64)
    ends[resting, 1] = goal
    away, rests = split(graph, ends, (0, 1), 5, np.zeros((2, 2), np.int64), resting)
    assert (away.robot, away.time, away.forever) == (1 - resting, 5, True)
    assert (rests.robot, rests.time, rests.forever) == (resting, 5, False)
    assert rests.moves.tolist() == [[goal, 1]]
    every = itertools.product(range(len(graph)), range(9))
    close = {pair for pair in every if together(graph, (goal, 0), pair)}
    inside = {(p, m) for p, m in places_and_moves(away) if graph.neighbours[p, m] >= 0}
    assert inside == {(p, m) for p, m in close if graph.neighbours[p, m] >= 0}


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 5), st.integers(1, 511)), min_size=1, max_size=4), st.integers(0, 9))
def test_what_is_forbidden_stands_in_the_tables_until_it_is_permitted(moves: list[tuple[int, int]], time: int) -> None:
    for forever in (False, True):
        reserved = empty_tables(6, TIMES).reserved
        until, since = reserved.until, reserved.since
        forbid(np.array(moves, np.int64), time, forever, reserved)
        wanted = {(place, m) for place, bits in moves for m in range(9) if bits >> m & 1}
        for place, m, t in itertools.product(range(6), range(9), range(TIMES)):
            taken = bool((t < until[place] and counts_at(reserved, place, t) >> 4 * m & 15) or t >= since[place, m])
            assert taken == ((place, m) in wanted and (t >= time if forever else t == time))
        permit(np.array(moves, np.int64), time, forever, reserved)
        assert is_empty(reserved)
