"""What the planners look up: graph, footprints, reservations, conflicts, and the two searches in space and time."""

import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.grid.grid_search import path_costs
from lidarena.planning.team.conflicts import conflict_times
from lidarena.planning.team.grid_graph import STEP, UNREACHABLE, GridGraph
from lidarena.planning.team.moves import MOVES, conflicting_moves
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.traffic import Traffic
from tests.planning.team.problems import is_empty, meet, problems

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def traffic_of(problem, **options):
    grid, starts, goals, connectivity, radius = problem
    graph = GridGraph(grid, connectivity, radius)
    ends = np.stack([graph.index[tuple(starts.T)], graph.index[tuple(goals.T)]], axis=1).astype(np.int64)
    return Traffic(graph, ends, **options)


@settings(deadline=None)  # the first example compiles
@given(st.lists(st.integers(0, 50), max_size=60))
def test_the_open_list_sorts(numbers):
    keys, items = np.empty(64, np.int64), np.empty(64, np.int32)
    size = 0
    for item, key in enumerate(numbers):
        size = push(keys, items, np.int64(size), np.int64(key), np.int64(item))
    taken = []
    while size > 0:
        taken.append((int(keys[0]), int(items[0])))
        size = pop(keys, items, np.int64(size))
    assert [key for key, _ in taken] == sorted(numbers)
    assert all(numbers[item] == key for key, item in taken)


@pytest.mark.parametrize("apart", [0.0, 0.8, 1.0, 1.5, 2.0, 2.6])
def test_footprints_are_the_conflicts_by_definition(apart):
    table = conflicting_moves(apart, 8)
    for move, other in itertools.product(range(9), repeat=2):
        for cell in itertools.product(range(-5, 6), repeat=2):
            expected = meet((0, 0), cell, tuple(MOVES[move]), tuple(np.add(cell, MOVES[other])), apart)
            assert bool(table[move].get(cell, 0) >> other & 1) == expected, (move, other, cell)


@pytest.mark.parametrize("connectivity", [4, 8])
def test_ways_alone_are_the_shortest(connectivity):
    rng = np.random.default_rng(0)
    grid = rng.random((14, 17)) < 0.3
    grid[3, 4] = False
    graph = GridGraph(grid, connectivity, 0.0)
    ahead = graph.ahead(graph.place(np.array([3, 4])))
    lengths = path_costs(np.where(grid, np.inf, 1.0), (3, 4), connectivity == 8)
    for place, (row, col) in enumerate(graph.cells):
        reached = ahead[place] < UNREACHABLE
        assert reached == np.isfinite(lengths[row, col])
        if reached and connectivity == 4:
            assert ahead[place] == lengths[row, col] * STEP
        if reached:
            assert ahead[place] // STEP <= lengths[row, col]
    surcharged = graph.ahead_with(graph.place(np.array([3, 4])), np.zeros(len(graph), np.int32))
    assert np.array_equal(surcharged, ahead)


def test_the_places_of_a_disc_are_where_it_fits():
    grid = np.zeros((9, 9), bool)
    grid[4, 4] = True
    graph = GridGraph(grid, 8, 1.0)
    assert not (graph.index[3:6, 3:6] >= 0).any() and graph.index[2, 4] >= 0
    assert (graph.index[0] < 0).all() and graph.index[1, 1] >= 0


@settings(max_examples=60, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)))
def test_safe_intervals_find_what_places_at_times_find(problem):
    """Both searches, robot by robot past the same reservations, need as many steps or both fail."""
    quick, slow = traffic_of(problem), traffic_of(problem, timed=True)
    for robot in range(len(quick)):
        one = np.array([robot])
        placed = quick.plan(one)
        assert slow.plan(one) == placed
        if placed:
            assert slow.lengths[robot] == quick.lengths[robot]
            slow.remove(one)  # the same path for both, so that the next robot meets the same tables
            slow.paths[robot], slow.lengths[robot] = quick.paths[robot], quick.lengths[robot]
            slow.place(one)
    assert np.array_equal(quick.reserved.table[:, : quick.capacity], slow.reserved.table[:, : quick.capacity])


@settings(max_examples=40, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)))
def test_replanning_keeps_the_tables_in_step_with_the_paths(problem):
    traffic = traffic_of(problem)
    if traffic.plan(np.arange(len(traffic))) < len(traffic):
        return
    before = traffic.cost()
    for group in itertools.permutations(range(len(traffic)), 2):
        traffic.replan(np.array(group))
        assert traffic.cost() <= before
        before = traffic.cost()
        fresh = traffic_of(problem)
        fresh.paths[:], fresh.lengths[:] = traffic.paths, traffic.lengths
        fresh.place(np.arange(len(traffic)))
        assert np.array_equal(fresh.reserved.table, traffic.reserved.table) and np.array_equal(
            fresh.reserved.since, traffic.reserved.since
        )
        assert (conflict_times(traffic.graph.cells, traffic.paths, traffic.lengths, traffic.graph.apart) < 0).all()


def test_the_room_for_searches_comes_back_empty():
    graph = GridGraph(np.zeros((6, 6), bool), 8, 0.5)
    for _ in range(3):
        traffic = Traffic(graph, np.array([[0, 35], [35, 0]], np.int64))
        assert is_empty(traffic.reserved)
        assert traffic.plan(np.array([0, 1])) == 2
        traffic.close()
