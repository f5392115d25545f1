import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from lidarena.planning.potential_field.potential_field import PotentialField
from tests.planning.potential_field.circle_scenes import GOAL, PRINTED

FIG2 = dict(circles=[[0.5, 0, 0]], start=(-4, 0), goal=(0, 0))
FIG4 = np.array([(29, 45, 0), (40, 45, 0), (65, 45, 0), (74, 74, 0)], dtype=float)


def slow_potential(point, circles, walls, goal, p, fills=()):
    """Eqs. 1, 3, 5, 7, 8 and 15, each written out."""
    rho_g = math.dist(point, goal)
    if not p.bounded_attraction or rho_g <= p.d_0:
        total = 0.5 * p.k * rho_g**2
    else:
        total = p.k * p.d_0 * rho_g - 0.5 * p.k * p.d_0**2
    gaps = [math.dist(point, (x, y)) - radius for x, y, radius in circles]
    gaps += [point[0] - walls[0], point[1] - walls[1], walls[2] - point[0], walls[3] - point[1]]
    for rho_o in gaps:
        if rho_o <= 0:
            return math.inf
        if rho_o <= p.rho_0:
            repulsion = 0.5 * p.repulsion_gain() * (1 / rho_o - 1 / p.rho_0) ** 2
            if p.goal_aware:
                repulsion *= min(rho_g / p.rho_0, 1) ** p.n if p.saturate else rho_g**p.n
            total += repulsion
    for x, y, s in fills:
        rho = math.dist(point, (x, y))
        if p.fill_shape in ("bump", "none"):
            added = s * math.exp(-0.5 * (3 * rho / p.rho_1) ** 2)
        else:
            shift = 1 / p.rho_1**2 if p.fill_shape == "shifted" else 0
            added = s * (1 / rho**2 - shift) if rho <= p.rho_1 else 0
        total += added * (min(rho_g / p.rho_1, 1) ** 2 if p.fill_fades else 1)
    return total


VARIANTS = [
    ("traditional", {}),
    ("paper", {}),
    ("paper", {"n": 3.0, "fill_shape": "shifted"}),
    ("robust", {}),
    ("robust", {"saturate": False, "fill_shape": "reciprocal", "eta": 2.0}),
    ("robust", {"bounded_attraction": False, "fill_fades": False}),
    ("robust", {"goal_aware": False}),
]


def field_of(preset, overrides, fills=((20.0, 30.0, 7.0), (68.0, 66.0, 3.0))):
    circles = np.vstack([PRINTED, [(30, 20, 4.0), (50, 60, 2.0)]])
    field = PotentialField.of(circles, (0.5, 0.5), GOAL, preset, 0.0, (-5, -5, 95, 95), **overrides)
    return PotentialField(field.scene, field.parameters, np.array(fills))


@pytest.mark.parametrize(("preset", "overrides"), VARIANTS)
def test_the_potential_is_the_papers(preset, overrides):
    field = field_of(preset, overrides)
    points = np.random.default_rng(0).uniform(-6, 96, (400, 2))
    scene, p = field.scene, field.parameters
    expected = [slow_potential(x, scene.discs, scene.walls, scene.goal, p, field.filled) for x in points]
    np.testing.assert_allclose(field.potential(points), expected, rtol=1e-7)
    assert np.isinf(field.potential([(30, 20), (-5.5, 3)])).all()


@pytest.mark.parametrize(("preset", "overrides"), VARIANTS)
def test_the_force_is_the_negative_gradient(preset, overrides):
    field = field_of(preset, overrides)
    points = np.random.default_rng(1).uniform(-4, 94, (600, 2))
    step = 1e-4
    smooth = np.isfinite(field.potential(points))
    for centre in (field.scene.goal, (20, 30), (68, 66)):
        away = np.hypot(*(points - centre).T)
        smooth &= (np.abs(away - 8.0) > 0.01) & (away > 0.3)  # at a rim the gradient may jump, or the value
    gaps = np.hypot(*(points[:, None] - field.scene.discs[:, :2]).T).T - field.scene.discs[:, 2]
    smooth &= gaps.min(axis=1) > 0.5
    points = points[smooth]
    assert len(points) > 300
    numeric = np.empty_like(points)
    for axis, shift in enumerate(np.eye(2) * step):
        steps = [-field.potential(points + c * shift) for c in (-2, -1, 1, 2)]
        numeric[:, axis] = (steps[0] - 8 * steps[1] + 8 * steps[2] - steps[3]) / (12 * step)
    force = field.force(points)
    scale = 1 + np.hypot(*force.T)[:, None] + np.abs(field.potential(points))[:, None] / 100
    assert np.abs((force - numeric) / scale).max() < 1e-6


