import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.grid.grid_search import path_costs
from lidarena.planning.grid.way_lengths import LEG, first_leg, way_lengths


@settings(deadline=None)  # the first call loads or compiles the kernels
@given(st.integers(0, 10**6), st.integers(1, 30), st.integers(1, 30), st.sampled_from([0.5, 0.75, 1.0]))
def test_lengths_are_those_of_a_plain_dijkstra_to_the_bit(seed: int, rows: int, columns: int, free: float) -> None:
    rng = np.random.default_rng(seed)
    passable = rng.random((rows, columns)) < free
    start = (int(rng.integers(rows)), int(rng.integers(columns)))
    assert np.array_equal(way_lengths(passable, *start), path_costs(np.where(passable, 1.0, np.inf), start))


def test_a_way_begins_in_the_direction_in_which_it_leads() -> None:
    passable = np.ones((20, 20), np.bool_)
    passable[10, :15] = False  # from below the wall the way leads round its right end
    lengths = way_lengths(passable, 5, 2) * 0.1
    row, column = first_leg(lengths, 15, 2, LEG)
    assert column > 2 and row < 10 and 0.4 < lengths[row, column] <= LEG


def test_nothing_leads_to_what_cannot_be_reached() -> None:
    passable = np.ones((5, 5), np.bool_)
    passable[:, 2] = False
    lengths = way_lengths(passable, 0, 0)
    assert np.isinf(lengths[:, 3:]).all() and first_leg(lengths, 0, 4, LEG) == (0, 4)
