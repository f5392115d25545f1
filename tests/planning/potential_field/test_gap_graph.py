"""Ways between obstacles, measured by the gaps of neighbours."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.potential_field.circle_grid import grid_path
from lidarena.planning.potential_field.field_scene import make_scene
from lidarena.planning.potential_field.gap_graph import GapGraph
from tests.planning.potential_field.circle_scenes import length, scattered

TWO = [(0.0, 1.0, 0.25), (0.0, -1.0, 0.25)]
"""A gap of 1.5 m about the origin."""


def test_a_gap_is_open_as_long_as_both_sides_keep_the_clearance():
    gaps = GapGraph(make_scene(TWO, (-5, 0), (5, 0)))
    assert gaps.way_length(0.7) == pytest.approx(10.0, rel=1e-6)
    assert 10.2 < gaps.way_length(0.8) < 13.0  # around either
    inside = GapGraph(make_scene(TWO, (-5, 0), (5, 0), 0.0, (-6, -2, 6, 2)))
    assert inside.way_length(0.7) == pytest.approx(10.0, rel=1e-6)
    assert inside.way_length(0.8) == math.inf  # 0.75 m are left at the walls, too


def test_the_robots_radius_narrows_gaps():
    gaps = GapGraph(make_scene(TWO, (-5, 0), (5, 0), 0.5, (-6, -2, 6, 2)))
    assert gaps.way_length(0.2) == pytest.approx(10.0, rel=1e-6)
    assert gaps.way_length(0.3) == math.inf


def test_the_way_goes_through_the_gaps_or_through_their_middles():
    gaps = GapGraph(make_scene([(0.0, 3.0, 0.25), (0.0, -1.0, 0.25)], (-5, 0), (5, 0), 0.0, (-6, -1.2, 6, 3.2)))
    assert gaps.way(0.1)[0].tolist() == [-5, 0] and gaps.way(0.1)[-1].tolist() == [5, 0]
    assert gaps.way_length(0.1) == pytest.approx(10.0, rel=1e-6)
    middle = gaps.way(0.1, in_the_middle=True)
    assert np.abs(middle - (0.0, 1.0)).sum(axis=1).min() < 1e-9


@pytest.mark.parametrize("bounds", [None, (0, 0, 10, 10)])
@pytest.mark.parametrize("centres", [[], [(5, 5)], [(5, 5), (5, 5), (5, 7)], [(2, 5), (5, 5), (8, 5)]])
def test_few_or_aligned_or_equal_discs_are_no_exception(centres, bounds):
    circles = [(x, y, 1.0) for x, y in centres]
    found = GapGraph(make_scene(circles, (1, 1), (9, 9), 0.0, bounds)).way_length(0.1)
    assert 1.0 <= found / math.dist((1, 1), (9, 9)) < 1.3


def test_start_on_the_goal():
    assert GapGraph(make_scene([(5, 5, 1)], (1, 1), (1, 1))).way_length(0.1) < 1e-9


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.5, 1.5]))
def test_its_lengths_are_near_those_of_a_star(seed, clearance):
    circles, start, goal = scattered(np.random.default_rng(seed), 40)
    scene = make_scene(circles, start, goal, 0.0, (0, 0, 100, 100))
    path = grid_path(scene.narrowed(scene.keeping(clearance)), 0.5)
    found = GapGraph(scene).way_length(clearance)
    if len(path):
        assert 0.85 < found / length(path) < 1.2
