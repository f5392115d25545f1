import math

import numpy as np
import pytest

from lidarena.envs.exploration.goal_choice.features import (
    FEATURES,
    NAMES,
    Circumstances,
    describe,
    unknown_regions,
    visible_unknown_cells,
)
from lidarena.planning.driving.explorer import CHOOSES, advance, command, set_out
from tests.planning.driving.worlds import hired, make_world, perceived


def described(steps: int, preference: float) -> tuple[np.ndarray, object]:
    env, info = make_world(3, map="maze:9?width=8&height=8&loops=0.3")
    driver, settings, explorers = hired(env, info, places=4)
    rows = np.zeros((24, FEATURES + 24), np.float32)
    for _ in range(steps):
        told = perceived(info)
        if advance(0, math.log(1e-4), told, driver, settings, explorers) == CHOOSES:
            describe(0, Circumstances(np.array([-9.0]), np.array([preference]), 0.2), explorers, rows)
            set_out(0, 0, told, driver, explorers)
        info = env.step(command(0, told, driver, explorers))[4]
    return rows, explorers


def test_every_candidate_has_its_row_and_the_rest_is_zero() -> None:
    rows, explorers = described(150, 0.25)
    count = int(explorers.candidates.number[0])  # type: ignore[attr-defined]
    named = dict(zip(NAMES, rows[:, :FEATURES].T, strict=True))
    assert count > 2 and not rows[count:].any() and (named["there"][:count] == 1.0).all()
    assert (named["preference"][:count] == 0.25).all() and named["nearest"].sum() == 1.0
    assert (np.diff(named["way"][:count]) >= 0.0).all() and not rows[:count, FEATURES + count :].any()
    ways = rows[:count, FEATURES : FEATURES + count]
    assert np.allclose(ways, ways.T, atol=1e-5) and not np.diag(ways).any()
    assert (np.abs(rows) <= 60.0).all() and named["place"].any()


def test_the_view_is_about_that_of_every_cell() -> None:
    occupancy = np.full((81, 81), -1, np.int8)
    occupancy[36:45, 36:45] = 0
    assert visible_unknown_cells(occupancy, 40, 40, 30.0) == pytest.approx(np.pi * 30.5**2 - 81, rel=0.08)
    occupancy[35:46, 45] = 100  # a wall that hides a third of it
    assert 0.6 * np.pi * 30**2 < visible_unknown_cells(occupancy, 40, 40, 30.0) < 0.9 * np.pi * 30**2


def test_regions_that_are_enclosed_are_told_from_the_outside() -> None:
    env, info = make_world()
    driver, settings, explorers = hired(env, info)
    grid = np.full((40, 40), -1, np.int8)
    grid[5:35, 5:35] = 0
    grid[10:13, 10:14] = -1
    blank = {**info, "map": grid, "origin": np.zeros(2), "pose": np.array([1.0, 1.0, 0.0])}
    blank["scan"] = np.full(len(info["scan"]), 3.5, np.float32)
    advance(0, 0.0, perceived(blank), driver, settings, explorers)
    labels, areas = unknown_regions(0, explorers.drive.ground)
    rows, columns = explorers.drive.ground.extent[0, 2:].tolist()
    assert (rows, columns) == (32, 32) and sorted(areas[1:].tolist()) == [-(32 * 4 - 4), 12]
    assert areas[labels[10 - 4, 10 - 4]] == 12 and areas[labels[0, 0]] < 0
