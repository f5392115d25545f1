from dataclasses import replace

import numpy as np
import pytest

from lidarena.planning import TeamPlan, plan_team, validate_plan

GRID = np.zeros((3, 6), bool)
GRID[1, 2] = True
STARTS, GOALS = [(0, 0), (2, 0)], [(0, 5), (2, 5)]


@pytest.fixture
def good() -> TeamPlan:
    return plan_team(GRID, STARTS, GOALS, "cbs")


def with_path(plan, robot, cells):
    paths = list(plan.paths)
    paths[robot] = np.array(cells)
    return replace(plan, paths=paths)


def test_a_good_plan_has_no_faults(good):
    assert validate_plan(good, GRID, STARTS, GOALS) == []


@pytest.mark.parametrize(
    ("cells", "says"),
    [
        ([(2, 0), (2, 1), (2, 2), (2, 3), (2, 4)], "does not go from its start to its goal"),
        ([(2, 0), (2, 2), (2, 3), (2, 4), (2, 5)], "jumps from (2, 0) to (2, 2) in step 0"),
        ([(2, 0), (2, 1), (1, 2), (2, 3), (2, 4), (2, 5)], "touches a wall at (1, 2)"),
        ([(2, 0), (1, 1), (2, 2), (2, 3), (2, 4), (2, 5)], "cuts a corner from (1, 1) to (2, 2)"),
        ([(2, 0), (1, 1), (0, 2), (1, 3), (2, 4), (2, 5)], "robots 0 and 1 collide"),
    ],
)
def test_faults_of_a_path_are_found(good, cells, says):
    assert any(says in fault for fault in validate_plan(with_path(good, 1, cells), GRID, STARTS, GOALS))


def test_a_swap_and_a_crossing_are_collisions():
    grid = np.zeros((2, 2), bool)
    swap = TeamPlan(True, [np.array([(0, 0), (0, 1)]), np.array([(0, 1), (0, 0)])], 2, 2, True, "")
    assert validate_plan(swap, grid, [(0, 0), (0, 1)], [(0, 1), (0, 0)], 4) == ["robots 0 and 1 collide in step 0"]
    cross = TeamPlan(True, [np.array([(0, 0), (1, 1)]), np.array([(0, 1), (1, 0)])], 2, 2, True, "")
    assert validate_plan(cross, grid, [(0, 0), (0, 1)], [(1, 1), (1, 0)]) == ["robots 0 and 1 collide in step 0"]
    assert any("jumps" in fault for fault in validate_plan(cross, grid, [(0, 0), (0, 1)], [(1, 1), (1, 0)], 4))


def test_a_robot_that_follows_another_does_not_collide_as_a_point_but_as_a_disc():
    grid = np.zeros((3, 6), bool)
    paths = [np.array([(1, 2), (1, 3), (1, 4)]), np.array([(1, 1), (1, 2), (1, 3)])]
    plan = TeamPlan(True, paths, 4, 4, True, "")
    ends = [path[0] for path in paths], [path[-1] for path in paths]
    assert validate_plan(plan, grid, *ends) == []
    assert "robots 0 and 1 collide in step 0" in validate_plan(plan, grid, *ends, radius=0.6)


def test_a_robot_that_drives_through_one_at_its_goal_collides(good):
    grid = np.zeros((1, 6), bool)
    paths = [np.array([(0, 2)]), np.array([(0, 0), (0, 1), (0, 2), (0, 3)])]
    plan = TeamPlan(True, paths, 3, 3, True, "")
    assert validate_plan(plan, grid, [(0, 2), (0, 0)], [(0, 2), (0, 3)]) == [
        "robots 0 and 1 collide in step 1",
        "robots 0 and 1 collide in step 2",
    ]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"solved": False}, "not solved"),
        ({"cost": 3.0}, "the cost is said to be 3.0"),
        ({"lower_bound": 99.0}, "is above the cost"),
        ({"optimal": False}, "optimal is False"),
        ({"paths": []}, "0 paths for 2 robots"),
    ],
)
def test_wrong_claims_are_found(good, change, says):
    assert any(says in fault for fault in validate_plan(replace(good, **change), GRID, STARTS, GOALS))


def test_a_disc_that_touches_a_wall_or_the_border_is_found():
    plan = TeamPlan(True, [np.array([(1, 1)])], 0, 0, True, "")
    assert validate_plan(plan, np.zeros((3, 3), bool), [(1, 1)], [(1, 1)], radius=1.5) == []
    assert validate_plan(plan, np.zeros((3, 3), bool), [(1, 1)], [(1, 1)], radius=1.6)
