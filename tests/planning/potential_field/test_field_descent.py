import math

import numpy as np
import pytest

from lidarena.base.random_streams import seed_stream
from lidarena.planning.potential_field.field_descent import walk
from lidarena.planning.potential_field.field_parameters import field_parameters
from lidarena.planning.potential_field.field_scene import make_scene
from lidarena.planning.potential_field.potential_field import PotentialField, plan_path
from tests.planning.potential_field.circle_scenes import GOAL, ROOM, clearance, trap

ENDS = ("arrived", "out of steps", "trapped", "collided", "out of fills")


def run(circles, start, goal, preset="paper", **overrides):
    scene = make_scene(circles, start, goal)
    p = field_parameters(preset, **overrides)
    path, fills = np.empty((p.max_steps + 1, 2)), np.empty((p.max_fills, 3))
    path[0] = start
    kept = scene.keeping(p.h_0)
    noise = seed_stream(np.random.default_rng(p.seed))
    arguments = (path, scene.goal, scene.obstacles, kept, p.field(), p.motion(), fills)
    last, count, end = walk(*arguments, np.zeros(1, np.int64), noise)
    return path[: last + 1], fills[:count], ENDS[end]


def slow_walk(circles, start, goal, **overrides):
    """Eq. 14 without traps."""
    field = PotentialField.of(circles, start, goal, "paper", **overrides)
    here, path = np.array(start, float), [np.array(start, float)]
    while math.dist(here, goal) > field.parameters.arrival_radius and len(path) <= field.parameters.max_steps:
        fx, fy = field.force(here)
        theta = math.atan2(fy, fx)
        here = here + field.parameters.gamma * np.array([math.cos(theta), math.sin(theta)])
        path.append(here)
    return np.array(path)


def test_the_walk_follows_the_force_in_steps_of_gamma():
    circles = [(40, 45, 2.0), (20, 12, 3.0), (60, 66, 1.0)]
    path, fills, end = run(circles, (1.0, 2.0), GOAL, trap_test="none")
    np.testing.assert_allclose(path, slow_walk(circles, (1.0, 2.0), GOAL), atol=1e-6)
    np.testing.assert_allclose(np.hypot(*np.diff(path, axis=0).T), 0.1)
    assert end == "arrived" and not len(fills)


def test_without_filling_a_trap_ends_the_walk():
    path, _, end = run(trap(200, 15, 0.8), (0, 0), GOAL, "traditional")
    assert end == "trapped"
    assert math.dist(path[-1], (15, 15)) < 1.5  # the trap that Yang et al. describe


def test_a_fill_lies_in_the_trap_and_has_its_strength():
    _, fills, end = run(trap(200, 15, 0.8), (0, 0), GOAL, "robust", max_fills=1, ways=1)
    strength = field_parameters("robust").fill_strength()
    assert fills.shape == (1, 3) and fills[0, 2] == pytest.approx(strength)
    assert math.dist(fills[0, :2], (15, 15)) < 4
    assert end in ("arrived", "out of fills")


def test_a_window_rests_after_a_fill():
    path, fills, _ = run(trap(200, 15, 0.8), (0, 0), GOAL, trap_test="window", max_steps=3000, s=1e-9)
    assert 2 < len(fills) <= (len(path) - 1) / 20 + 1


def test_the_step_limit_ends_a_walk_in_a_cage():
    angles = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    cage = np.column_stack([10 * np.cos(angles), 10 * np.sin(angles), np.full(40, 1.0)])
    path, _, end = run(cage, (0, 0), GOAL, "robust", max_steps=500)
    assert end == "out of steps" and len(path) == 501
    path, fills, end = run(cage, (0, 0), GOAL, "robust", max_fills=3)
    assert end == "out of fills" and len(fills) == 3


def test_an_unguarded_step_may_touch_an_obstacle_a_guarded_one_never():
    circles = [(30.0, 30.0, 4.0)]
    options = dict(eta=1e-9, gamma=1.0, arrival_radius=0.5, trap_test="window", fill_shape="bump")
    path, _, end = run(circles, (0, 0.1), GOAL, **options)
    assert end == "collided" and math.dist(path[-2], (30, 30)) > 4
    path, _, end = run(circles, (0, 0.1), GOAL, **options, guard=True)
    assert end == "arrived" and clearance(path, circles) > 1.5 - 1e-9


def test_a_robot_that_is_boxed_in_stays():
    circles = [(math.cos(a), math.sin(a), 0.99) for a in np.linspace(0, 2 * np.pi, 12, endpoint=False)]
    result = plan_path(circles, (0, 0), (5, 5), guard=True, max_fills=2, attempts=1, fit_scale=False, ways=1)
    assert not result.success and not result.collided
    assert clearance(result.path, circles) > 0


def test_the_seed_decides_and_nothing_else():
    plans = [plan_path(trap(200, 15), (0, 0), GOAL, bounds=ROOM, seed=seed, ways=1) for seed in (0, 0, 1)]
    np.testing.assert_array_equal(plans[0].path, plans[1].path)
    assert plans[0].fills > 0 and not np.array_equal(plans[0].path, plans[2].path)
