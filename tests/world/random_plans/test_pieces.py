"""Pieces of furniture."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.world.random_plans.pieces import AT_WALLS, LEG, STANDING, Drawing, Piece, bed, chair, cupboard, table


@pytest.mark.parametrize("draw", [*STANDING, *AT_WALLS])
def test_the_extent_and_the_disc_hold_everything(draw: Drawing) -> None:
    for seed in range(20):
        piece = draw(np.random.default_rng(seed))
        x0, y0, x1, y1 = piece.extent
        for x, y, radius in piece.circles:
            assert x0 <= x - radius and x + radius <= x1 and y0 <= y - radius and y + radius <= y1
            assert math.hypot(x, y) + radius <= piece.radius + 1e-12
        for box in piece.boxes:
            assert x0 <= box[0] < box[2] <= x1 and y0 <= box[1] < box[3] <= y1
            assert max(math.hypot(x, y) for x in box[::2] for y in box[1::2]) <= piece.radius + 1e-12


@pytest.mark.parametrize("draw", AT_WALLS)
def test_what_stands_at_a_wall_does_not_reach_into_it(draw: Drawing) -> None:
    assert all(draw(np.random.default_rng(seed)).extent[1] >= 0.0 for seed in range(20))


def test_legs_are_3_to_6_cm_thick_and_let_a_robot_through() -> None:
    for draw in (chair, table):
        circles = np.array(draw(np.random.default_rng(1)).circles)[:4]
        assert ((circles[:, 2] >= LEG[0]) & (circles[:, 2] <= LEG[1])).all()
        apart = np.hypot(*(circles[:, None, :2] - circles[None, :, :2]).transpose(2, 0, 1)) + 9.0 * np.eye(4)
        assert apart.min() - 2.0 * LEG[1] > 0.3


@settings(max_examples=30, deadline=None)
@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(-math.pi, math.pi))
def test_placing_keeps_sizes_and_distances(x: float, y: float, turn: float) -> None:
    piece = Piece([(1.0, 0.0, 0.1), (0.0, 2.0, 0.3)], [(-0.5, -0.25, 0.5, 0.25)])
    circles, polygons = piece.placed(x, y, (math.cos(turn), math.sin(turn)))
    assert [radius for _, _, radius in circles] == [0.1, 0.3]
    assert math.dist(circles[0][:2], circles[1][:2]) == pytest.approx(math.sqrt(5.0))
    assert math.dist(circles[0][:2], (x, y)) == pytest.approx(1.0)
    sides = np.hypot(*(np.roll(polygons[0], -1, axis=0) - polygons[0]).T)
    assert sides == pytest.approx([1.0, 0.5, 1.0, 0.5])
    assert polygons[0].mean(axis=0) == pytest.approx((x, y))


def test_a_bed_reaches_farther_into_the_room_than_a_cupboard() -> None:
    assert bed(np.random.default_rng(0)).extent[3] > 1.8 > 0.6 > cupboard(np.random.default_rng(0)).extent[3]
