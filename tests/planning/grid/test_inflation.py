import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lidarena.base.errors import ConfigError
from lidarena.planning.grid.grid_search import find_path
from lidarena.planning.grid.inflation import Inflation, clearance, inflate, open_start

RES = 0.05
maps = arrays(np.int8, st.tuples(st.integers(1, 12), st.integers(1, 12)), elements=st.sampled_from([-1, 0, 0, 0, 100]))


def slow_clearance(occupancy):
    occupied = np.argwhere(occupancy >= 50)
    if not len(occupied):
        return np.full(occupancy.shape, np.inf)
    rows, cols = np.indices(occupancy.shape)
    cells = np.stack([rows, cols], axis=-1)[:, :, None, :]
    return np.maximum(np.sqrt(((cells - occupied) ** 2).sum(-1).min(-1)) - 0.5, 0.0) * RES


@settings(max_examples=150, deadline=None)
@given(maps, st.sampled_from([0.1, 0.3, 1.0]))
def test_clearance_is_exact_within_reach(occupancy, reach):
    found, expected = clearance(occupancy, RES, reach=reach), slow_clearance(occupancy)
    near = expected <= reach - 0.5 * RES
    np.testing.assert_allclose(found[near], expected[near], atol=1e-6)
    assert (found[~near] > reach - 0.5 * RES - 1e-6).all()


@settings(max_examples=100, deadline=None)
@given(maps, st.sampled_from(["linear", "exponential"]), st.booleans())
def test_costs(occupancy, decay, through_unknown):
    inflation = Inflation(0.1, 0.3, weight=4.0, decay=decay, through_unknown=through_unknown)
    cost, gap = inflate(occupancy, RES, inflation), slow_clearance(occupancy)
    blocked = (gap < 0.1 - 1e-6) | ((occupancy < 0) & (not through_unknown))
    np.testing.assert_array_equal(np.isinf(cost), blocked)
    passable = cost[~blocked]
    assert ((passable >= 1.0) & (passable <= 5.0)).all()
    assert (cost[~blocked & (gap > 0.3)] == 1.0).all()
    order = np.argsort(gap[~blocked])
    assert (np.diff(passable[order]) <= 1e-6).all()  # never dearer farther away


def test_decay_at_its_ends():
    row = np.array([[100] + [0] * 12], np.int8)
    linear = inflate(row, RES, Inflation(0.125, 0.425, weight=3.0, decay="linear"))[0]
    assert linear[3] == pytest.approx(4.0, abs=1e-5)
    assert linear[6] == pytest.approx(2.5, abs=1e-5)
    assert linear[9] == pytest.approx(1.0, abs=1e-5)
    exponential = inflate(row, RES, Inflation(0.125, 0.6, weight=3.0, rate=8.0))[0]
    assert exponential[3] == pytest.approx(4.0, abs=1e-5)
    assert exponential[5] == pytest.approx(1.0 + 3.0 * math.exp(-0.8), abs=1e-5)


def test_paths_keep_off_the_walls():
    occupancy = np.zeros((21, 60), np.int8)
    occupancy[[0, -1]] = 100
    path = find_path(inflate(occupancy, RES, Inflation(0.15, 0.6)), (5, 2), (5, 57))
    assert np.median(path[:, 0]) == 10


def test_a_robot_in_the_lethal_zone_is_let_out_the_short_way():
    occupancy = np.zeros((40, 40), np.int8)
    occupancy[:, :3] = 100
    occupancy[:, 25:] = -1
    inflation = Inflation(0.3, 0.6)
    gap = clearance(occupancy, RES)
    cost = inflate(occupancy, RES, inflation, gap)
    assert math.isinf(cost[20, 4])
    open_start(cost, occupancy, gap, (20, 4), 12, inflation)
    path = find_path(cost, (20, 4), (35, 20))
    assert len(path)
    out = next(i for i, (r, c) in enumerate(path) if gap[r, c] >= 0.3)
    assert (np.diff(gap[path[: out + 1, 0], path[: out + 1, 1]]) > 0).all()
    assert np.isinf(cost[:, 25:]).all() and np.isinf(cost[:, :3]).all()


def test_opening_changes_nothing_where_the_start_is_free():
    occupancy = np.zeros((20, 20), np.int8)
    occupancy[0] = 100
    inflation = Inflation(0.2, 0.4)
    gap = clearance(occupancy, RES)
    cost = inflate(occupancy, RES, inflation, gap)
    before = cost.copy()
    open_start(cost, occupancy, gap, (12, 10), 12, inflation)
    np.testing.assert_array_equal(cost, before)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"lethal_radius": 0.5, "radius": 0.3}, "0.5"),
        ({"lethal_radius": -0.1}, "-0.1"),
        ({"radius": math.inf}, "inf"),
        ({"weight": math.nan}, "nan"),
        ({"rate": -1.0}, "-1"),
        ({"decay": "linaer"}, "did you mean 'linear'"),
        ({"occupied_from": 0}, "occupied_from"),
    ],
)
def test_bad_parameters_are_refused(options, says):
    with pytest.raises(ConfigError, match=says):
        Inflation(**options)
