import itertools
import math
import time

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lidarena.base.errors import TeamError
from lidarena.planning import plan_team, validate_plan
from lidarena.planning.team.budget import Budget
from lidarena.planning.team.plan import _load_kernels
from tests.planning.team.problems import Problem, brute_force, faults, parse, plan, problems

METHODS = ["prioritized_astar", "coordination", "prioritized_search", "cbs"]
QUICK = {"time_limit": math.inf, "iterations": 30}
SLOW = [HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large]
PASSING = """
    @@@.@@@@
    aB....bA
"""


@settings(max_examples=80, deadline=None, suppress_health_check=SLOW)
@given(problems(), st.sampled_from(METHODS))
def test_a_plan_never_collides_and_costs_at_least_the_bound(problem, method):
    found = plan(problem, method, **QUICK)
    if found.solved:
        assert faults(problem, found) == []
        assert found.cost >= found.lower_bound
    else:
        assert "obot" in found.message or "nodes" in found.message
        assert not found.optimal


@pytest.mark.parametrize("method", ["prioritized_search", "joint_astar", "cbs"])
def test_two_robots_pass_each_other_at_a_doorway(method):
    problem = parse(PASSING, 4)
    found = plan(problem, method)
    assert found.solved and faults(problem, found) == []
    assert found.cost == brute_force(problem)


def test_robots_that_keep_to_their_paths_cannot_pass_each_other():
    found = plan(parse(PASSING, 4), "coordination")
    assert not found.solved and found.cost == math.inf and "own path" in found.message
    assert [len(path) > 0 for path in found.paths].count(False) == 1


def test_the_one_that_fails_moves_to_the_front():
    """Robot b is in a dead end that a, whose way is longer, wants to enter (Bennewitz and Burgard, Fig. 17)."""
    problem = parse(
        """
        B..@@@@@@@@
        .a....b...A
        ...@@@@@@@@
        """,
        4,
    )
    given_order = plan(problem, "prioritized_astar")
    assert not given_order.solved and "Robot 1 (priority 2 of 2" in given_order.message
    found = plan(problem, "prioritized_search")
    assert found.order == (1, 0) and faults(problem, found) == []


def test_where_no_order_helps_robots_wait_before_they_leave():
    """Both are equally near to the only place to dodge, so that whoever goes first never lets the other one in."""
    grid = np.array([[c == "@" for c in row] for row in ("@@@@.@@@@", ".........")])
    ends = np.array([(1, 0), (1, 8)])
    problem = Problem(grid, ends, ends[::-1], 4)
    assert not plan(problem, "prioritized_astar").solved
    found = plan(problem, "prioritized_search", time_limit=20.0, iterations=300)
    assert found.solved and faults(problem, found) == []


def test_a_problem_without_a_plan_is_reported_with_the_robot():
    problem = Problem(np.zeros((1, 5), bool), np.array([(0, 0), (0, 4)]), np.array([(0, 4), (0, 0)]))
    for method in ("prioritized_astar", "prioritized_search", "coordination", "cbs"):
        found = plan(problem, method, time_limit=0.2, iterations=40)
        assert not found.solved and "obot" in found.message and found.cost == math.inf
    assert "no plan for robots 0 and 1" in plan(problem, "joint_astar").message


def test_independent_paths_are_returned_with_their_first_conflict():
    problem = Problem(np.zeros((1, 5), bool), np.array([(0, 0), (0, 4)]), np.array([(0, 3), (0, 1)]))
    found = plan(problem, "independent_astar")
    assert not found.solved and found.cost == 6 and [len(path) for path in found.paths] == [4, 4]
    assert "first robots 0 and 1 in step 1" in found.message


@pytest.mark.parametrize("method", ["prioritized_search", "cbs"])
def test_same_input_same_plan(method):
    rng = np.random.default_rng(5)
    grid = rng.random((16, 16)) < 0.15
    free = np.argwhere(~grid)
    grid[:] = False
    ends = rng.permutation(free)[:16]
    runs = [plan_team(grid, ends[:8], ends[8:], method, time_limit=math.inf, iterations=60, seed=3) for _ in range(3)]
    for one, other in itertools.pairwise(runs):
        assert one.cost == other.cost and one.message == other.message
        assert all(np.array_equal(a, b) for a, b in zip(one.paths, other.paths, strict=True))


def test_paths_run_straight_where_they_can():
    found = plan_team(np.zeros((9, 12), bool), [(4, 0)], [(4, 11)], "independent_astar")
    assert (found.paths[0][:, 0] == 4).all() and found.optimal


