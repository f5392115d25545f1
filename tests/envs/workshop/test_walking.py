"""Ways are shortest, and two who walk keep their distance."""

import math

import numpy as np
import pytest

from lidarena.envs.workshop.walking import (
    RESOLUTION,
    TICK,
    WalkGrid,
    cell_of,
    direction,
    flee,
    is_free,
    make_walk_grid,
    sidestep,
    walking_time,
    way_length,
)
from lidarena.world.floorplan import Floorplan

NOBODY = np.full(2, np.nan)
WALLS = [[0, 0, 8, 0], [8, 0, 8, 6], [8, 6, 0, 6], [0, 6, 0, 0]]


def grid_of(points: list[tuple[float, float]], boxes: list[list[list[float]]] | None = None) -> WalkGrid:
    plan = Floorplan.from_shapes("room", (0, 0, 8, 6), WALLS, boxes or [], start=(1, 1, 0))
    return make_walk_grid(plan, np.array(points), 0.25)


def test_cells_stay_on_the_grid() -> None:
    assert [cell_of(x, -0.5, 10) for x in (-9.0, -0.45, 0.0, 99.0)] == [0, 0, 5, 9]


def test_the_way_across_an_empty_room_is_straight() -> None:
    grid = grid_of([(1.0, 1.0), (7.0, 5.0)])
    assert direction(grid, 1, 1.0, 1.0) == pytest.approx((0.832, 0.555), abs=0.15)
    time = walking_time(grid, 0, 1, NOBODY, 0.1, 0.9, 1e4)
    assert time == pytest.approx(math.hypot(6, 4), rel=0.05)
    assert walking_time(grid, 0, 0, NOBODY, 0.1, 0.9, 1e4) == 0.0
    assert way_length(grid, 1, 7.0, 5.0) == 0.0


def test_a_box_is_walked_around() -> None:
    box = [[3.0, 1.0], [5.0, 1.0], [5.0, 5.0], [3.0, 5.0]]
    grid = grid_of([(1.0, 3.0), (7.0, 3.0)], [box])
    assert not is_free(grid, 4.0, 3.0) and not is_free(grid, 2.8, 3.0) and is_free(grid, 2.6, 3.0)
    around = 2 * math.hypot(2.0, 2.3) + 2.0
    assert walking_time(grid, 0, 1, NOBODY, 0.05, 0.9, 1e4) == pytest.approx(around * 2.0, rel=0.1)
    assert way_length(grid, 1, 1.0, 3.0) == pytest.approx(around, rel=0.1)


def test_what_is_shut_in_cannot_be_reached() -> None:
    ring = [[[5, 2], [5.4, 2], [5.4, 4], [5, 4]], [[5, 4], [7.9, 4], [7.9, 4.4], [5, 4.4]],
            [[5, 1.6], [7.9, 1.6], [7.9, 2], [5, 2]]]  # fmt: skip
    grid = grid_of([(1.0, 3.0), (6.5, 3.0)], ring)
    assert way_length(grid, 1, 1.0, 3.0) == np.inf
    assert walking_time(grid, 0, 1, NOBODY, 0.1, 0.9, 1e4) == np.inf


def test_somebody_in_the_way_costs_time_and_is_kept_away_from() -> None:
    grid = grid_of([(1.0, 3.0), (7.0, 3.0)])
    alone = walking_time(grid, 0, 1, NOBODY, 0.1, 0.9, 1e4)
    past = walking_time(grid, 0, 1, np.array([4.0, 3.0]), 0.1, 0.9, 1e4)
    aside = walking_time(grid, 0, 1, np.array([4.0, 5.5]), 0.1, 0.9, 1e4)
    assert alone == aside < past < alone + 2.0


def test_a_step_is_turned_only_where_it_would_come_too_near() -> None:
    grid = grid_of([(1.0, 3.0)])
    place, ahead = np.array([4.0, 3.0]), np.array([1.0, 0.0])
    assert sidestep(grid, place, np.array([6.0, 3.0]), ahead, 0.1, 0.9, 0)[:2] == (1.0, 0.0)
    for other in ([4.92, 3.02], [4.92, 2.98]):
        x, y, side = sidestep(grid, place, np.array(other), ahead, 0.1, 0.9, 0)
        after = place + 0.1 * np.array([x, y])
        assert np.hypot(*(after - other)) >= 0.9 and side == (-1 if other[1] > 3.0 else 1)
    assert sidestep(grid, place, np.array([3.5, 3.0]), ahead, 0.1, 0.9, 0)[:2] == (1.0, 0.0)  # it leads away


def test_who_gives_way_goes_where_it_is_free() -> None:
    grid = grid_of([(1.0, 3.0)])
    assert flee(grid, np.array([4.0, 3.0]), np.array([5.0, 3.0]), 0.1) == pytest.approx((-1.0, 0.0))
    x, y = flee(grid, np.array([0.34, 3.0]), np.array([1.2, 3.0]), 0.1)
    assert abs(y) > abs(x)  # along the wall
    assert RESOLUTION == TICK == 0.1


def test_who_was_pushed_against_a_wall_is_still_a_finite_way_off() -> None:
    grid = grid_of([(1.0, 1.0), (7.0, 5.0)])
    assert not is_free(grid, 7.95, 3.0)
    assert way_length(grid, 0, 7.95, 3.0) == pytest.approx(way_length(grid, 0, 7.6, 3.0), abs=0.4)
