import numpy as np
import pytest

from lidarena.envs.arena.potential_grid import survey
from lidarena.world.arenas import Arena, load_arena


def test_the_traditional_field_has_a_minimum_in_the_trap() -> None:
    land = survey(load_arena("yang:u"), "traditional")
    assert not land.plan.success
    away = np.hypot(*(land.minima - land.plan.path[-1]).T)
    assert away.min() < 1.5  # where the walk ends is one of the minima
    assert land.field.scene.goal.tolist() == [70.0, 70.0]


def test_the_goal_is_no_minimum_beside_the_goal() -> None:
    for name in ("yang", "yang:arc"):
        land = survey(load_arena(name), "robust")
        assert not len(land.minima) or np.hypot(*(land.minima - 70.0).T).min() > 1.0
        assert land.plan.success


def test_an_empty_room_has_its_only_minimum_at_the_goal() -> None:
    arena = Arena("empty", np.empty((0, 3)), (10.0, 50.0), (80.0, 40.0), (0.0, 0.0, 100.0, 60.0), 1.0)
    land = survey(arena, "paper")
    assert not len(land.minima)
    row, column = np.unravel_index(int(np.argmin(land.potential)), land.potential.shape)
    lowest = land.origin + (np.array([column, row]) + 0.5) * land.cell
    assert lowest == pytest.approx(np.array([80.0, 40.0]), abs=land.cell)
    assert land.potential.shape == (144, 240)


def test_obstacles_are_infinitely_high() -> None:
    land = survey(load_arena("yang"), "robust")
    row, column = ((np.array([45.0, 40.0]) - land.origin[::-1]) / land.cell).astype(int)
    assert np.isinf(land.potential[row, column])
    assert np.isfinite(land.potential).mean() > 0.9


def test_no_warning_reaches_whoever_draws() -> None:
    arena = Arena("tight", np.array([[71.0, 70.0, 0.2]]), (0.0, 0.0), (70.0, 70.0), (-5.0, -5.0, 95.0, 95.0), 0.0)
    survey(arena, "paper")  # k/η breaks its bound here; warnings are errors in these tests