def test_discs_keep_their_distance_also_between_cells():
    """Two robots cross: their cells are never equal, but half-way between two times they are closest."""
    grid = np.zeros((9, 9), bool)
    starts, goals = [(4, 1), (1, 4)], [(4, 7), (7, 4)]
    found = plan_team(grid, starts, goals, "cbs", radius=0.9)
    fine = [np.stack([np.interp(np.arange(0, 12, 0.05), range(len(p)), p[:, k]) for k in (0, 1)]) for p in found.paths]
    assert np.hypot(*(fine[0] - fine[1])).min() >= 1.8 - 1e-6


def test_a_radius_keeps_off_the_walls():
    grid = np.zeros((7, 7), bool)
    grid[3, 3] = True
    found = plan_team(grid, [(1, 3)], [(5, 3)], "independent_astar", radius=1.0)
    away = np.abs(found.paths[0] - 3) - 0.5
    assert np.hypot(*np.maximum(away, 0).T).min() >= 1.0


def test_cell_costs_keep_a_robot_in_the_middle():
    grid, costs = np.zeros((5, 9), bool), np.zeros((5, 9))
    costs[2, 2:7] = 4.0
    found = plan_team(grid, [(2, 0)], [(2, 8)], "prioritized_astar", cell_costs=costs)
    assert not (found.paths[0][2:-2, 0] == 2).any()
    assert found.cost == len(found.paths[0]) - 1 >= found.lower_bound == 8


def test_deviation_costs_keep_robots_further_apart_than_they_must():
    grid = np.zeros((15, 20), bool)
    starts, goals = [(7, 0), (7, 18)], [(7, 19), (7, 2)]
    gaps = []
    for deviation in (None, [(0.0, 3.0), (5.0, 0.0)]):
        found = plan_team(grid, starts, goals, "prioritized_astar", deviation=deviation)
        steps = min(len(path) for path in found.paths)
        gaps.append(np.hypot(*(found.paths[0][:steps] - found.paths[1][:steps]).T).min())
        assert validate_plan(found, grid, starts, goals) == []
    assert gaps[1] > gaps[0]


@settings(max_examples=30, deadline=None, suppress_health_check=SLOW)
@given(problems(robots=st.integers(2, 4)))
def test_plans_with_costs_by_place_and_time_never_collide_either(problem):
    costs = np.arange(problem.grid.size).reshape(problem.grid.shape) % 3
    for options in ({"cell_costs": costs}, {"deviation": [(0.0, 1.0), (3.0, 0.0)]}):
        found = plan(problem, "prioritized_astar", **options)
        assert not found.solved or faults(problem, found) == []


OPEN = np.zeros((4, 6), bool)
WALLED = OPEN.copy()
WALLED[:, 3] = True
DOOR = np.zeros((7, 9), bool)
DOOR[:, 4] = True
DOOR[3, 4] = False


