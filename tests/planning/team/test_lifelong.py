import itertools
import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.base.errors import TeamError
from lidarena.planning.team.grid_graph import grid_graph_of
from lidarena.planning.team.lifelong import LifelongPlan, plan_lifelong
from lidarena.world.grid_mazes import draw_grid_maze
from tests.planning.team.problems import meet, problems

SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]


def work(blocked: np.ndarray, robots: int, steps: int, seed: int = 0, **options) -> tuple[LifelongPlan, list]:
    """A team that goes on to random cells, and the goals in the order in which they were given."""
    rng = np.random.default_rng(seed)
    free = np.argwhere(~blocked)
    given: list[list[tuple[int, int]]] = [[] for _ in range(robots)]

    def next_goal(robot: int, cell: np.ndarray) -> tuple[int, int]:
        given[robot].append(tuple(free[rng.integers(len(free))].tolist()))
        return given[robot][-1]

    starts = free[rng.permutation(len(free))[:robots]]
    return plan_lifelong(blocked, starts, next_goal, steps, seed=seed, **options), given


@settings(max_examples=15, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4), radii=st.sampled_from([0.0, 0.5])), st.integers(0, 99))
def test_robots_never_collide_and_keep_to_the_grid(problem, seed) -> None:
    rng = np.random.default_rng(seed)
    goals = problem.goals

    def next_goal(robot: int, cell: np.ndarray) -> np.ndarray:
        return goals[robot] if (cell != goals[robot]).any() else problem.starts[robot]

    found = plan_lifelong(
        problem.grid, problem.starts, next_goal, 12,
        connectivity=problem.connectivity, radius=problem.radius, repairs=20, horizon=5, seed=int(rng.integers(99)),
    )  # fmt: skip
    assert not problem.grid[found.cells[..., 0], found.cells[..., 1]].any()
    jumps = np.abs(np.diff(found.cells, axis=0))
    assert (jumps.max(initial=0) <= 1) and (problem.connectivity == 8 or jumps.sum(axis=2).max(initial=0) <= 1)
    for here, there in itertools.pairwise(found.cells):
        for i, j in itertools.combinations(range(len(here)), 2):
            assert not meet(here[i], here[j], there[i], there[j], 2 * problem.radius)


def test_goals_are_reached_one_after_the_other_and_counted() -> None:
    found, given = work(np.zeros((6, 6), bool), 5, 60)
    for robot, goals in enumerate(given):
        times = np.flatnonzero(found.reached[:, robot])
        assert len(goals) == len(times) + 1
        for t, goal in zip(times, goals, strict=False):
            assert tuple(found.cells[t, robot].tolist()) == goal
    assert found.throughput == found.reached.sum() / 60 > 0.5


def test_a_lone_robot_loses_no_time() -> None:
    found, given = work(np.zeros((9, 9), bool), 1, 50)
    times = np.flatnonzero(found.reached[:, 0])
    ways = np.diff(np.array([found.cells[0, 0], *given[0][: len(times)]]), axis=0)
    assert np.diff([0, *times]).tolist() == np.maximum(np.abs(ways).sum(axis=1), 1).tolist()


def test_a_crowd_in_a_maze_keeps_moving() -> None:
    blocked = draw_grid_maze(np.random.default_rng(1))
    found, given = work(blocked, 64, 150)
    graph = grid_graph_of(blocked, 4, 0.0)
    alone = [
        graph.ahead(graph.place(np.array(goals[0])))[graph.place(cell)] // 4096
        for cell, goals in zip(found.cells[0], given, strict=True)
    ]
    in_time = np.count_nonzero(np.array(alone) <= 150)  # with nobody in the way: 49 of 64, so all 64 cannot
    assert found.reached.any(axis=0).sum() >= 0.9 * in_time > 40
    assert found.reached[100:].sum() >= 10  # it has not come to a stand
    again, _ = work(blocked, 64, 20)
    assert np.array_equal(again.cells, found.cells[:21])  # the same, whatever is still to come


@pytest.mark.parametrize(
    ("blocked", "goal", "options", "words"),
    [
        (np.array([[False, True]]), (0, 0), {}, "goals to go on to"),
        (np.zeros((2, 2), bool), (0, 2), {}, "goal of robot 0"),
        (np.array([[False, True, False]]), (0, 2), {}, "cannot reach"),
        (np.zeros((2, 2), bool), (0, 1), {"steps": 0}, "steps = 0"),
        (np.zeros((2, 2), bool), (0, 1), {"futures": -1}, "futures = -1"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(blocked, goal, options, words) -> None:
    with pytest.raises(TeamError, match=re.escape(words)):
        plan_lifelong(blocked, [(0, 0)], lambda robot, cell: goal, **({"steps": 5} | options))
