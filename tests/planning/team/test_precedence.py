"""A plan's order keeps robots apart at any speed, and lets somebody go on at any time."""

import numpy as np
import pytest

from lidarena.planning.team.plan import plan_team
from lidarena.planning.team.precedence import Precedence
from tests.planning.team.problems import parse


def crossing():
    problem = parse("...b...\n.......\n.......\na.....A\n.......\n.......\n...B...", 4, 0.0)
    return plan_team(problem.grid, problem.starts, problem.goals, "prioritized_search", 4, 0.5, iterations=50)


def test_who_passes_later_in_the_plan_waits_for_who_passes_first():
    plan = crossing()
    order = Precedence(plan, 1.0)
    meeting = [[tuple(cell) for cell in path].index((3, 3)) for path in plan.paths]
    first, second = np.argsort(meeting)
    nobody = np.zeros(2, np.int64)
    steps = range(int(order.lengths[second]))
    blocked = [step for step in steps if len(order.hinderers(int(second), step, nobody))]
    assert blocked and order.hinderers(int(second), blocked[0], nobody).tolist() == [first]
    done = order.lengths.copy()
    assert not any(len(order.hinderers(robot, step, done)) for robot in (0, 1) for step in range(order.lengths[robot]))


@pytest.mark.parametrize("seed", range(8))
def test_at_random_speeds_nobody_collides_and_everybody_arrives(seed):
    rng = np.random.default_rng(seed)
    grid = np.zeros((14, 14), bool)
    grid[7, :6] = grid[7, 8:] = True
    starts = np.array([(2, 2), (2, 6), (2, 11), (11, 2), (11, 7), (11, 11)])
    goals = starts[rng.permutation(6)]
    radius = 0.5
    plan = plan_team(grid, starts, goals, "prioritized_search", 8, radius, iterations=50, seed=seed)
    assert plan.solved
    order = Precedence(plan, 2 * radius)
    completed = np.zeros(6, np.int64)
    for _ in range(2000):
        if (completed == order.lengths).all():
            break
        ready = [r for r in range(6) if completed[r] < order.lengths[r]
                 and not len(order.hinderers(r, int(completed[r]), completed))]  # fmt: skip
        assert ready, "a deadlock"
        completed[rng.choice(ready)] += 1  # one robot alone takes a whole step
        here = np.array([order.paths[r, completed[r]] for r in range(6)])
        gaps = np.hypot(*(here[:, None] - here[None]).transpose(2, 0, 1)) + 9 * np.eye(6)
        assert gaps.min() >= 2 * radius - 1e-9
    assert (completed == order.lengths).all()
