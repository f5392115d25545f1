"""Measures over the path: standing still counts for nothing, and what is never reached has no value."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.evaluation.measures.over_path import explored_over_path, geometric_mean_over_path, path_at

PATH = np.array([0.0, 1.0, 1.0, 3.0, 4.0])
EXPLORED = np.array([0.2, 0.5, 0.6, 0.96, 0.96])


def test_the_mean_over_the_path_weighs_by_metres() -> None:
    values = np.array([1e-4, 7.0, 1e-2, 1e-4])  # while it stood still the pose was hopeless
    expected = math.exp((math.log(1e-4) + 2 * math.log(1e-2) + math.log(1e-4)) / 4)
    assert geometric_mean_over_path(values, PATH) == pytest.approx(expected)


@given(st.lists(st.floats(1e-6, 1.0), min_size=2, max_size=20), st.integers(0, 19))
def test_waiting_changes_nothing_over_the_path(values: list[float], when: int) -> None:
    path = np.arange(len(values) + 1) * 0.1
    when = min(when, len(values))
    waited = np.insert(path, when, path[when])
    after = np.insert(np.array(values), when, 0.0)  # the step of waiting, wonderfully certain
    assert geometric_mean_over_path(after, waited) == pytest.approx(geometric_mean_over_path(np.array(values), path))


def test_without_driving_there_is_no_mean_over_the_path() -> None:
    assert math.isnan(geometric_mean_over_path(np.array([1e-3, 1e-3]), np.zeros(3)))
    assert math.isnan(geometric_mean_over_path(np.array([1e-3]), np.array([np.nan, np.nan])))
    assert math.isnan(geometric_mean_over_path(np.array([]), np.zeros(1)))
    assert geometric_mean_over_path(np.array([0.0, 1.0]), np.array([0.0, 1.0, 2.0])) == 0.0


def test_the_path_at_a_share_is_that_of_the_first_time() -> None:
    assert path_at(0.95, EXPLORED, PATH) == 3.0
    assert path_at(0.1, EXPLORED, PATH) == 0.0
    assert math.isnan(path_at(0.99, EXPLORED, PATH))


def test_the_area_is_that_under_the_curve() -> None:
    until_the_end = 0.35 + 2 * 0.78 + 0.96
    assert explored_over_path(EXPLORED, PATH, 4.0) == pytest.approx(until_the_end / 4)
    assert explored_over_path(EXPLORED, PATH, 10.0) == pytest.approx((until_the_end + 6 * 0.96) / 10)
    assert explored_over_path(EXPLORED, PATH, 0.5) == pytest.approx((0.2 + 0.35) / 2)
    assert explored_over_path(np.ones(5), PATH, 7.0) == pytest.approx(1.0)


def test_driving_on_when_done_leaves_the_area_as_it_is() -> None:
    longer = explored_over_path(np.append(EXPLORED, 0.96), np.append(PATH, 9.0), 6.0)
    assert longer == pytest.approx(explored_over_path(EXPLORED, PATH, 6.0))


@pytest.mark.parametrize("horizon", [0.0, math.nan])
def test_without_a_horizon_there_is_no_area(horizon: float) -> None:
    assert math.isnan(explored_over_path(EXPLORED, PATH, horizon))
    assert math.isnan(explored_over_path(EXPLORED, np.full(5, np.nan), 4.0))
