import numpy as np
import pytest

from lidarena.planning.team.team_plan import failed_plan, solved_plan
from tests.planning.team.problems import hall


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
