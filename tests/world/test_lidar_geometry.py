"""The lidar in rooms whose ranges can be written down, and what turning and moving must not change."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec

WIDTH, HEIGHT, BEAMS = 6.0, 4.0, 72
FACES = 0.05  # half of a wall's thickness
HALL = Floorplan.from_shapes(
    "hall", (0, 0, 6, 4), walls=[(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)], start=(3, 2, 0)
)
PILLARS = [(2.0, 1.0, 0.4), (4.5, 2.8, 0.3), (1.2, 3.0, 0.15)]
COLONNADE = Floorplan.from_shapes("colonnade", (0, 0, 6, 4), circles=PILLARS, start=(3, 2, 0))
X, Y, TURN = st.floats(0.1, WIDTH - 0.1), st.floats(0.1, HEIGHT - 0.1), st.floats(-math.pi, math.pi)


def cast(plan: Floorplan, x: float, y: float, theta: float, spec: LidarSpec | None = None) -> np.ndarray:
    lidar = Lidar([plan], spec or LidarSpec(BEAMS))
    return lidar.cast(np.array([[[x, y, theta]]]), np.zeros(1, np.int64))[0, 0]


def to_wall(x: float, y: float, angle: float) -> float:
    """To the inner face that a ray from within the hall meets."""
    dx, dy = math.cos(angle), math.sin(angle)
    across = ((WIDTH - FACES if dx > 0 else FACES) - x) / dx if abs(dx) > 1e-12 else math.inf
    along = ((HEIGHT - FACES if dy > 0 else FACES) - y) / dy if abs(dy) > 1e-12 else math.inf
    return min(across, along, 3.5)


def to_pillar(x: float, y: float, angle: float) -> float:
    """To the nearest pillar, by the quadratic equation."""
    reach = 3.5
    for cx, cy, radius in PILLARS:
        along = (cx - x) * math.cos(angle) + (cy - y) * math.sin(angle)
        square = radius**2 - ((cx - x) ** 2 + (cy - y) ** 2 - along**2)
        if square >= 0 and along > 0:
            reach = min(reach, along - math.sqrt(square))
    return reach


@settings(max_examples=60, deadline=None)
@given(X, Y, TURN)
def test_in_a_hall_every_range_is_the_walls(x: float, y: float, theta: float) -> None:
    expected = [to_wall(x, y, theta + k * 2 * math.pi / BEAMS) for k in range(BEAMS)]
    np.testing.assert_allclose(cast(HALL, x, y, theta), expected, atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(X, Y, TURN)
def test_among_pillars_every_range_solves_the_quadratic_equation(x: float, y: float, theta: float) -> None:
    if min(math.dist((x, y), (cx, cy)) - radius for cx, cy, radius in PILLARS) < 0.02:
        return
    found = cast(COLONNADE, x, y, theta)
    expected = np.array([to_pillar(x, y, theta + k * 2 * math.pi / BEAMS) for k in range(BEAMS)])
    grazing = np.abs(found - expected) > 1e-6  # a beam along a pillar's rim may see it or not
    assert grazing.sum() <= 2
    for k in np.flatnonzero(grazing):
        angle = theta + k * 2 * math.pi / BEAMS
        misses = [
            abs(abs((cx - x) * math.sin(angle) - (cy - y) * math.cos(angle)) - radius) for cx, cy, radius in PILLARS
        ]
        assert min(misses) < 1e-6


@settings(max_examples=30, deadline=None)
@given(X, Y, st.integers(0, BEAMS - 1))
def test_turning_by_a_beam_shifts_the_scan_by_one(x: float, y: float, steps: int) -> None:
    turned = cast(HALL, x, y, steps * 2 * math.pi / BEAMS)
    np.testing.assert_allclose(turned, np.roll(cast(HALL, x, y, 0.0), -steps), atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(X, Y, TURN, st.floats(-900.0, 900.0), st.floats(-900.0, 900.0))
def test_a_world_may_lie_anywhere(x: float, y: float, theta: float, east: float, north: float) -> None:
    shift = np.array([east, north, east, north])
    walls = np.array([(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)]) + shift
    bounds = tuple(np.array([0, 0, 6, 4]) + shift)
    moved = Floorplan.from_shapes("moved", bounds, walls=walls, start=(3 + east, 2 + north, 0))  # type: ignore[arg-type]
    np.testing.assert_allclose(cast(moved, x + east, y + north, theta), cast(HALL, x, y, theta), atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(X, Y, TURN, st.floats(0.3, 3.4))
def test_a_shorter_range_only_cuts_off(x: float, y: float, theta: float, reach: float) -> None:
    short = cast(HALL, x, y, theta, LidarSpec(BEAMS, reach))
    np.testing.assert_allclose(short, np.minimum(cast(HALL, x, y, theta), reach), atol=1e-9)


@pytest.mark.parametrize("beams", [1, 4, 36, 180])
def test_fewer_beams_are_some_of_many(beams: int) -> None:
    many = cast(HALL, 1.3, 2.2, 0.4, LidarSpec(360))
    np.testing.assert_allclose(cast(HALL, 1.3, 2.2, 0.4, LidarSpec(beams)), many[:: 360 // beams], atol=1e-9)
