"""The coordination diagram against a search over all points of time and path."""

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.coordination import plan_coordination
from lidarena.planning.team.prioritized import longest_first, plan_alone
from tests.planning.team.problems import Problem, meet, parse, problems, traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def at(path: np.ndarray, t: int) -> np.ndarray:
    return path[min(t, len(path) - 1)]


def slow_timing(path: np.ndarray, before: list[np.ndarray], apart: float, capacity: int, back_up: bool) -> int:
    """The earliest time at which a path's end is reached for good past finished robots; -1 without a timing."""
    final = max((len(other) for other in before), default=0)

    def free(here: np.ndarray, there: np.ndarray, t: int) -> bool:
        return not any(meet(here, at(other, t), there, at(other, t + 1), apart) for other in before)

    reached = {0}
    for t in range(capacity - 1):
        stays = all(free(path[-1], path[-1], s) for s in range(t, max(t, final) + 1))
        if len(path) - 1 in reached and stays:
            return t
        steps = [(s, s + ahead) for s in reached for ahead in range(-1 if back_up else 0, 2)]
        reached = {to for s, to in steps if 0 <= to < len(path) and free(path[s], path[to], t)}
    return -1


@settings(max_examples=30, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 3), sides=st.integers(2, 5)), st.booleans())
def test_each_robot_has_the_quickest_timing_past_the_ones_before_it(problem: Problem, back_up: bool) -> None:
    traffic, alone = traffic_of(problem), traffic_of(problem)
    plan_alone(alone)
    ways = alone.cells()
    plan = plan_coordination(traffic, back_up)
    done: list[np.ndarray] = []
    for robot in longest_first(alone):
        expected = slow_timing(ways[robot], done, traffic.graph.apart, traffic.capacity, back_up)
        assert (len(plan.paths[robot]) - 1 if len(plan.paths[robot]) else -1) == expected
        if expected < 0:
            assert not plan.solved and f"Robot {robot} " in plan.message
            return
        done.append(plan.paths[robot])
    assert plan.solved and plan.cost == sum(len(path) - 1 for path in done)


@settings(max_examples=30, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)), st.booleans())
def test_robots_keep_to_their_ways_and_without_backing_up_only_wait(problem: Problem, back_up: bool) -> None:
    traffic, alone = traffic_of(problem), traffic_of(problem)
    plan_alone(alone)
    plan = plan_coordination(traffic, back_up)
    for path, way in zip(plan.paths, alone.cells(), strict=True):
        assert {tuple(cell) for cell in path} <= {tuple(cell) for cell in way}
        if len(path) and not back_up:
            moved = np.concatenate([[True], np.any(np.diff(path, axis=0) != 0, axis=1)])
            np.testing.assert_array_equal(path[moved], way)


@settings(max_examples=30, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.just(2)))
def test_who_may_back_up_is_never_later(problem: Problem) -> None:
    assume(len(problem.starts) == 2)
    onwards, either = (plan_coordination(traffic_of(problem), back_up) for back_up in (False, True))
    assert either.cost <= onwards.cost


@pytest.mark.parametrize("back_up", [False, True])
def test_the_shorter_way_waits_at_a_crossing(back_up: bool) -> None:
    problem = parse(
        """
        @@b@@
        a...A
        @@.@@
        @@B@@
        """,
        4,
    )
    plan = plan_coordination(traffic_of(problem), back_up)
    assert plan.solved and plan.order == (0, 1)
    assert [len(path) - 1 for path in plan.paths] == [4, 3]  # b is past the crossing before a comes
