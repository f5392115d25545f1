"""Clearances follow the gaps between obstacles, not the extent of the scene."""

import math

import numpy as np
import pytest

from lidarena.planning.potential_field.clearance_order import clearance_shares
from lidarena.planning.potential_field.field_scene import make_scene
from lidarena.planning.potential_field.gap_graph import GapGraph
from lidarena.planning.potential_field.guided_field import plan_guided_path
from lidarena.planning.potential_field.potential_field import PotentialField, plan_path
from lidarena.world.arenas import load_arena
from tests.planning.potential_field.circle_scenes import clearance, length

PLANNERS = [plan_path, plan_guided_path]


def posts(count: int, apart: float) -> np.ndarray:
    x, y = np.meshgrid(apart * np.arange(count), apart * np.arange(count))
    return np.column_stack([x.ravel(), y.ravel(), np.full(count * count, 0.5)])


def door(width: float, room: float) -> np.ndarray:
    """A wall of posts across a room, with a door in its middle."""
    below = np.append(np.arange(0.0, 0.5 * (room - width) - 0.05, 0.05), 0.5 * (room - width) - 0.05)
    y = np.concatenate([below, room - below])
    return np.column_stack([np.full(len(y), 0.5 * room), y, np.full(len(y), 0.05)])


@pytest.mark.parametrize("radius", [0.0, 0.5])
@pytest.mark.parametrize("planner", PLANNERS)
def test_2500_posts_are_crossed_and_not_gone_around(planner, radius):
    start, goal = (-60.0, 487.0), (1040.0, 497.0)
    result = planner(posts(50, 20.0), start, goal, robot_radius=radius)
    assert result.success and length(result.smoothed) < 1.01 * math.dist(start, goal)
    near = [post for post in posts(50, 20.0) if abs(post[1] - 490.0) < 100.0]
    assert clearance(result.smoothed, near, radius, spacing=0.5) > 5.0


@pytest.mark.parametrize("room", [10.0, 30.0, 100.0])
@pytest.mark.parametrize("planner", PLANNERS)
def test_a_door_5_cm_wider_than_the_robot_is_passed_in_any_room(planner, room):
    start, goal, bounds = (0.15 * room, 0.3 * room), (0.85 * room, 0.6 * room), (0, 0, room, room)
    result = planner(door(1.05, room), start, goal, robot_radius=0.5, bounds=bounds)
    assert result.success and length(result.smoothed) < 1.02 * math.dist(start, goal)
    assert clearance(result.path, door(1.05, room), 0.5, bounds, spacing=0.003) > 0.0


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_door_that_is_too_narrow_is_refused_with_the_clearances_that_were_tried(planner):
    result = planner(door(0.95, 10.0), (1.5, 3.0), (8.5, 6.0), robot_radius=0.5, bounds=(0, 0, 10, 10), max_steps=500)
    assert not result.success and "\n" not in result.message
    assert "clearances of 0.15, 0.075, 0.0375, 0.0188, 0.00938, 0.00469 m beside the robot" in result.message


@pytest.mark.parametrize("planner", PLANNERS)
def test_no_step_at_a_side_of_316_m(planner):
    rng = np.random.default_rng(3)
    circles = np.column_stack([rng.uniform(20, 290, (150, 2)), np.full(150, 2.0)])
    start, goal = (5.0, 150.0), (300.0, 160.0)
    free = [np.hypot(*(circles[:, :2] - end).T) > 8.0 for end in (start, goal)]
    circles = circles[free[0] & free[1]]
    found = [planner(circles, start, goal, robot_radius=1.0, bounds=(0, 0, side, side)) for side in (316.0, 317.0)]
    assert [result.success for result in found] == [True, True]
    lengths = [length(result.smoothed) for result in found]
    assert lengths[1] == pytest.approx(lengths[0], rel=0.005) and max(lengths) < 1.05 * math.dist(start, goal)
    assert found[1].parameters.gamma == pytest.approx(found[0].parameters.gamma, rel=0.01)


@pytest.mark.parametrize("name", ["yang", "yang:arc", "yang:u", "u_trap:3"])
def test_the_papers_scenes_are_planned_with_its_lengths(name):
    arena = load_arena(name)
    result = plan_path(arena.circles, arena.start, arena.goal, "robust", arena.robot_radius, arena.bounds)
    field = PotentialField.of(arena.circles, arena.start, arena.goal, "robust", arena.robot_radius, arena.bounds)
    for parameters in (result.parameters, field.parameters):
        assert (parameters.h_0, parameters.rho_0, parameters.gamma) == (1.5, 8.0, 0.1)


def test_one_attempt_is_made_with_what_was_asked_for():
    assert clearance_shares(make_scene(door(1.05, 10.0), (1, 3), (9, 6), 0.5), 1.5, 1) == [1.0]


def test_clearances_begin_at_the_best_and_go_on_to_either_side_of_it():
    scene = make_scene(door(1.4, 10.0), (1.5, 3.0), (8.5, 6.0), 0.5, (0, 0, 10, 10))
    assert clearance_shares(scene, 0.6, 6) == [0.25, 0.125, 0.5, 0.0625, 1.0, 0.03125]
    assert clearance_shares(scene, 0.15, 3) == [1.0, 0.5, 0.25]


def test_where_no_gap_lets_through_all_clearances_are_tried():
    scene = make_scene(door(0.9, 10.0), (1.5, 3.0), (8.5, 6.0), 0.5, (0, 0, 10, 10))
    assert GapGraph(scene).way_length(0.0) == math.inf
    assert clearance_shares(scene, 0.15, 4) == [1.0, 0.5, 0.25, 0.125]
