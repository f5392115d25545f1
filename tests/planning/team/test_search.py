import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.prioritized import conflicts_of, longest_first
from lidarena.planning.team.search import find_order
from tests.planning.team.problems import Problem, hall, problems, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)), st.integers(0, 3))
def test_the_last_order_is_told_with_how_far_it_came(problem: Problem, orders: int) -> None:
    traffic = traffic_of(problem)
    order, placed, tried = find_order(traffic, Budget(float("inf"), orders), np.random.default_rng(0))
    assert sorted(order) == list(range(len(traffic))) and 1 <= tried <= orders + 1
    assert set(np.flatnonzero(traffic.placed)) == set(order[:placed])
    assert placed == len(order) or tried == orders + 1
    assert (conflicts_of(traffic)[np.ix_(order[:placed], order[:placed])] < 0).all()
    assert not traffic.delays.any()


def test_the_first_order_is_tried_without_any_budget() -> None:
    traffic = hall((0, 44), (8, 36))
    order, placed, tried = find_order(traffic, Budget(0.0, 0), np.random.default_rng(0))
    assert (placed, tried) == (2, 1) and order.tolist() == longest_first(traffic).tolist()
