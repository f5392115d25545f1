"""Certified optima are those of brute force."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.planning.team.problems import Problem, brute_force, parse, plan, problems

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


CROSSING = """
    @@.@@
    @.b.@
    aA.B.
    @...@
    @@.@@
"""


@settings(max_examples=12, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.just(3), sides=st.integers(2, 3)))
def test_the_certified_optimum_of_three_robots_is_that_of_brute_force(problem):
    expected = brute_force(problem)
    found = plan(problem, "cbs", time_limit=5.0, iterations=100)
    assert found.lower_bound <= expected <= found.cost
    if found.optimal:
        assert found.cost == expected


@pytest.mark.parametrize("connectivity", [4, 8])
def test_certified_optimum_of_a_known_problem(connectivity):
    problem = parse(CROSSING, connectivity)
    found = plan(problem, "cbs")
    assert (found.cost, found.optimal) == (brute_force(problem), True)


def test_a_robot_at_its_goal_blocks_and_one_at_its_start_may_be_its_own_goal():
    problem = Problem(np.zeros((3, 5), bool), np.array([(1, 0), (1, 2)]), np.array([(1, 4), (1, 2)]), 4)
    found = plan(problem, "cbs")
    assert found.cost == 6 and found.optimal and len(found.paths[1]) == 1
