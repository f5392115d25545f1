import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.grid.inflation import clearance
from lidarena.planning.grid.surroundings import Surroundings, gap_at, in_sight

RES = 0.05


def room(width, height, solid=()):
    """A walled room (m), with solid rectangles x0, y0, x1, y1 (m)."""
    rows, cols = round(height / RES), round(width / RES)
    occupancy = np.zeros((rows + 2, cols + 2), np.int8)
    occupancy[[0, -1]] = 100
    occupancy[:, [0, -1]] = 100
    for x0, y0, x1, y1 in solid:
        occupancy[1 + round(y0 / RES) : 1 + round(y1 / RES), 1 + round(x0 / RES) : 1 + round(x1 / RES)] = 100
    return Surroundings(clearance(occupancy, RES), occupancy != 0, RES, (-RES, -RES))


def test_points_and_cells_are_inverse():
    around = room(2.0, 1.0)
    cells = np.argwhere(~around.closed)
    points = around.points(cells)
    assert [around.cell(x, y) for x, y in points] == [tuple(cell) for cell in cells.tolist()]
    assert around.cell(-50.0, 50.0) == (around.gap.shape[0] - 1, 0)


@settings(max_examples=100, deadline=None)
@given(st.floats(0.2, 1.8), st.floats(0.2, 0.8))
def test_gap_is_the_distance_to_the_walls(x, y):
    around = room(2.0, 1.0)
    expected = min(x, 2.0 - x, y, 1.0 - y)
    assert gap_at(around.gap, around.closed, around.frame, x, y) == pytest.approx(expected, abs=0.6 * RES)


def test_gap_is_negative_where_the_robot_must_not_go():
    around = room(2.0, 1.0)
    for x, y in ((-0.02, 0.5), (5.0, 0.5), (1.0, -3.0)):
        assert gap_at(around.gap, around.closed, around.frame, x, y) == -1.0


def test_sight_ends_at_walls_and_where_it_becomes_narrow():
    around = room(3.0, 2.0, [(1.4, 0.0, 1.6, 1.2)])
    left, right, top = np.array([0.5, 0.5]), np.array([2.5, 0.5]), np.array([1.5, 1.6])
    assert not in_sight(around, left, right) and not in_sight(around, right, left)
    assert in_sight(around, left, top) and in_sight(around, top, right)
    assert in_sight(around, left, np.array([0.5, 1.5]), margin=0.4)
    assert not in_sight(around, left, top, margin=0.4)
    assert not in_sight(around, left, np.array([0.5, 5.0]))  # off the map
    assert in_sight(around, left, left)
