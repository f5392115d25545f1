import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError, MapError
from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.planning.potential_field.guided_field import plan_guided_path
from lidarena.world.arenas import load_arena
from lidarena.world.barn import barn_indices
from tests.planning.potential_field.circle_scenes import clearance, length, scattered
from tests.planning.potential_field.test_potential_field import BARN, needs_barn


def check(arena):
    arguments = (arena.circles, arena.start, arena.goal, arena.robot_radius, arena.bounds)
    yardstick = astar_path(*arguments)
    result = plan_guided_path(*arguments)
    assert result.success or not len(yardstick), arena.name
    if result.success:
        for path in (result.path, result.smoothed):
            assert clearance(path, arena.circles, arena.robot_radius, arena.bounds, 0.05) > 0
        assert result.path[-1].tolist() == list(arena.goal)
    return result, yardstick


@pytest.mark.parametrize("density", [0.08, 0.15, 0.22])
def test_random_arenas(density):
    for seed in range(3):
        check(load_arena(f"random:{seed}", density=density))


def test_u_traps_are_no_traps_and_the_path_is_smooth():
    for seed in range(3):
        result, yardstick = check(load_arena(f"u_trap:{seed}"))
        assert length(result.path) < 1.05 * length(yardstick)
        headings = np.unwrap(np.arctan2(*np.diff(result.path, axis=0).T[::-1]))
        assert np.median(np.abs(np.diff(headings))) < 0.02
        assert np.abs(np.diff(headings)).sum() < 3 * np.pi  # no oscillation


@needs_barn
def test_barn_worlds():
    for index in barn_indices(BARN)[::15]:
        result, _ = check(load_arena(f"barn:{index}", path=BARN))
        assert result.success


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.1, 1.0]))
def test_it_arrives_wherever_the_grid_does(seed, scale):
    circles, start, goal = (c * scale for c in scattered(np.random.default_rng(seed), 30))
    if len(astar_path(circles, start, goal)):
        result = plan_guided_path(circles, start, goal)
        assert result.success and not result.collided
        assert clearance(result.path, circles, spacing=0.05 * scale) > 0


def test_no_path_and_no_steps_are_said():
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    cage = np.column_stack([50 + 10 * np.cos(angles), 50 + 10 * np.sin(angles), np.full(60, 1.0)])
    result = plan_guided_path(cage, (50, 50), (5, 5), bounds=(0, 0, 100, 100))
    said = "A* finds no path on its grid with clearances of 1.5, 0.75, 0.375, 0.188, 0.0938, 0.0469 m beside the robot"
    assert not result.success and result.message == said and result.path.tolist() == [[50, 50]]
    result = plan_guided_path([], (0, 0), (50, 50), max_steps=10)
    assert not result.success and "within 10 steps (the limit)" in result.message and len(result.path) == 11


def test_without_obstacles_a_straight_line():
    result = plan_guided_path([], (3, 4), (30, 40))
    assert length(result.path) == pytest.approx(45.0, rel=1e-3) and len(result.smoothed) == 2


def test_bad_input_is_refused():
    with pytest.raises(MapError, match=r"start .* inside"):
        plan_guided_path([(0, 0, 1)], (0, 0), (5, 5))
    with pytest.raises(ConfigError, match="no parameter 'gama'; did you mean 'gamma'"):
        plan_guided_path([], (0, 0), (5, 5), gama=1.0)
