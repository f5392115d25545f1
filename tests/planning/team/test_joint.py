"""The joint optimum of two robots is that of brute force."""

import math

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from lidarena.planning import plan_team
from tests.planning.team.problems import brute_force, faults, plan, problems

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


@settings(max_examples=40, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.just(2), sides=st.integers(2, 4)))
def test_the_optimum_of_two_robots_is_that_of_brute_force(problem):
    assume(len(problem.starts) == 2)
    expected = brute_force(problem)
    joint = plan(problem, "joint_astar")
    certified = plan(problem, "cbs", time_limit=5.0, iterations=300)
    assert joint.cost == expected
    assert joint.solved == joint.optimal == (expected < math.inf)
    if joint.solved:
        assert faults(problem, joint) == []
    if certified.optimal:
        assert certified.cost == expected
        assert faults(problem, certified) == []
    assert certified.lower_bound <= expected


def test_a_map_whose_pairs_of_places_have_no_room_is_refused_with_what_to_use_instead() -> None:
    found = plan_team(np.zeros((170, 170), bool), [(0, 0), (5, 5)], [(0, 9), (5, 0)], "joint_astar")
    assert not found.solved and "'cbs' finds the optimum on large maps" in found.message