def test_fig_2_the_traditional_walk_is_trapped_beside_the_goal():
    field = PotentialField.of(**FIG2, preset="traditional", rho_0=1.5)
    assert brentq(lambda x: field.force((x, 0.0))[0], -0.9, -0.1) == pytest.approx(-0.443, abs=0.002)
    assert field.force((0.0, 0.0))[0] < -1  # at the goal the obstacle still pushes


def test_fig_2_with_eq_8_the_goal_is_the_only_minimum():
    field = PotentialField.of(**FIG2, preset="paper", rho_0=1.5)
    x = np.linspace(-3, 0.45, 4001)
    force = field.force(np.column_stack([x, 0 * x]))[:, 0]
    assert (force[x < -1e-3] > 0).all() and (force[x > 1e-3] < 0).all()
    assert field.potential((0.0, 0.0)) == 0.0


@pytest.mark.parametrize("preset", ["paper", "robust"])
def test_fig_4_the_goal_is_the_global_minimum(preset):
    field = PotentialField.of(FIG4, (0, 0), GOAL, preset)
    side = np.arange(0.0, 100.01, 0.5)
    points = np.stack(np.meshgrid(side, side), axis=-1)
    potential = field.potential(points)
    best = np.unravel_index(np.argmin(potential), potential.shape)
    assert points[best].tolist() == list(GOAL) and potential[best] == 0.0


def test_fig_4_nothing_else_is_a_minimum():
    field = PotentialField.of(FIG4, (0, 0), GOAL, "paper")
    side = np.arange(0.0, 100.01, 0.5)
    potential = field.potential(np.stack(np.meshgrid(side, side), axis=-1))
    inner = potential[1:-1, 1:-1]
    lowest = np.ones(inner.shape, bool)
    for dr in (0, 1, 2):
        for dc in (0, 1, 2):
            if (dr, dc) != (1, 1):
                lowest &= inner < potential[dr : dr + inner.shape[0], dc : dc + inner.shape[1]]
    assert [(side[r + 1], side[c + 1]) for r, c in np.argwhere(lowest)] == [GOAL]


def test_eq_7_is_continuous_and_its_force_bounded():
    field = PotentialField.of(np.empty((0, 3)), (0, 0), GOAL, "paper")
    near, far = field.potential([(70 - 7.999999, 70), (70 - 8.000001, 70)])
    assert near == pytest.approx(far, abs=1e-4)
    force = np.hypot(*field.force(np.random.default_rng(0).uniform(-500, 500, (100, 2))).T)
    np.testing.assert_allclose(force, 8.0)


@settings(max_examples=100, deadline=None)
@given(st.floats(-20, 20), st.floats(-20, 20), st.floats(0.0, 2 * math.pi))
def test_turning_the_scene_turns_the_force(x, y, angle):
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    centres = np.array([(5.0, 1.0), (-3.0, 7.0)])
    plain = PotentialField.of(np.insert(centres, 2, 1.0, axis=1), (30, 30), (9, 9), eta=1.0, fit_scale=False)
    turned = PotentialField.of(
        np.insert(centres @ turn.T, 2, 1.0, axis=1), turn @ (30, 30), turn @ (9, 9), eta=1.0, fit_scale=False
    )
    force = plain.force((x, y))
    if np.hypot(*(centres - (x, y)).T).min() > 1.05:
        np.testing.assert_allclose(turned.force(turn @ (x, y)), turn @ force, atol=1e-6 * (1 + np.abs(force).max()))


def test_the_force_is_finite_everywhere_even_in_an_obstacle():
    field = field_of("robust", {})
    points = [(40, 45), (30, 20), (34, 20), GOAL, (-5, -5), (-7, 3), (20, 30)]
    assert np.isfinite(field.force(points)).all()


def test_the_potential_among_thousands_of_circles_costs_about_as_much_as_the_force():
    """A floor plan is so many circles, and nearly all of them are out of reach of any point."""
    angles = np.linspace(0.0, 40.0, 6000)
    circles = np.column_stack([50 + angles * np.cos(angles), 50 + angles * np.sin(angles), np.full(6000, 0.01)])
    field = PotentialField.of(circles, (0, 0), (99, 99), "paper", rho_0=0.5, d_0=0.5)
    points = np.random.default_rng(0).uniform(5.0, 95.0, (3000, 2))
    least = {}
    for name in ("potential", "force"):
        times = []
        for _ in range(4):
            begun = time.process_time()
            getattr(field, name)(points)
            times.append(time.process_time() - begun)
        least[name] = min(times)
    assert least["potential"] < 4.0 * least["force"], least  # it was ten times as much
