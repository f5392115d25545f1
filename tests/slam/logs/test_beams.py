"""Scans of changing beams come onto one set of angles; codes, infinities and NaN are no returns or no measurements."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.slam.logs.beams import BeamLayout, bring_together
from lidarena.slam.logs.recorded_log import LogError, LogOptions

DEGREE = math.radians(1.0)
FRONT = BeamLayout(180, -90 * DEGREE, DEGREE)
WHOLE = BeamLayout(181, -90 * DEGREE, DEGREE)


def wall(layout: BeamLayout) -> np.ndarray:
    """Ranges to a wall 2 m ahead, at most 20 m."""
    return np.minimum(2.0 / np.maximum(np.cos(layout.angles), 1e-9), 20.0)


def test_beams_that_never_change_are_left_as_they_are() -> None:
    beams = bring_together([wall(FRONT)] * 3, [FRONT] * 3, 80.0, LogOptions(), "a")
    np.testing.assert_array_equal(beams.ranges, np.float32([wall(FRONT)] * 3))
    np.testing.assert_array_equal(beams.angles, FRONT.angles)
    assert beams.max_range == 80.0 and not beams.notes


def test_180_and_181_beams_in_turn_are_one_laser() -> None:
    layouts = [FRONT, WHOLE, FRONT, WHOLE, FRONT]
    beams = bring_together([wall(each) for each in layouts], layouts, 80.0, LogOptions(), "a")
    np.testing.assert_allclose(beams.angles, WHOLE.angles, atol=1e-9)
    for row, layout in zip(beams.ranges, layouts, strict=True):
        np.testing.assert_array_equal(row[: layout.count], np.float32(wall(layout)))
        assert (row[layout.count :] == 0.0).all()
    assert "the beams change: 3 scans of 180 beams 1° apart" in beams.notes[0]


@given(st.floats(-0.4, 0.4), st.sampled_from([0.25, 0.5, 2.0]))
def test_another_start_and_step_see_the_same_wall(shift: float, step: float) -> None:
    other = BeamLayout(round(120 / step), (-60 + shift) * DEGREE, step * DEGREE)
    beams = bring_together([wall(FRONT)] * 2 + [wall(other)], [FRONT, FRONT, other], 80.0, LogOptions(), "a")
    seen = (beams.ranges[2] > 0) & (np.abs(beams.angles) < 50 * DEGREE)
    assert seen.sum() >= 98
    np.testing.assert_allclose((beams.ranges[2] * np.cos(beams.angles))[seen], 2.0, rtol=0.003 if step < 1 else 0.02)


@pytest.mark.parametrize("code", [81.83, 81.87, 81.91, math.inf, 80.0, 79.7])
def test_every_kind_of_no_return_is_one(code: float) -> None:
    scan = np.array([1.0, code, 2.0, math.nan, -1.0, 0.0])
    beams = bring_together([scan], [BeamLayout(6, 0.0, DEGREE)], 80.0, LogOptions(), "a")
    np.testing.assert_allclose(beams.ranges[0], [1.0, 80.0, 2.0, 0.0, 0.0, 0.0])


def test_codes_are_no_returns_though_nothing_tells_the_longest_range() -> None:
    scan = np.array([1.0, 81.83, 81.87, 81.91, 2.0])
    beams = bring_together([scan], [BeamLayout(5, 0.0, DEGREE)], math.inf, LogOptions(), "a")
    assert (beams.ranges[0] >= beams.max_range).tolist() == [False, True, True, True, False]


def test_the_users_longest_range_counts() -> None:
    scan = np.array([1.0, 7.9, 8.0, 30.0])
    beams = bring_together([scan], [BeamLayout(4, 0.0, DEGREE)], 80.0, LogOptions(max_range=8.0), "a")
    np.testing.assert_allclose(beams.ranges[0], [1.0, 7.9, 8.0, 8.0])


@pytest.mark.parametrize(("unit", "factor"), [("cm", 100.0), ("mm", 1000.0)])
def test_ranges_that_are_no_metres_are_told_and_can_be_read(unit: str, factor: float) -> None:
    scans = [wall(FRONT) * factor]
    with pytest.raises(LogError, match=rf"no metres in any building; if they are {unit}, say so \(--range-unit {unit}"):
        bring_together(scans, [FRONT], math.inf, LogOptions(), "log 'a'")
    beams = bring_together(scans, [FRONT], math.inf, LogOptions(range_unit=unit), "log 'a'")
    np.testing.assert_allclose(beams.ranges[0, 30:150], wall(FRONT)[30:150], rtol=1e-6)


def test_scans_without_any_return_are_refused() -> None:
    with pytest.raises(LogError, match="log 'a' has no scan with a single return below 80 m"):
        bring_together([np.full(180, np.inf)] * 2, [FRONT] * 2, 80.0, LogOptions(), "log 'a'")
