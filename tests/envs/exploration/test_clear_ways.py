"""Ways that keep clear: against a slow search, through gaps wide and narrow, in sight, and turning with the robot."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.envs.exploration.clear_ways import clear_ways
from lidarena.envs.exploration.state import RESOLUTION
from tests.envs.exploration.edge_search import UNKNOWN, WALL, Square, lengths_to_the_edge, squares_of

SECTORS, CONTACT, RADIUS = 36, 0.12, 1.0 / 6.0
ROBOT = (CONTACT, RADIUS)
SIDE = 2 * RESOLUTION
FREE = 0
Pose = tuple[float, float, float]


def told(grid: NDArray[np.int8], pose: Pose, origin: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.float32]:
    return clear_ways(grid[None], np.array([origin]), np.array([pose]), SECTORS, ROBOT, RESOLUTION)[0]


def bearing(ways: NDArray[np.float32]) -> float:
    return math.degrees(math.atan2(ways[SECTORS + 1] - 0.5, ways[SECTORS] - 0.5))


def way_lengths(grid: NDArray[np.int8], start: Square) -> dict[Square, int]:
    """Lengths of the shortest clear ways to the squares of the edge, in half squares."""
    squares = squares_of(grid)
    walls = (np.argwhere(grid == WALL) + 0.5) * RESOLUTION

    def room(square: Square) -> float:
        middle = (np.array(square) + 0.5) * SIDE
        near = np.abs(walls - middle).max(axis=1) < 4.5 * SIDE
        return float(np.hypot(*(walls[near] - middle).T).min()) if near.any() else math.inf

    rooms = {square: room(square) for square in np.ndindex(squares.shape)}

    def times(here: Square, there: Square) -> int | None:
        if squares[there] == UNKNOWN and rooms[there] < CONTACT + RADIUS:
            return None
        if rooms[there] < CONTACT + 0.07 <= rooms[here]:
            return None
        return next((n for n, more in ((1, 0.23), (2, 0.15), (4, 0.07)) if rooms[there] >= CONTACT + more), 8)

    return lengths_to_the_edge(squares, start, times)


@pytest.mark.parametrize("seed", range(5))
def test_all_that_is_told_is_what_clear_ways_lead_to(seed: int) -> None:
    rng = np.random.default_rng(seed)
    grid = np.zeros((36, 44), np.int8)
    for _ in range(5):
        r, c = int(rng.integers(36)), int(rng.integers(44))
        grid[r : r + 2, c : c + 1] = WALL
    squares = rng.random((18, 22)) < 0.03
    grid[squares.repeat(2, axis=0).repeat(2, axis=1) & (grid == FREE)] = UNKNOWN
    grid[18:20, 20:22] = FREE
    lengths = np.array(sorted(way_lengths(grid, (9, 10)).values()))
    assert len(lengths)
    further = 0.5 * SIDE * (lengths - lengths[0])
    expected = np.exp(-further / 2.0).sum() / 5.0
    ways = told(grid, (-0.5 + 10.5 * SIDE, 0.25 + 9.5 * SIDE, 0.3), (-0.5, 0.25))
    assert ways[:SECTORS].max() < 1.0, "an edge too large for comparing"
    assert ways[:SECTORS].sum() == pytest.approx(expected, rel=1e-4)
    assert ways[SECTORS + 2] == pytest.approx(math.exp(-0.5 * SIDE * lengths[0] / 4.0), rel=1e-4)


def test_what_is_in_sight_is_told_where_it_lies() -> None:
    for direction in np.linspace(-3.0, 3.0, 25):
        grid = np.zeros((60, 60), np.int8)
        row, column = 2 * (np.array([15 + 10 * math.sin(direction), 15 + 10 * math.cos(direction)]).astype(int))
        grid[row : row + 2, column : column + 2] = UNKNOWN
        to = math.atan2((row + 1) * RESOLUTION - 1.5, (column + 1) * RESOLUTION - 1.5)
        ways = told(grid, (1.5, 1.5, 0.0))
        assert np.flatnonzero(ways[:SECTORS]).tolist() == [round(math.degrees(to) / 10) % SECTORS]
        assert bearing(ways) == pytest.approx(math.degrees(to), abs=1e-3)


def test_nothing_is_told_of_what_is_known_or_closed_in() -> None:
    known = np.zeros((30, 30), np.int8)
    nothing = [*np.zeros(SECTORS), 0.5, 0.5, 0.0]
    assert told(known, (0.7, 0.7, 0.0)).tolist() == nothing
    known[10:20, 10:20] = WALL
    known[12:18, 12:18] = UNKNOWN
    assert told(known, (0.2, 0.7, 0.0)).tolist() == nothing


@pytest.mark.parametrize(("gap", "through"), [(6, False), (14, True)])
def test_a_way_leads_through_a_gap_only_if_it_is_wide_enough(gap: int, through: bool) -> None:
    grid = np.zeros((80, 80), np.int8)
    grid[:, 40:42] = WALL
    grid[40 - gap // 2 : 40 + gap // 2, 40:42] = FREE
    grid[:, 60:] = UNKNOWN
    assert bool(told(grid, (1.0, 2.0, 0.0))[:SECTORS].any()) == through


def test_a_way_through_the_legs_of_a_chair_leads_around_it() -> None:
    grid = np.zeros((60, 100), np.int8)
    for row in (26, 34):
        for column in (46, 54):
            grid[row, column] = WALL  # 40 cm apart, between the robot and the edge
    grid[26:34, 92:] = UNKNOWN
    ways = told(grid, (1.0, 1.5, 0.0))
    assert ways[:SECTORS].any() and 5.0 < abs(bearing(ways)) < 45.0


def test_a_robot_that_has_come_too_near_to_something_is_led_away_from_it() -> None:
    grid = np.zeros((60, 60), np.int8)
    grid[:, :2] = WALL
    grid[20:40, 50:] = UNKNOWN
    ways = told(grid, (0.22, 1.5, 0.0))
    assert ways[:SECTORS].any() and abs(bearing(ways)) < 20.0


def test_the_nearest_edge_is_told_however_far_and_turns_with_the_robot() -> None:
    grid = np.zeros((40, 1200), np.int8)
    grid[:, 1180:] = UNKNOWN
    ahead = told(grid, (1.0, 1.025, 0.0))
    assert ahead[:SECTORS].max() > 0.9 and set(np.flatnonzero(ahead[:SECTORS])) <= {34, 35, 0, 1, 2}
    for quarter in range(4):
        turned = told(grid, (1.0, 1.025, quarter * np.pi / 2))
        np.testing.assert_allclose(turned[:SECTORS], np.roll(ahead[:SECTORS], -9 * quarter), atol=1e-6)


def test_worlds_do_not_depend_on_each_other() -> None:
    rng = np.random.default_rng(5)
    grids = rng.choice(np.array([UNKNOWN, FREE, WALL], np.int8), (7, 51, 65), p=[0.04, 0.945, 0.015])
    poses, origins = rng.uniform(0.2, 2.4, (7, 3)), rng.uniform(-0.1, 0.1, (7, 2))
    together = clear_ways(grids, origins, poses, SECTORS, ROBOT, RESOLUTION)
    for w in range(7):
        alone = clear_ways(grids[w : w + 1], origins[w : w + 1], poses[w : w + 1], SECTORS, ROBOT, RESOLUTION)
        assert alone[0].tobytes() == together[w].tobytes()
