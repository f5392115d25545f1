import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.regression_search import path_length, regression_search, shortened
from tests.planning.potential_field.circle_scenes import clearance, length

ROOM = np.array([-np.inf, -np.inf, np.inf, np.inf])
HALL = np.array([0.0, 0.0, 10.0, 10.0])


def free(a, b, discs, walls=ROOM):
    return segment_is_free(*map(float, (*a, *b)), np.array(discs, float).reshape(-1, 3), walls, np.zeros(1, np.int64))


def slow_regression(path, discs, walls):
    """The farthest point in sight, again and again."""
    chosen = [0]
    while chosen[-1] < len(path) - 1:
        here = chosen[-1]
        seen = [j for j in range(here + 1, len(path)) if free(path[here], path[j], discs, walls)]
        chosen.append(max(seen, default=here + 1))
    return path[chosen]


@st.composite
def walks(draw):
    rng = np.random.default_rng(draw(st.integers(0, 10_000)))
    path = np.cumsum(rng.normal(0.2, 0.5, (draw(st.integers(2, 60)), 2)), axis=0)
    count = draw(st.integers(0, 8))
    return path, np.column_stack([rng.uniform(-2, 12, (count, 2)), rng.uniform(0, 1, count)])


@settings(max_examples=60, deadline=None)
@given(walks())
def test_a_segment_is_free_as_samples_say(walk):
    path, discs = walk
    if not len(discs):
        assert free(path[0], path[-1], discs)
        return
    gap = clearance(path[[0, -1]], discs, spacing=0.002)
    if abs(gap) > 0.003:
        assert free(path[0], path[-1], discs) == (gap > 0)


@settings(max_examples=60, deadline=None)
@given(walks())
def test_the_farthest_point_in_sight_is_taken(walk):
    path, discs = walk
    np.testing.assert_array_equal(regression_search(path, discs, ROOM), slow_regression(path, discs, ROOM))


@settings(max_examples=60, deadline=None)
@given(walks())
def test_it_gets_shorter_and_its_chords_are_free_where_the_path_was(walk):
    path, discs = walk
    once = regression_search(path, discs, ROOM)
    twice = shortened(once, discs, ROOM)
    assert length(twice) <= length(once) * (1 + 1e-12) <= length(path) * (1 + 1e-9)
    assert path_length(path) == pytest.approx(length(path))
    for found in (once, twice):
        np.testing.assert_array_equal(found[[0, -1]], path[[0, -1]])
    if len(discs) and clearance(path, discs, spacing=0.002) > 0.002:
        assert min(clearance(found, discs, spacing=0.01) for found in (once, twice)) > -1e-9


def test_a_long_path_is_searched_with_strides_and_still_free():
    angle = np.linspace(np.pi, 0, 5000)
    path = np.column_stack([3 * np.cos(angle), 3 * np.sin(angle)])
    discs = np.array([[0.0, 0.0, 2.0]])
    found = shortened(regression_search(path, discs, ROOM), discs, ROOM)
    assert clearance(found, discs) >= 0
    tangents = 2 * np.sqrt(5) + 2 * (np.pi - 2 * np.arccos(2 / 3))
    assert tangents < length(found) < 1.01 * tangents


def test_the_single_step_is_taken_where_nothing_is_in_sight():
    path = np.array([(0.0, 0.0), (2.0, 0.0), (4.0, 0.0)])
    discs = np.array([(1.0, 0.0, 0.5), (3.0, 0.0, 0.5)])
    np.testing.assert_array_equal(regression_search(path, discs, ROOM), path)


@pytest.mark.parametrize("points", [1, 2])
def test_short_paths_stay(points):
    path, nothing = np.arange(2.0 * points).reshape(-1, 2), np.empty((0, 3))
    np.testing.assert_array_equal(shortened(regression_search(path, nothing, ROOM), nothing, ROOM), path)


def test_walls_may_be_touched_but_not_crossed():
    assert free((0, 0), (0, 10), [], HALL)
    assert not free((5, 5), (5, 10.001), [], HALL) and not free((-0.001, 5), (5, 5), [], HALL)


def test_a_negative_radius_is_in_nobodys_way():
    assert free((-1, 0), (1, 0), [(0, 0, -0.1)])
    assert not free((-1, 0), (1, 0), [(0, 0, 0.0)])
