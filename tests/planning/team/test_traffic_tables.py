"""The tables keep in step with the paths."""

import itertools

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.conflicts import conflict_times
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.traffic import Traffic
from tests.planning.team.problems import is_empty, problems, taken_moves, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


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
        assert np.array_equal(*(taken_moves(one.reserved, traffic.capacity) for one in (fresh, traffic)))
        assert np.array_equal(fresh.reserved.since, traffic.reserved.since)
        assert (conflict_times(traffic.graph.cells, traffic.paths, traffic.lengths, traffic.graph.apart) < 0).all()


def test_the_room_for_searches_comes_back_empty():
    graph = GridGraph(np.zeros((6, 6), bool), 8, 0.5)
    for _ in range(3):
        traffic = Traffic(graph, np.array([[0, 35], [35, 0]], np.int64))
        assert is_empty(traffic.reserved)
        assert traffic.plan(np.array([0, 1])) == 2
        traffic.close()
