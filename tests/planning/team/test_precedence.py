"""A plan's order keeps robots apart at any speed, and lets somebody go on at any time."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lidarena.planning.team.plan import plan_team
from lidarena.planning.team.precedence import Precedence
from lidarena.planning.team.team_plan import TeamPlan
from tests.planning.team.problems import parse

Floats = NDArray[np.float64]
GRID = np.zeros((12, 12), bool)
GRID[6, :4] = GRID[6, 8:] = True
ENDS = np.array([(2, 2), (2, 6), (2, 9), (9, 2), (9, 6), (9, 9)])


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
    blocked = [step for step in steps if len(order.blocking_agents(int(second), step, nobody))]
    assert blocked and order.blocking_agents(int(second), blocked[0], nobody).tolist() == [first]
    done = order.lengths.copy()
    assert not any(
        len(order.blocking_agents(robot, step, done)) for robot in (0, 1) for step in range(order.lengths[robot])
    )


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
                 and not len(order.blocking_agents(r, int(completed[r]), completed))]  # fmt: skip
        assert ready, "a deadlock"
        completed[rng.choice(ready)] += 1  # one robot alone takes a whole step
        here = np.array([order.paths[r, completed[r]] for r in range(6)])
        gaps = np.hypot(*(here[:, None] - here[None]).transpose(2, 0, 1)) + 9 * np.eye(6)
        assert gaps.min() >= 2 * radius - 1e-9
    assert (completed == order.lengths).all()


def planned(seed: int, radius: float) -> TeamPlan:
    goals = ENDS[np.random.default_rng(seed).permutation(6)]
    plan = plan_team(GRID, ENDS, goals, "prioritized_search", 8, radius, np.inf, iterations=40, seed=seed)
    assert plan.solved
    return plan


def nearest(a: Floats, b: Floats, c: Floats, d: Floats) -> float:
    """Distance of two segments, by looking at points all along the one against the whole of the other."""
    shares = np.linspace(0.0, 1.0, 41)[:, None]
    least = np.inf
    for (p, q), (r, s) in (((a, b), (c, d)), ((c, d), (a, b))):
        points, along = p + shares * (q - p), s - r
        square = max(float(along @ along), 1e-12)
        at = np.clip((points - r) @ along / square, 0.0, 1.0)
        least = min(least, float(np.hypot(*(points - r - at[:, None] * along).T).min()))
    return least


@pytest.mark.parametrize("seed", range(3))
def test_before_a_step_the_others_have_done_every_earlier_step_that_comes_near_it(seed: int) -> None:
    apart = 1.0
    order = Precedence(planned(seed, apart / 2), apart)
    for i, j in itertools.permutations(range(6), 2):
        for a in range(order.lengths[i]):
            near = [
                nearest(order.paths[i, a], order.paths[i, a + 1], order.paths[j, b], order.paths[j, b + 1])
                < apart - 0.01
                for b in range(min(a, order.lengths[j]))
            ]
            done = order.lengths.copy()
            for b in np.flatnonzero(near):
                done[j] = b  # it has not completed step b
                assert j in order.blocking_agents(i, a, done)
            done[j] = a + 1  # what it does later in the plan is none of i's business
            assert j not in order.blocking_agents(i, a, done)


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 50), st.sampled_from([0.5, 0.7]))
def test_nobody_waits_in_a_ring(seed: int, radius: float) -> None:
    """Steps and what must be done before them are sorted until none is left; discs follow each other in no ring."""
    order = Precedence(planned(seed, radius), 2 * radius)
    done = np.zeros(6, np.int64)
    while (done < order.lengths).any():
        free = [
            r for r in range(6) if done[r] < order.lengths[r] and not len(order.blocking_agents(r, int(done[r]), done))
        ]
        assert free, f"everybody waits for somebody at {done}"
        done[free] += 1


def test_who_is_behind_in_the_plan_never_waits_for_who_is_ahead() -> None:
    order = Precedence(planned(1, 0.5), 1.0)
    for robot in range(6):
        for step in range(order.lengths[robot]):
            ahead = np.full(6, step + 1)
            assert not len(order.blocking_agents(robot, step, ahead))


@pytest.mark.parametrize("seed", range(4))
def test_at_any_speeds_robots_that_keep_the_order_never_overlap(seed: int) -> None:
    """All move at once, each along its own step at its own changing speed."""
    radius, rng = 0.5, np.random.default_rng(seed)
    order = Precedence(planned(seed, radius), 2 * radius)
    done, share = np.zeros(6, np.int64), np.zeros(6)
    least = np.inf
    for _ in range(4000):
        if (done >= order.lengths).all():
            break
        for robot in np.flatnonzero(done < order.lengths):
            if share[robot] > 0.0 or not len(order.blocking_agents(int(robot), int(done[robot]), done)):
                share[robot] += rng.choice([0.0, 0.05, 0.3])
            if share[robot] >= 1.0:
                done[robot], share[robot] = done[robot] + 1, 0.0
        here = np.array([
            (1 - s) * order.paths[r, n] + s * order.paths[r, min(n + 1, order.lengths[r])]
            for r, (n, s) in enumerate(zip(done, share, strict=True))
        ])  # fmt: skip
        least = min(least, min(float(np.hypot(*(a - b))) for a, b in itertools.combinations(here, 2)))
    assert (done >= order.lengths).all()
    assert least >= 2 * radius - 1e-6


def test_who_takes_anothers_room_in_the_same_step_lets_it_go_first() -> None:
    paths = [np.array([(0, col) for col in range(start, start + 4)]) for start in (0, 1)]
    order = Precedence(TeamPlan(True, paths, 6.0, 6.0, True, ""), 0.8)
    assert order.blocking_agents(0, 0, np.zeros(2, np.int64)).tolist() == [1]
    assert not len(order.blocking_agents(1, 0, np.zeros(2, np.int64)))
    assert not len(order.blocking_agents(0, 0, np.array([0, 1])))
