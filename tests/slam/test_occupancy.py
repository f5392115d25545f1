import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.occupancy import OCCUPIED_SHARE, OccupancyMaps, clear_map, empty_maps, trace_scan
from lidarena.slam.scan_outline import GAP, SURFACE, empty_outlines

TURN = {n: np.arange(n) * (2 * np.pi / n) for n in (1, 24, 360)}
ANGLES = TURN[24]
SCAN = st.lists(st.floats(0.05, 4.0), min_size=24, max_size=24)
POSE = st.tuples(st.floats(0.2, 3.8), st.floats(0.2, 2.8), st.floats(-3.1, 3.1))


def fresh() -> OccupancyMaps:
    return empty_maps(1, np.ones((1, 60, 80), np.uint8))


def trace(maps: OccupancyMaps, pose: tuple, scan: np.ndarray, sign: int = 1, beams: int = 24) -> None:
    outlines = empty_outlines(1, 60, beams, 3.5, 0.05)
    directions = np.stack([np.cos(TURN[beams]), np.sin(TURN[beams])])
    trace_scan(maps, 0, 0.05, np.array(pose), scan.astype(np.float32), directions, 3.5, sign, outlines, 0)
    assert (outlines.heads == -1).all()  # left as it was found


@settings(max_examples=60, deadline=None)
@given(SCAN, POSE, SCAN, POSE)
def test_taking_a_scan_back_leaves_no_trace(a: list[float], at: tuple, b: list[float], there: tuple) -> None:
    maps, alone = fresh(), fresh()
    first, second = np.array(a, np.float32), np.array(b, np.float32)
    trace(alone, there, second, 1)
    trace(maps, at, first, 1)
    trace(maps, there, second, 1)
    trace(maps, at, first, -1)
    assert np.array_equal(maps.visits, alone.visits)
    assert np.array_equal(maps.hits, alone.hits)
    assert np.array_equal(maps.occupancy, alone.occupancy)
    assert maps.covered[0] == alone.covered[0] == (alone.occupancy >= 0).sum()


@settings(max_examples=60, deadline=None)
@given(SCAN, POSE)
def test_only_cells_on_the_beams_are_known(ranges: list[float], pose: tuple) -> None:
    maps = fresh()
    trace(maps, pose, np.array(ranges))
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
    trace(maps, (1.01, 1.01, 0.0), scan)
    occupancy = maps.occupancy[0]
    assert occupancy[20, 40] == 100
    assert (occupancy[20, 21:40] == 0).all()
    assert (occupancy == 100).sum() == 1
    assert occupancy[20, 42] == -1


@pytest.mark.parametrize(("passes", "expected"), [(1, 100), (2, 100), (4, 0)])
def test_a_cell_is_occupied_above_gmappings_share(passes: int, expected: int) -> None:
    maps = fresh()
    pose = (1.01, 1.01, 0.0)
    for reach in [1.0] + [2.0] * passes:
        trace(maps, pose, np.array([reach]), beams=1)
    assert (1 / (1 + passes) > OCCUPIED_SHARE) == (expected == 100)
    assert maps.occupancy[0, 20, 40] == expected


def test_only_wanted_cells_count_and_clearing_forgets() -> None:
    wanted = np.zeros((2, 60, 80), np.uint8)
    wanted[1, 20] = 1
    maps = empty_maps(1, wanted)
    clear_map(maps, 0, 1, np.zeros(2))
    trace(maps, (1.01, 1.01, 0.0), np.full(24, 0.5))
    assert maps.covered[0] == (maps.occupancy[0, 20] >= 0).sum() > 0
    clear_map(maps, 0, 0, np.zeros(2))
    assert maps.covered[0] == 0
    assert (maps.occupancy == -1).all()


def spoken_for(x: float, y: float, scan: np.ndarray) -> float:
    """Slow oracle: how deep a point (in the sensor's frame) lies inside the gap between two beams; < 0 is outside."""
    n = len(scan)
    step = 2 * math.pi / n
    k = int(math.atan2(y, x) % (2 * math.pi) / step) % n
    a, b = min(scan[k], 3.5), min(scan[(k + 1) % n], 3.5)
    widest = GAP / math.sin(step)
    if abs(a - b) > SURFACE:
        a = b = min(a, b)
    a, b = min(a, widest), min(b, widest)
    ends = [np.array([r * math.cos(t), r * math.sin(t)]) for r, t in ((a, k * step), (b, (k + 1) * step))]
    along = ends[1] - ends[0]
    off_edge = (along[1] * (ends[0][0] - x) - along[0] * (ends[0][1] - y)) / max(np.hypot(*along), 1e-12)
    away, angle = math.hypot(x, y), math.atan2(y, x) % (2 * math.pi) - k * step
    return min(off_edge, away * math.sin(angle), away * math.sin(step - angle))


@settings(max_examples=15, deadline=None)
@given(st.lists(st.floats(0.2, 4.0), min_size=9, max_size=9), POSE)
def test_a_dense_scan_frees_what_lies_between_its_beams_and_nothing_else(corners: list[float], pose: tuple) -> None:
    scan = np.repeat(corners, 40) * (1 + 0.1 * np.sin(TURN[360] * 9))  # surfaces with jumps between them
    maps = fresh()
    trace(maps, pose, scan, beams=360)
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    for row in range(60):
        for column in range(80):
            dx, dy = (column + 0.5) * 0.05 - pose[0], (row + 0.5) * 0.05 - pose[1]
            depth = spoken_for(dx * cos + dy * sin, dy * cos - dx * sin, scan)
            if depth > 1e-9:
                assert maps.visits[0, row, column] >= 1
            # beyond the gaps only what a beam itself passes or hits: at most a cell beside it
            elif depth < -0.08 and maps.visits[0, row, column] > 0:
                nearest = np.abs((math.atan2(dy, dx) - pose[2] - TURN[360] + np.pi) % (2 * np.pi) - np.pi).argmin()
                beside = 1 + math.ceil(math.degrees(math.atan2(0.05 * math.sqrt(0.5), math.hypot(dx, dy))))
                around = scan[np.arange(nearest - beside, nearest + beside + 1) % 360].max()
                assert math.hypot(dx, dy) < min(around, 3.5) + 0.08


def test_a_scan_counts_a_cell_once_however_many_beams_pass_it() -> None:
    maps = fresh()
    for count in (1, 2, 3):
        trace(maps, (2.01, 1.51, 0.3), np.full(360, 1.0), beams=360)
        assert maps.visits[0, 30, 40] == count
        assert maps.visits[0].max() <= 4 * count  # wall cells: hit by beams that do not follow each other
    assert (maps.occupancy[0][maps.hits[0] > 0] == 100).all()