@pytest.mark.parametrize(
    ("grid", "starts", "goals", "options", "says"),
    [
        (WALLED, [(0, 0)], [(1, 3)], {}, r"the goal of robot 0 at \(1, 3\) is in a wall"),
        (WALLED, [(2, 3)], [(1, 1)], {}, r"the start of robot 0 at \(2, 3\) is in a wall"),
        (OPEN, [(0, 0), (1, 1)], [(2, 2), (2, 2)], {}, r"robots 0 and 1 share the goal \(2, 2\)"),
        (OPEN, [(1, 1), (1, 1)], [(2, 2), (0, 2)], {}, r"share the start \(1, 1\)"),
        (OPEN, [(1, 1), (1, 2)], [(2, 4), (2, 1)], {"radius": 1.0}, r"starts of robots 0 and 1 overlap: they are 1.00"),
        (OPEN, [(0, 1)], [(2, 4)], {"radius": 1.0}, "nearer to a wall than its radius of 1.0"),
        (WALLED, [(0, 0)], [(0, 5)], {}, r"robot 0 cannot reach its goal \(0, 5\) .* no free cells connect them"),
        (DOOR, [(3, 1)], [(3, 7)], {"radius": 1.0}, "it is wider than every door"),
        (OPEN, [(0, 0), (1, 1), (2, 2)], [(0, 1), (0, 2)], {}, "there are 3 starts for 2 goals"),
        (OPEN, [(0, 0)], [(4, 0)], {}, r"the goal of robot 0 at \(4, 0\) lies outside"),
        (OPEN, [(-1, 0)], [(1, 0)], {}, "lies outside"),
        (OPEN, [(0.5, 0)], [(1, 0)], {}, "whole numbers"),
        (OPEN, [], [], {}, "whole numbers"),
        (OPEN, (0, 0), (1, 1), {}, "whole numbers"),
        (np.zeros(4, bool), [(0, 0)], [(0, 1)], {}, r"shape \(4,\)"),
        (np.full((3, 3), 2), [(0, 0)], [(0, 1)], {}, "True for blocked"),
        (OPEN, [(0, 0)], [(1, 1)], {"method": "prioritised_astar"}, "did you mean 'prioritized_astar'"),
        (OPEN, [(0, 0)], [(1, 1)], {"method": "joint_astar"}, "plans 2 robots, not 1"),
        (OPEN, [(0, 0)], [(1, 1)], {"connectivity": 6}, "4 or 8"),
        (OPEN, [(0, 0)], [(1, 1)], {"radius": math.nan}, "radius of nan"),
        (OPEN, [(0, 0)], [(1, 1)], {"time_limit": 0.0}, "positive"),
        (OPEN, [(0, 0)], [(1, 1)], {"time_limit": math.nan}, "time limit of nan"),
        (OPEN, [(0, 0)], [(1, 1)], {"time_limit": None}, "time limit of None"),
        (OPEN, [(0, 0)], [(1, 1)], {"radius": "1"}, "radius of '1'"),
        (OPEN, [(0, 0)], [(1, 1)], {"connectivity": np.array([4, 8])}, "4 or 8"),
        (OPEN, [(0, 0)], [(1, 1)], {"iterations": 1.5}, "iterations of 1.5 is not possible"),
        (OPEN, [(0, 0)], [(1, 1)], {"seed": -1}, "a seed of -1 is not possible"),
        ([[0, 1], [0]], [(0, 0)], [(1, 0)], {}, "rows of different lengths were given as the grid"),
        (OPEN, [(0, 0), (1,)], [(1, 0), (1, 1)], {}, "rows of different lengths were given as the starts"),
        (OPEN, np.empty((0, 2), int), np.empty((0, 2), int), {}, "at least one robot"),
        (OPEN, [(0, 0)], [(1, 1)], {"iterations": -1}, "0 or more"),
        (OPEN, [(0, 0)], [(1, 1)], {"cell_costs": np.zeros((2, 2))}, "cell_costs have shape"),
        (OPEN, [(0, 0)], [(1, 1)], {"cell_costs": np.full((4, 6), -1.0)}, "0 to 64"),
        (OPEN, [(0, 0)], [(1, 1)], {"cell_costs": np.zeros((4, 6)), "method": "cbs"}, "takes no cell_costs"),
        (OPEN, [(0, 0)], [(1, 1)], {"deviation": [(0, 1), (2, 0)], "method": "cbs"}, "takes no deviation"),
        (OPEN, [(0, 0)], [(1, 1)], {"deviation": [(1, 1), (0, 0)], "method": "prioritized_astar"}, "rise from 0"),
        (OPEN, [(0, 0)], [(1, 1)], {"deviation": [1, 2], "method": "prioritized_astar"}, "at least two rows"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(grid, starts, goals, options, says):
    with pytest.raises(TeamError, match=says) as caught:
        plan_team(grid, starts, goals, **options)
    assert "\n" not in str(caught.value)


def test_a_radius_larger_than_the_grid_is_refused_at_once():
    begun = time.perf_counter()
    with pytest.raises(TeamError, match="nearer to a wall than its radius of 99"):
        plan_team(OPEN, [(0, 0)], [(1, 1)], radius=99)
    assert time.perf_counter() - begun < 20.0  # it took more than a minute


@pytest.mark.parametrize("method", METHODS)
def test_loading_kernels_is_not_taken_from_the_time_limit(method, monkeypatch):
    limits = []

    class Noted(Budget):
        def __init__(self, seconds, iterations=None):
            limits.append(seconds)
            super().__init__(seconds, iterations)

    monkeypatch.setattr("lidarena.planning.team.plan.Budget", Noted)
    _load_kernels.cache_clear()
    for _ in range(2):
        plan_team(OPEN, [(0, 0)], [(1, 1)], method, time_limit=5.0)
    assert limits[-2:] == [5.0, 5.0] and set(limits[:-2]) == {math.inf}
