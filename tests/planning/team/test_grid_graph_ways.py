"""Ways alone, and where discs fit."""

import numpy as np
import pytest

from lidarena.planning.grid.grid_search import path_costs
from lidarena.planning.team.grid_graph import STEP, UNREACHABLE, GridGraph


@pytest.mark.parametrize("connectivity", [4, 8])
def test_ways_alone_are_the_shortest(connectivity):
    rng = np.random.default_rng(0)
    grid = rng.random((14, 17)) < 0.3
    grid[3, 4] = False
    graph = GridGraph(grid, connectivity, 0.0)
    ahead = graph.ahead(graph.place(np.array([3, 4])))
    lengths = path_costs(np.where(grid, np.inf, 1.0), (3, 4), connectivity == 8)
    for place, (row, col) in enumerate(graph.cells):
        reached = ahead[place] < UNREACHABLE
        assert reached == np.isfinite(lengths[row, col])
        if reached and connectivity == 4:
            assert ahead[place] == lengths[row, col] * STEP
        if reached:
            assert ahead[place] // STEP <= lengths[row, col]
    surcharged = graph.ahead_with(graph.place(np.array([3, 4])), np.zeros(len(graph), np.int32))
    assert np.array_equal(surcharged, ahead)


def test_the_places_of_a_disc_are_where_it_fits():
    grid = np.zeros((9, 9), bool)
    grid[4, 4] = True
    graph = GridGraph(grid, 8, 1.0)
    assert not (graph.index[3:6, 3:6] >= 0).any() and graph.index[2, 4] >= 0
    assert (graph.index[0] < 0).all() and graph.index[1, 1] >= 0
