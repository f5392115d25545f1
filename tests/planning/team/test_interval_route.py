"""The quickest ways by safe intervals, against the search over places at times."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.planning.team.problems import Problem, problems, taken_moves, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


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
    assert np.array_equal(*(taken_moves(traffic.reserved, quick.capacity) for traffic in (quick, slow)))


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.just(2), sides=st.integers(2, 5)), st.integers(0, 9))
def test_a_robot_alone_leaves_as_late_as_it_was_told(problem: Problem, delay: int) -> None:
    traffic = traffic_of(problem)
    traffic.delays[0] = delay
    assert traffic.plan(np.array([0])) == 1
    start = traffic.ends[0, 0]
    assert (traffic.paths[0, : delay + 1] == start).all()
    assert traffic.lengths[0] == delay + traffic.alone[0]
