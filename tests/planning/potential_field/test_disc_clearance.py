"""Whether a segment is free, against the distance between a point and a segment as found by a search."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from lidarena.planning.potential_field.disc_clearance import segment_is_free

NO_WALLS = np.array([-np.inf, -np.inf, np.inf, np.inf])
PLACE = st.tuples(st.floats(-5, 5), st.floats(-5, 5))
DISCS = st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(0, 2)), max_size=5)
Point = tuple[float, float]


def free(a: Point, b: Point, discs: list, walls: np.ndarray = NO_WALLS, first: int = 0) -> bool:
    table = np.array(discs, float).reshape(-1, 3)
    return segment_is_free(*a, *b, table, walls, np.array([first], np.int64))


def distance(a: Point, b: Point, centre: Point) -> float:
    def away(share: float) -> float:
        return math.dist((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])), centre)

    found = minimize_scalar(away, bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-9})
    return min(away(float(found.x)), away(0.0), away(1.0))


@settings(max_examples=80, deadline=None)
@given(PLACE, PLACE, DISCS)
def test_a_segment_is_free_if_it_stays_out_of_every_disc(a: Point, b: Point, discs: list) -> None:
    least = min((distance(a, b, (x, y)) - radius for x, y, radius in discs), default=math.inf)
    if abs(least) > 1e-6:
        assert free(a, b, discs) == (least > 0)


@settings(max_examples=80, deadline=None)
@given(PLACE, PLACE, DISCS, st.integers(0, 6))
def test_the_disc_that_is_asked_first_changes_nothing(a: Point, b: Point, discs: list, first: int) -> None:
    assert free(a, b, discs, first=first) == free(a, b, discs)


@settings(max_examples=80, deadline=None)
@given(PLACE, PLACE, DISCS, st.floats(0.01, 0.99))
def test_parts_of_a_free_segment_are_free(a: Point, b: Point, discs: list, share: float) -> None:
    middle = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
    shrunk = [(x, y, max(radius - 1e-9, 0.0)) for x, y, radius in discs]
    if free(a, b, discs):
        assert free(a, middle, shrunk) and free(middle, b, shrunk)


@settings(max_examples=80, deadline=None)
@given(PLACE, PLACE, DISCS, st.floats(0.0, 1.0))
def test_larger_discs_free_nothing(a: Point, b: Point, discs: list, more: float) -> None:
    if free(a, b, [(x, y, radius + more) for x, y, radius in discs]):
        assert free(a, b, discs)


@settings(max_examples=60, deadline=None)
@given(PLACE, PLACE)
def test_a_segment_stays_in_a_room_if_its_ends_do(a: Point, b: Point) -> None:
    walls = np.array([-4.0, -3.0, 4.0, 3.0])
    assert free(a, b, [], walls) == all(abs(x) <= 4.0 and abs(y) <= 3.0 for x, y in (a, b))


def test_touching_a_disc_is_not_free_and_the_blocker_is_remembered() -> None:
    blocker, discs = np.zeros(1, np.int64), np.array([(0.0, 9.0, 1.0), (0.0, 2.0, 1.0)])
    assert not segment_is_free(-3.0, 1.0, 3.0, 1.0, discs, NO_WALLS, blocker)
    assert blocker[0] == 1
    assert segment_is_free(-3.0, 1.0 - 1e-9, 3.0, 1.0 - 1e-9, discs, NO_WALLS, blocker)


def test_a_segment_of_no_length_is_a_point() -> None:
    assert free((1.0, 1.0), (1.0, 1.0), [(3.0, 1.0, 1.9)])
    assert not free((1.0, 1.0), (1.0, 1.0), [(3.0, 1.0, 2.1)])
