"""Two robots in one time step: the nearest approach against many moments, and what does not change who looks how."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.moves import MOVES, conflicting_moves, footprints, nearest_approach, too_close

PLACE, CHANGE = st.integers(-4, 4), st.integers(-2, 2)
APART = st.sampled_from([0.0, 0.5, 0.8, 1.0, 1.5, 2.0, 2.6])


@settings(max_examples=100, deadline=None)
@given(PLACE, PLACE, CHANGE, CHANGE)
def test_no_moment_is_nearer_than_the_nearest_approach(row: int, col: int, rows: int, cols: int) -> None:
    when = nearest_approach(float(row), float(col), float(rows), float(cols))
    moments = np.linspace(0.0, 1.0, 241)
    distances = np.hypot(row + moments * rows, col + moments * cols)
    assert 0.0 <= when <= 1.0
    assert np.hypot(row + when * rows, col + when * cols) <= distances.min() + 1e-12


@settings(max_examples=100, deadline=None)
@given(PLACE, PLACE, CHANGE, CHANGE, APART)
def test_a_conflict_is_the_same_from_the_other_robot_backwards_turned_and_mirrored(
    row: int, col: int, rows: int, cols: int, apart: float
) -> None:
    step = tuple(map(float, (row, col, rows, cols)))
    r, c, dr, dc = step
    found = {
        bool(too_close(*numbers, apart))
        for numbers in (
            step,
            (-r, -c, -dr, -dc),  # seen from the other one
            (r + dr, c + dc, -dr, -dc),  # backwards in time
            (c, -r, dc, -dr),  # a quarter turn
            (c, r, dc, dr),  # mirrored
        )
    }
    assert len(found) == 1


@settings(max_examples=60, deadline=None)
@given(PLACE, PLACE, CHANGE, CHANGE)
def test_larger_robots_conflict_wherever_smaller_ones_do(row: int, col: int, rows: int, cols: int) -> None:
    found = [too_close(float(row), float(col), float(rows), float(cols), apart) for apart in (0.0, 0.7, 1.0, 1.9, 3.0)]
    assert found == sorted(found)


def test_points_in_four_directions_have_the_usual_vertex_and_swap_conflicts() -> None:
    table = conflicting_moves(0.0, 4)
    for move, other in itertools.product(range(5), repeat=2):
        for cell in itertools.product(range(-2, 3), repeat=2):
            mine, theirs = MOVES[move], np.add(cell, MOVES[other])
            vertex = cell == (0, 0) or tuple(theirs) == tuple(mine)
            swap = tuple(theirs) == (0, 0) and tuple(mine) == cell
            assert bool(table[move].get(cell, 0) >> other & 1) == (vertex or swap)


def test_two_diagonals_that_cross_conflict_though_no_cell_is_shared() -> None:
    down_right, down_left = 5, 6
    assert conflicting_moves(0.0, 8)[down_right][0, 1] >> down_left & 1


@pytest.mark.parametrize(("apart", "connectivity"), [(0.0, 4), (0.0, 8), (1.0, 4), (1.8, 8)])
def test_footprints_are_the_same_table_in_rows(apart: float, connectivity: int) -> None:
    stride = 50
    begins, entries = footprints(apart, connectivity, stride)
    table = conflicting_moves(apart, connectivity)
    assert begins[0] == 0 and begins[-1] == len(entries) and len(begins) == connectivity + 2
    for move, found in table.items():
        rows = entries[begins[move] : begins[move + 1]]
        assert {int(row[0]): int(row[1]) for row in rows} == {r * stride + c: b for (r, c), b in found.items()}
        for _, bits, ones in rows.tolist():
            assert [ones >> 4 * m & 15 for m in range(9)] == [bits >> m & 1 for m in range(9)]
