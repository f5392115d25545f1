"""What conflict-based search proves, against the optimum that is found by looking at everything."""

import math

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.cbs import CbsResult, ConflictBasedSearch
from lidarena.planning.team.prioritized import conflicts_of
from lidarena.planning.team.traffic import Traffic
from tests.planning.team.problems import Problem, brute_force, is_empty, problems, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]
TINY = problems(robots=st.just(2), sides=st.integers(2, 3))


def search(problem: Problem, nodes: int, upper: int | None = None) -> tuple[CbsResult, Traffic]:
    traffic = traffic_of(problem)
    result = ConflictBasedSearch(traffic, upper).run(Budget(math.inf, nodes))
    assert is_empty(traffic.reserved)
    assert not traffic.placed.any()
    return result, traffic


@settings(max_examples=15, deadline=None, suppress_health_check=SLOW)
@given(TINY)
def test_what_is_found_is_the_optimum_and_leaves_the_tables_empty(problem: Problem) -> None:
    assume(len(problem.starts) == 2)
    expected = brute_force(problem)
    result, traffic = search(problem, 120)
    assert result.lower_bound <= expected
    if result.found:
        assert traffic.cost() == result.lower_bound == expected
        assert (conflicts_of(traffic) < 0).all()


@settings(max_examples=12, deadline=None, suppress_health_check=SLOW)
@given(TINY)
def test_a_known_optimum_is_proved_and_no_plan_at_its_cost_is_looked_for(problem: Problem) -> None:
    assume(len(problem.starts) == 2)
    expected = brute_force(problem)
    assume(math.isfinite(expected))
    result, _ = search(problem, 400, int(expected))
    assert not result.found
    assert result.lower_bound <= expected
    longer, traffic = search(problem, 400, int(expected) + 1)
    if longer.found:
        assert traffic.cost() == expected == result.lower_bound


@settings(max_examples=12, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4), sides=st.integers(2, 5)))
def test_more_nodes_never_weaken_the_bound(problem: Problem) -> None:
    alone = int(traffic_of(problem).alone.sum())
    bounds = [search(problem, nodes)[0].lower_bound for nodes in (0, 1, 4, 16)]
    assert bounds == sorted(bounds)
    assert bounds[0] >= alone


def test_a_team_without_conflicts_is_done_without_a_split() -> None:
    problem = Problem(np.zeros((3, 6), bool), np.array([(0, 0), (2, 0)]), np.array([(0, 5), (2, 5)]))
    result, traffic = search(problem, 1)
    assert result == CbsResult(10, 0, True) and traffic.cost() == 10
