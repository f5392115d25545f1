import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.occupancy import OCCUPIED_SHARE, clear_map, empty_maps, trace_scan

ANGLES = np.arange(24) * (2 * np.pi / 24)
DIRECTIONS = np.stack([np.cos(ANGLES), np.sin(ANGLES)])
SCAN = st.lists(st.floats(0.05, 4.0), min_size=24, max_size=24)
POSE = st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8), st.floats(-3.1, 3.1))


def fresh() -> tuple:
    return empty_maps(1, np.ones((1, 60, 80), np.uint8))


@settings(max_examples=60, deadline=None)
@given(SCAN, POSE, SCAN, POSE)
def test_taking_a_scan_back_leaves_no_trace(a: list[float], at: tuple, b: list[float], there: tuple) -> None:
    maps, alone = fresh(), fresh()
    first, second = np.array(a, np.float32), np.array(b, np.float32)
    trace_scan(alone, 0, 0.05, np.array(there), second, DIRECTIONS, 3.5, 1)
    trace_scan(maps, 0, 0.05, np.array(at), first, DIRECTIONS, 3.5, 1)
    trace_scan(maps, 0, 0.05, np.array(there), second, DIRECTIONS, 3.5, 1)
    trace_scan(maps, 0, 0.05, np.array(at), first, DIRECTIONS, 3.5, -1)
    assert np.array_equal(maps.visits, alone.visits)
    assert np.array_equal(maps.hits, alone.hits)
    assert np.array_equal(maps.occupancy, alone.occupancy)
    assert maps.covered[0] == alone.covered[0] == (alone.occupancy >= 0).sum()


@settings(max_examples=60, deadline=None)
@given(SCAN, POSE)
def test_only_cells_on_the_beams_are_known(ranges: list[float], pose: tuple) -> None:
    maps = fresh()
    trace_scan(maps, 0, 0.05, np.array(pose), np.array(ranges, np.float32), DIRECTIONS, 3.5, 1)
    for row, column in np.argwhere(maps.occupancy[0] >= 0):
        x, y = (column + 0.5) * 0.05 - pose[0], (row + 0.5) * 0.05 - pose[1]
        away, angle = math.hypot(x, y), math.atan2(y, x) - pose[2]
        k = round(angle / (2 * np.pi / 24)) % 24
        aside = abs(away * math.sin(angle - ANGLES[k]))
        # the line joins the cells' centres: half a cell beside the beam, and half a cell
        assert aside < 0.08 or away < 0.3
        assert away < min(max(ranges), 3.5) + 0.08


def test_hits_are_occupied_missing_returns_only_free_and_the_rest_unknown() -> None:
    maps = fresh()
    scan = np.full(24, 3.5, np.float32)
    scan[0] = 1.0
    trace_scan(maps, 0, 0.05, np.array([1.01, 1.01, 0.0]), scan, DIRECTIONS, 3.5, 1)
    occupancy = maps.occupancy[0]
    assert occupancy[20, 40] == 100
    assert (occupancy[20, 21:40] == 0).all()
    assert (occupancy == 100).sum() == 1
    assert occupancy[20, 42] == -1


@pytest.mark.parametrize(("passes", "expected"), [(1, 100), (2, 100), (4, 0)])
def test_a_cell_is_occupied_above_gmappings_share(passes: int, expected: int) -> None:
    maps = fresh()
    pose = np.array([1.01, 1.01, 0.0])
    for reach in [1.0] + [2.0] * passes:
        trace_scan(maps, 0, 0.05, pose, np.array([reach], np.float32), DIRECTIONS[:, :1], 3.5, 1)
    assert (1 / (1 + passes) > OCCUPIED_SHARE) == (expected == 100)
    assert maps.occupancy[0, 20, 40] == expected


def test_only_wanted_cells_count_and_clearing_forgets() -> None:
    wanted = np.zeros((2, 60, 80), np.uint8)
    wanted[1, 20] = 1
    maps = empty_maps(1, wanted)
    clear_map(maps, 0, 1, np.zeros(2))
    trace_scan(maps, 0, 0.05, np.array([1.01, 1.01, 0.0]), np.full(24, 0.5, np.float32), DIRECTIONS, 3.5, 1)
    assert maps.covered[0] == (maps.occupancy[0, 20] >= 0).sum() > 0
    clear_map(maps, 0, 0, np.zeros(2))
    assert maps.covered[0] == 0
    assert (maps.occupancy == -1).all()
