"""The walk down the potential, traps and fills included, against the same walk in plain Python."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import normal, seed_stream
from lidarena.planning.potential_field.field_parameters import FieldParameters, field_parameters
from lidarena.planning.potential_field.field_scene import make_scene
from lidarena.planning.potential_field.guided_field import _limited, _spaced, plan_guided_path
from lidarena.planning.potential_field.potential_field import PotentialField, plan_path
from tests.planning.potential_field.circle_scenes import GOAL, clearance, length, scattered, trap
from tests.planning.potential_field.test_field_descent import run

CIRCLES = trap(200, 15, 0.8)


def is_trapped(path: list[np.ndarray], since: int, p: FieldParameters) -> bool:
    """Fig. 6: X_k = X_{k-2}; or for a window, nearer than γ/2, or less than 5 γ in 20 steps."""
    k = len(path) - 1
    windowed = p.trap_test == "window"
    if k >= 2 and k > since:
        net = math.dist(path[k], path[k - 2])
        if net == 0.0 or (windowed and net < 0.5 * p.gamma):
            return True
    return windowed and k >= since + 20 and math.dist(path[k], path[k - 20]) < 5.0 * p.gamma


def slow_walk(start: tuple[float, float], p: FieldParameters) -> tuple[np.ndarray, np.ndarray]:
    """Steps (n, 2) and fills (f, 3)."""
    scene, noise = make_scene(CIRCLES, start, GOAL), seed_stream(np.random.default_rng(p.seed))
    path, fills, since = [np.array(start)], np.empty((0, 3)), 0
    window = 20 if p.trap_test == "window" else 2
    while len(path) <= p.max_steps and math.dist(path[-1], GOAL) > p.arrival_radius:
        if is_trapped(path, since, p):
            cycle = np.array(path[-window:])
            place = cycle.sum(axis=0) / len(cycle) + p.gamma * np.array([normal(noise), normal(noise)])
            fills = np.vstack([fills, [*place, p.fill_strength()]])
            since = len(path) - 1 + (20 if p.trap_test == "window" else 0)
        fx, fy = PotentialField(scene, p, fills).force(path[-1])
        theta = math.atan2(fy, fx)
        path.append(path[-1] + p.gamma * np.array([math.cos(theta), math.sin(theta)]))
    return np.array(path), fills


@pytest.mark.parametrize("shape", ["reciprocal", "shifted", "bump"])
@pytest.mark.parametrize("seed", [0, 1])
def test_traps_are_found_and_filled_as_in_fig_6(shape: str, seed: int) -> None:
    options = dict(trap_test="window", fill_shape=shape, max_steps=150, seed=seed)
    start = (13.0, 12.0)
    path, fills, _ = run(CIRCLES, start, GOAL, **options)
    expected, expected_fills = slow_walk(start, field_parameters("paper", **options))
    assert len(fills) >= 1
    first = 40  # what two compilers round apart grows beyond it
    np.testing.assert_allclose(path[:first], expected[:first], atol=1e-6)
    np.testing.assert_allclose(fills[0], expected_fills[0], atol=1e-4)


def test_without_a_trap_the_noise_is_never_drawn() -> None:
    free = [(30.0, 60.0, 2.0)]
    walks = [run(free, (1.0, 1.0), GOAL, trap_test="window", seed=seed)[0] for seed in (0, 5)]
    np.testing.assert_array_equal(*walks)


FILL = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.1, 5.0))


@settings(max_examples=40, deadline=None)
@given(FILL, st.sampled_from(["shifted", "bump"]), st.floats(0.0, 2 * math.pi), st.booleans())
def test_a_fill_is_a_hill_that_falls_in_every_direction(
    fill: tuple[float, float, float], shape: str, angle: float, fades: bool
) -> None:
    p = field_parameters("paper", fill_shape=shape, fill_fades=fades)
    scene = make_scene([], (-50.0, -50.0), (60.0, 60.0))
    away = np.linspace(0.05, p.rho_1 - 0.01, 60)
    ray = np.array(fill[:2]) + away[:, None] * (math.cos(angle), math.sin(angle))
    filled, empty = (PotentialField(scene, p, np.array(f).reshape(-1, 3)) for f in ([fill], []))
    height = filled.potential(ray) - empty.potential(ray)
    assert (height > 0).all() and (np.diff(height) < 0).all()
    pushed = filled.force(ray) - empty.force(ray)
    assert (pushed @ (math.cos(angle), math.sin(angle)) > 0).all()


@settings(max_examples=40, deadline=None)
@given(st.lists(FILL, max_size=4), st.floats(-2.5, 2.5), st.floats(-2.5, 2.5))
def test_fills_add_up(fills: list[tuple[float, float, float]], x: float, y: float) -> None:
    p, scene = field_parameters("robust", fill_fades=False, fit_scale=False), make_scene([], (-50, -50), (60, 60))

    def potential(some: list[tuple[float, float, float]]) -> float:
        return float(PotentialField(scene, p, np.array(some, float).reshape(-1, 3)).potential((x, y)))

    alone = [potential([fill]) - potential([]) for fill in fills]
    assert potential(fills) - potential([]) == pytest.approx(sum(alone), abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(0.01, 1.0))
def test_a_heading_turns_the_short_way_and_not_too_far(heading: float, wanted: float, most: float) -> None:
    turned = _limited(heading, wanted, most)
    gap = math.remainder(wanted - heading, 2 * math.pi)
    assert abs(turned - heading) <= most + 1e-12
    if abs(gap) <= most:
        assert math.remainder(turned - wanted, 2 * math.pi) == pytest.approx(0.0, abs=1e-9)
    elif abs(abs(gap) - math.pi) > 1e-9:
        assert turned - heading == pytest.approx(math.copysign(most, gap))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.05, 2.0))
def test_a_spaced_path_is_the_same_line_in_small_steps(seed: int, spacing: float) -> None:
    corners = np.random.default_rng(seed).uniform(0, 10, (5, 2))
    points = _spaced(corners, spacing)
    assert length(points) == pytest.approx(length(corners))
    assert np.hypot(*np.diff(points, axis=0).T).max() <= spacing + 1e-9
    for corner in corners:
        assert np.hypot(*(points - corner).T).min() < 1e-9


@settings(max_examples=8, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.5, 1.5]))
def test_both_planners_keep_out_of_every_circle_and_end_on_the_goal(seed: int, robot: float) -> None:
    circles, start, goal = scattered(np.random.default_rng(seed), 12)
    for planner in (plan_path, plan_guided_path):
        result = planner(circles, start, goal, robot_radius=robot, bounds=(0, 0, 100, 100))
        assert not result.collided
        if result.success:
            for path in (result.path, result.smoothed):
                assert clearance(path, circles, robot, (0, 0, 100, 100), 0.05) > -1e-9
                assert path[0].tolist() == start.tolist() and path[-1].tolist() == goal.tolist()
            assert length(result.smoothed) <= length(result.path) + 1e-9
