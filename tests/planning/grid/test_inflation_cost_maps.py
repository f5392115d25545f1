"""Clearance and costs of larger maps, against scipy's exact distance transform and the formula of each cell."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from lidarena.planning.grid.grid_search import find_path, path_costs
from lidarena.planning.grid.inflation import Decay, Inflation, clearance, inflate, open_start

RES = 0.05
SEED = st.integers(0, 10**6)
DECAY = st.sampled_from(["linear", "exponential"])


def patches(seed: int, rows: int = 45, cols: int = 60) -> np.ndarray:
    """A map of free space with blocks, some cells of every occupancy, and an unknown part."""
    rng = np.random.default_rng(seed)
    occupancy = np.zeros((rows, cols), np.int8)
    for _ in range(5):
        r, c = rng.integers(rows), rng.integers(cols)
        occupancy[r : r + rng.integers(1, 9), c : c + rng.integers(1, 9)] = 100
    speckled = rng.random((rows, cols)) < 0.01
    occupancy[speckled] = rng.integers(1, 101, speckled.sum())
    occupancy[:, cols - int(rng.integers(1, 15)) :] = -1
    return occupancy


@settings(max_examples=25, deadline=None)
@given(SEED, st.sampled_from([1, 30, 50, 100]))
def test_clearance_is_scipys_distance_transform(seed: int, occupied_from: int) -> None:
    occupancy = patches(seed)
    solid = occupancy >= occupied_from
    found = clearance(occupancy, RES, occupied_from, reach=4.0)
    if solid.any():
        exact = np.maximum((ndimage.distance_transform_edt(~solid) - 0.5) * RES, 0.0)
        np.testing.assert_allclose(found, exact, atol=1e-5)
    else:
        assert (found >= 4.0 - RES).all()


@settings(max_examples=20, deadline=None)
@given(SEED)
def test_mirrored_and_turned_maps_have_mirrored_and_turned_clearance(seed: int) -> None:
    occupancy = patches(seed)
    found = clearance(occupancy, RES)
    np.testing.assert_array_equal(clearance(occupancy[::-1], RES), found[::-1])
    np.testing.assert_array_equal(clearance(occupancy.T, RES), found.T)


@settings(max_examples=20, deadline=None)
@given(SEED, DECAY, st.booleans())
def test_each_cell_costs_what_the_formula_says(seed: int, decay: Decay, through_unknown: bool) -> None:
    occupancy = patches(seed)
    inflation = Inflation(0.12, 0.4, 3.0, decay, 6.0, through_unknown, 60)
    cost = inflate(occupancy, RES, inflation)
    gap = np.maximum((ndimage.distance_transform_edt(occupancy < 60) - 0.5) * RES, 0.0)
    for (r, c), away in np.ndenumerate(gap):
        beyond = away - 0.12
        if abs(beyond) < 1e-5 or abs(away - 0.4) < 1e-5:
            continue  # on the border either side may win
        if beyond < 0 or occupancy[r, c] >= 60 or (occupancy[r, c] < 0 and not through_unknown):
            assert math.isinf(cost[r, c])
        elif away >= 0.4:
            assert cost[r, c] == 1.0
        else:
            share = math.exp(-6.0 * beyond) if decay == "exponential" else 1 - beyond / 0.28
            assert cost[r, c] == pytest.approx(1 + 3.0 * share, abs=1e-4)


@settings(max_examples=20, deadline=None)
@given(SEED, DECAY)
def test_another_obstacle_makes_nothing_cheaper_and_no_way_shorter(seed: int, decay: Decay) -> None:
    rng, inflation = np.random.default_rng(seed), Inflation(0.1, 0.35, decay=decay)
    before = patches(seed)
    after = before.copy()
    after[rng.integers(45), rng.integers(60)] = 100
    costs = [inflate(occupancy, RES, inflation) for occupancy in (before, after)]
    assert (costs[1] >= costs[0]).all()
    start = (int(rng.integers(45)), int(rng.integers(60)))
    ways = [path_costs(cost, start) for cost in costs]
    assert (ways[1] >= ways[0] - 1e-9).all()


@settings(max_examples=25, deadline=None)
@given(SEED, st.integers(1, 12))
def test_letting_a_robot_out_opens_known_cells_near_it_and_nothing_else(seed: int, reach: int) -> None:
    rng, inflation = np.random.default_rng(seed), Inflation(0.2, 0.4)
    occupancy = patches(seed)
    gap = clearance(occupancy, RES)
    cost = inflate(occupancy, RES, inflation, gap)
    before, cell = cost.copy(), (int(rng.integers(45)), int(rng.integers(60)))
    open_start(cost, occupancy, gap, cell, reach, inflation)
    changed = cost != before
    if math.isfinite(before[cell]):
        assert not changed.any()
        return
    rows, cols = np.nonzero(changed)
    assert (np.abs(rows - cell[0]) <= reach).all() and (np.abs(cols - cell[1]) <= reach).all()
    assert np.isinf(before[changed]).all() and np.isfinite(cost[changed]).all()
    assert ((occupancy[changed] >= 0) & (occupancy[changed] < 50)).all()
    assert (cost[changed] > 1.0 + inflation.weight).all()  # dearer than every cell that was open before
    assert changed[cell] == (0 <= occupancy[cell] < 50)
    order = np.argsort(gap[changed])
    assert (np.diff(cost[changed][order]) <= 1e-9).all()  # cheaper the farther from the wall


@settings(max_examples=20, deadline=None)
@given(SEED)
def test_every_part_of_a_cheapest_way_is_a_cheapest_way(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cost = inflate(patches(seed), RES, Inflation(0.1, 0.35))
    free = np.argwhere(np.isfinite(cost))
    start, goal = (tuple(cell) for cell in free[rng.integers(len(free), size=2)].tolist())
    path = find_path(cost, start, goal)
    from_start = path_costs(cost, start)
    assert len(path) == 0 or np.isfinite(from_start[goal])
    steps = np.hypot(*np.diff(path, axis=0).T) * cost[path[1:, 0], path[1:, 1]] if len(path) else np.empty(0)
    np.testing.assert_allclose(np.cumsum(steps), from_start[path[1:, 0], path[1:, 1]])
