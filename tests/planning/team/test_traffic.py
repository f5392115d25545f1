import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.prioritized import conflicts_of, longest_first, plan_alone, plan_independent
from lidarena.planning.team.search import find_order
from lidarena.planning.team.team_plan import failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic
from tests.planning.team.problems import Problem, is_empty, problems
from tests.planning.team.test_grid_graph_and_conflicts import traffic_of

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def hall(*ends: tuple[int, int], rows: int = 5, cols: int = 9) -> Traffic:
    return Traffic(GridGraph(np.zeros((rows, cols), bool), 8, 0.0), np.array(ends, np.int64))


@settings(max_examples=25, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)), st.data())
def test_whoever_is_removed_and_placed_again_leaves_the_tables_as_they_were(
    problem: Problem, data: st.DataObject
) -> None:
    traffic = traffic_of(problem)
    placed = traffic.plan(np.arange(len(traffic)))
    everyone = np.flatnonzero(traffic.placed)
    assert len(everyone) == placed
    before = [array.copy() for array in (traffic.reserved.table, traffic.reserved.until, traffic.reserved.since)]
    some = np.array(sorted(data.draw(st.sets(st.sampled_from(everyone.tolist()), min_size=1))))
    traffic.remove(some)
    assert not traffic.placed[some].any() and traffic.placed.sum() == placed - len(some)
    traffic.place(some)
    for array, old in zip(
        (traffic.reserved.table, traffic.reserved.until, traffic.reserved.since), before, strict=True
    ):
        assert np.array_equal(array, old)
    traffic.remove(everyone)
    assert is_empty(traffic.reserved)


def test_a_closed_team_keeps_its_paths_and_leaves_nothing_behind() -> None:
    traffic = hall((0, 44), (8, 36))
    assert traffic.plan(np.array([0, 1])) == 2
    cells, cost = [path.copy() for path in traffic.cells()], traffic.cost()
    traffic.close()
    assert is_empty(traffic.reserved) and traffic.cost() == cost
    for path, old in zip(traffic.cells(), cells, strict=True):
        assert np.array_equal(path, old)
    after = Traffic(traffic.graph, np.array([[0, 44], [8, 36]], np.int64))
    assert after.reserved.table is traffic.reserved.table  # the room is lent again


def test_cells_are_the_paths_up_to_the_goal() -> None:
    traffic = hall((0, 8), (9, 9))
    traffic.plan(np.array([0, 1]))
    straight, rest = traffic.cells()
    assert straight.tolist() == [[0, col] for col in range(9)] and rest.tolist() == [[1, 0]]
    assert traffic.lengths.tolist() == traffic.alone.tolist() == [8, 0] and traffic.cost() == 8


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


@pytest.mark.parametrize(("bound", "optimal"), [(None, False), (9, False), (10, True)])
def test_a_plan_is_optimal_if_its_bound_says_so(bound: int | None, optimal: bool) -> None:
    traffic = hall((0, 8))
    traffic.delays[0] = 2
    traffic.plan(np.array([0]))
    plan = solved_plan(traffic, "done", bound, np.array([0]))
    assert (plan.solved, plan.cost, plan.optimal, plan.order) == (True, 10.0, optimal, (0,))
    assert plan.lower_bound == (8 if bound is None else bound)


def test_a_failed_plan_has_the_paths_of_those_who_were_placed() -> None:
    traffic = hall((0, 8), (9, 17))
    traffic.plan(np.array([1]))
    plan = failed_plan(traffic, "robot 0 failed", np.array([1, 0]))
    assert not plan.solved and not plan.optimal and plan.cost == float("inf") and plan.lower_bound == 16.0
    assert plan.paths[0].shape == (0, 2) and len(plan.paths[1]) == 9 and plan.order == (1, 0)
