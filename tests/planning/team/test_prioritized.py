from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.prioritized import conflicts_of, longest_first, plan_alone, plan_independent
from tests.planning.team.problems import Problem, hall, is_empty, problems, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def test_priorities_are_by_length_and_equal_ones_by_number() -> None:
    assert longest_first(hall((0, 3), (9, 17), (18, 21), (27, 35), (36, 36))).tolist() == [1, 3, 0, 2, 4]


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(1, 4)))
def test_alone_everyone_takes_a_shortest_way_and_nobody_is_placed(problem: Problem) -> None:
    traffic = traffic_of(problem)
    plan_alone(traffic)
    assert traffic.lengths.tolist() == traffic.alone.tolist()
    assert not traffic.placed.any() and is_empty(traffic.reserved)
    plan = plan_independent(traffic)
    assert plan.solved == bool((conflicts_of(traffic) < 0).all())
    assert plan.cost == plan.lower_bound == traffic.alone.sum()
