import math
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning import plan_team
from lidarena.planning.team.arrangements import decide, is_small, needed_loops, rank_of, word_of, write_permutation
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.team_plan import TeamPlan
from tests.planning.team.problems import Problem, crowded, faults, parse, plan, traffic_of
from tests.planning.team.test_lacam import is_solvable


@pytest.mark.parametrize("team", [1, 2, 4, 5])
def test_permutations_are_numbered_in_their_order(team):
    for number, permutation in enumerate(permutations(range(team))):
        assert rank_of(np.array(permutation)) == number
        written = np.zeros(team, np.int64)
        write_permutation(np.int64(number), written)
        assert tuple(written.tolist()) == permutation


@given(st.integers(0, 2**32 - 1), st.integers(1, 5))
@settings(max_examples=60, deadline=None)
def test_words_and_needed_loops_make_the_group_of_the_loops(seed, generators):
    """Against the closure of tuples under composition."""
    team, count = 4, math.factorial(4)
    loops = np.random.default_rng(seed).integers(1, count, generators)
    by_rank = {rank_of(np.array(p)): p for p in permutations(range(team))}
    group, waiting = {tuple(range(team))}, [tuple(range(team))]
    while waiting:
        element = waiting.pop()
        for loop in loops:
            product = tuple(by_rank[int(loop)][i] for i in element)
            if product not in group:
                group.add(product)
                waiting.append(product)
    needed = needed_loops(loops, np.int64(team), np.int64(count))
    assert set(needed.tolist()) <= set(loops.tolist())
    for target, wanted in by_rank.items():
        for chosen in (loops, needed):
            found, word = word_of(np.int64(target), chosen, np.int64(team), np.int64(count))
            assert found == (wanted in group)
            element = tuple(range(team))
            for loop in word.tolist():
                element = tuple(by_rank[loop][i] for i in element)
            assert not found or element == wanted


def check(problem: Problem) -> bool:
    """Decide a problem; what is found has no fault. Whether there is a plan."""
    traffic = traffic_of(problem)
    verdict = decide(traffic.graph, traffic.ends)
    assert (verdict.paths is None) == verdict.impossible
    if verdict.paths is None:
        return False
    lengths = np.array([np.flatnonzero(np.r_[True, path[1:] != path[:-1]]).max() for path in verdict.paths])
    cells = [traffic.graph.cells[path[: n + 1]] for path, n in zip(verdict.paths, lengths, strict=True)]
    cost = float(lengths.sum())
    assert faults(problem, TeamPlan(True, cells, cost, 0.0, cost == 0.0, "")) == []
    return True


@given(st.integers(0, 2**32 - 1), st.integers(5, 8), st.integers(2, 4))
@settings(max_examples=80, deadline=None)
def test_it_decides_as_a_search_over_all_arrangements_does(seed, places, robots):
    problem = crowded(seed, 3, places, robots)
    assert check(problem) == is_solvable(problem)


def test_a_full_ring_can_turn_and_not_swap():
    ring = np.zeros((3, 3), bool)
    ring[1, 1] = True
    around = [(0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0)]
    turned = plan_team(ring, around, around[3:] + around[:3], "prioritized_search", 4)
    assert turned.solved
    swapped = [around[1], around[0], *around[2:]]
    refused = plan_team(ring, around, swapped, "prioritized_search", 4)
    assert not refused.solved and refused.message.startswith("There is no plan")


MISSED = [
    (
        (".....", ".@@..", ".@@@@", "...@@", "@...."),
        [(3, 0), (0, 1), (3, 2), (0, 3), (4, 4), (0, 4)],
        [(4, 1), (0, 1), (4, 2), (0, 2), (0, 3), (0, 4)],
    ),
    (
        (".@..", "@...", ".@..", "..@.", "...."),
        [(4, 0), (3, 3), (0, 3), (1, 2), (0, 2), (2, 2), (1, 1)],
        [(4, 1), (0, 3), (3, 3), (2, 2), (4, 2), (2, 0), (2, 3)],
    ),
]


@pytest.mark.parametrize(("rows", "starts", "goals"), MISSED)
def test_what_lacam_alone_misses_for_long_is_solved(rows, starts, goals):
    grid = np.array([[cell == "@" for cell in row] for row in rows])
    problem = Problem(grid, np.array(starts), np.array(goals), 8, 0.5)
    assert check(problem)
    found = plan(problem, "prioritized_search", time_limit=math.inf, iterations=20)
    assert found.solved and faults(problem, found) == []


def test_large_boards_and_teams_are_left_to_others():
    assert is_small(GridGraph(np.zeros((4, 4), bool), 4, 0.0), 9)
    assert not is_small(GridGraph(np.zeros((4, 6), bool), 4, 0.0), 9)
    assert not is_small(GridGraph(np.zeros((4, 5), bool), 4, 0.0), 10)
    assert not is_small(GridGraph(np.zeros((4, 5), bool), 4, 0.0), 9)


def test_a_plan_that_fits_no_more_than_its_discs_is_not_said_to_be_impossible():
    """Discs larger than a cell may have to move at once where no ring is: that nobody found a way proves nothing."""
    problem = parse(".....\n.a.b.\n.B.A.\n.....", radius=0.7)
    traffic = traffic_of(problem)
    assert len(traffic.graph) == 6
    verdict = decide(traffic.graph, traffic.ends)
    assert verdict.paths is None and not verdict.impossible
