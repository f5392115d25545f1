"""Ways in space and time against a plain Dijkstra over places at times."""

import heapq

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.deviation import DeviationCosts
from lidarena.planning.team.grid_graph import STEP, GridGraph
from lidarena.planning.team.traffic import Traffic
from tests.planning.team.problems import Problem, meet, problems, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]
TWO = problems(robots=st.just(2), sides=st.integers(2, 5))


def whereabouts(traffic: Traffic, robot: int, t: int) -> np.ndarray:
    return traffic.graph.cells[traffic.paths[robot, min(t, traffic.lengths[robot])]]


def slow_cost(traffic: Traffic, robot: int, other: int) -> float:
    """What the cheapest way past another robot's path costs, in whole steps; inf if there is none."""
    graph, last = traffic.graph, int(traffic.lengths[other])

    def free(here: int, there: int, t: int) -> bool:
        away = whereabouts(traffic, other, t), whereabouts(traffic, other, t + 1)
        return not meet(graph.cells[here], away[0], graph.cells[there], away[1], graph.apart)

    start, goal = traffic.ends[robot].tolist()
    settled, horizon = set(), last + 2 * len(graph) + 10
    queue = [(0, 0, start)]
    while queue:
        spent, t, here = heapq.heappop(queue)
        if here == goal and all(free(goal, goal, s) for s in range(t, max(t, last) + 1)):
            return spent
        if (t, here) in settled or t == horizon:
            continue
        settled.add((t, here))
        for there in graph.neighbours[here]:
            if there >= 0 and free(here, int(there), t):
                row = min(t + 1, len(traffic.layer) - 1)
                extra = int(traffic.base[there] + traffic.layer[row, there]) // int(STEP)
                heapq.heappush(queue, (spent + 1 + extra, t + 1, int(there)))
    return float("inf")


def cost_of_path(traffic: Traffic, robot: int) -> int:
    path = traffic.paths[robot, 1 : traffic.lengths[robot] + 1]
    rows = np.minimum(np.arange(1, len(path) + 1), len(traffic.layer) - 1)
    extra = traffic.base[path] + traffic.layer[rows, path]
    return len(path) + int(extra.sum()) // int(STEP)


def surcharged(problem: Problem, seed: int, deviation: bool) -> Traffic:
    """The first robot placed, the second one still to be planned among costs by place, and by time if wanted."""
    grid, starts, goals, connectivity, radius = problem
    graph = GridGraph(grid, connectivity, radius)
    ends = np.stack([graph.index[tuple(starts.T)], graph.index[tuple(goals.T)]], axis=1).astype(np.int64)
    extra = np.random.default_rng(seed).choice([0, 0, 1, 4], len(graph)) * int(STEP)
    traffic = Traffic(graph, ends, extra.astype(np.int32))
    assert traffic.timed
    assert traffic.plan(np.array([0])) == 1
    if deviation:
        DeviationCosts([(0.0, 3.0), (1.0, 1.0), (1.2, 0.0)]).add(traffic, 0)
    return traffic


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(TWO, st.integers(0, 10**6), st.booleans())
def test_a_way_past_another_robot_is_the_cheapest(problem: Problem, seed: int, deviation: bool) -> None:
    assume(len(problem.starts) == 2)
    traffic = surcharged(problem, seed, deviation)
    expected = slow_cost(traffic, 1, 0)
    assert bool(traffic.plan(np.array([1]))) == np.isfinite(expected)
    if np.isfinite(expected):
        assert cost_of_path(traffic, 1) == expected
    traffic.close()


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(TWO)
def test_the_quickest_way_past_another_robot_is_dijkstras(problem: Problem) -> None:
    assume(len(problem.starts) == 2)
    traffic = traffic_of(problem)
    assert traffic.plan(np.array([0])) == 1
    expected = slow_cost(traffic, 1, 0)
    assert bool(traffic.plan(np.array([1]))) == np.isfinite(expected)
    if np.isfinite(expected):
        assert traffic.lengths[1] == expected


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(TWO, st.booleans())
def test_a_budget_is_kept_and_one_step_less_is_too_little(problem: Problem, timed: bool) -> None:
    everyone = np.arange(len(problem.starts))
    traffic = traffic_of(problem, timed=timed)
    if traffic.plan(everyone) < len(everyone):
        return
    cost = traffic.cost()
    traffic.remove(everyone)
    assert traffic.plan(everyone, budget=cost) == len(everyone)
    assert traffic.cost() == cost
    traffic.remove(everyone)
    assert cost == 0 or traffic.plan(everyone, budget=cost - 1) < len(everyone)


def test_a_dearer_way_that_is_met_first_does_not_hide_a_cheaper_one() -> None:
    """Robot 0 crosses the place where robot 1 is and wants to be, which hides what 1 spends until then."""
    ends = np.array([[3, 3], [1, 0]]), np.array([[0, 0], [1, 0]])
    traffic = surcharged(Problem(np.zeros((5, 4), bool), *ends, 4, 0.0), 0, False)
    assert traffic.plan(np.array([1])) == 1
    assert cost_of_path(traffic, 1) == slow_cost(traffic, 1, 0) == 6
