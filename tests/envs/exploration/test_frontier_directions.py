"""The compass of the edge: against a slow search, around corners, in sight, and that it turns with the robot."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.envs.exploration.frontier_directions import frontier_histogram, mean_direction
from lidarena.envs.exploration.state import RESOLUTION
from tests.envs.exploration.edge_search import UNKNOWN, WALL, Square, lengths_to_the_edge, squares_of

SECTORS = 36
SIDE = 2 * RESOLUTION
FREE = 0


def felt(
    grid: NDArray[np.int8],
    pose: tuple[float, float, float],
    origin: tuple[float, float] = (0.0, 0.0),
) -> NDArray[np.float32]:
    ranges = np.full((1, SECTORS), 3.5, np.float32)
    return frontier_histogram(grid[None], np.array([origin]), np.array([pose]), ranges, RESOLUTION)[0]


def way_lengths(grid: NDArray[np.int8], start: Square) -> dict[Square, int]:
    """Lengths of the shortest ways to the squares of the edge, in half squares."""
    squares = squares_of(grid)
    walls = np.argwhere(squares == WALL)

    def times(here: Square, there: Square) -> int:
        narrow = squares[there] == FREE and bool((np.abs(walls - there).max(axis=1) <= 2).any())
        return 3 if narrow else 1

    return lengths_to_the_edge(squares, start, times)


@pytest.mark.parametrize("seed", range(4))
def test_all_that_is_felt_is_what_ways_lead_to(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = rng.choice(np.array([UNKNOWN, FREE, WALL], np.int8), (10, 15), p=[0.06, 0.84, 0.1])
    cells[5, 7] = FREE
    grid = cells.repeat(2, axis=0).repeat(2, axis=1)
    lengths = np.array(sorted(way_lengths(grid, (5, 7)).values()))
    expected = np.exp(-0.5 * SIDE * (lengths - lengths[0]) / 2.0).sum() / 5.0
    sums = felt(grid, (-0.5 + 7.5 * SIDE, 0.25 + 5.5 * SIDE, 0.3), (-0.5, 0.25))
    assert sums.max() < 1.0, "an edge too large for comparing"
    assert sums.sum() == pytest.approx(expected, rel=1e-5)


def test_what_is_in_sight_is_felt_where_it_lies() -> None:
    for bearing in np.linspace(-3.0, 3.0, 25):
        grid = np.zeros((60, 60), np.int8)
        row, column = 2 * (np.array([15 + 10 * math.sin(bearing), 15 + 10 * math.cos(bearing)]).astype(int))
        grid[row : row + 2, column : column + 2] = UNKNOWN
        to = math.atan2((row + 1) * RESOLUTION - 1.5, (column + 1) * RESOLUTION - 1.5)
        assert np.flatnonzero(felt(grid, (1.5, 1.5, 0.0))).tolist() == [round(math.degrees(to) / 10) % SECTORS]


def test_what_is_known_all_around_or_closed_in_by_walls_is_not_felt() -> None:
    known = np.zeros((30, 30), np.int8)
    assert not felt(known, (0.7, 0.7, 0.0)).any()
    known[10:20, 10:20] = WALL
    known[12:18, 12:18] = UNKNOWN
    assert not felt(known, (0.2, 0.7, 0.0)).any()


def test_an_edge_behind_a_wall_is_felt_where_the_wall_ends() -> None:
    grid = np.zeros((80, 80), np.int8)
    grid[:64, 40:42] = WALL  # from y = 0 to y = 3.2 at x = 2
    grid[:20, 50:] = UNKNOWN  # straight ahead, behind the wall
    ranges = np.full((1, SECTORS), 3.5, np.float32)
    ranges[0, [0, 1, 2, 3, 4, 32, 33, 34, 35]] = 1.5  # the wall, as a lidar sees it
    sums = frontier_histogram(grid[None], np.zeros((1, 2)), np.array([[0.5, 0.5, 0.0]]), ranges, RESOLUTION)[0]
    assert set(np.flatnonzero(sums)) <= {5, 6, 7} and sums.max() == 1.0  # the end lies at atan2(2.7, 1.5) = 61 degrees


def test_the_nearest_edge_is_felt_however_far_and_turns_with_the_robot() -> None:
    grid = np.zeros((40, 1200), np.int8)
    grid[:, 1180:] = UNKNOWN  # 58 m away
    ahead = felt(grid, (1.0, 1.025, 0.0))
    assert ahead.max() > 0.9 and set(np.flatnonzero(ahead)) <= {34, 35, 0, 1, 2}
    for quarter in range(4):
        turned = felt(grid, (1.0, 1.025, quarter * np.pi / 2))
        np.testing.assert_allclose(turned, np.roll(ahead, -9 * quarter), atol=1e-6)


def test_worlds_do_not_depend_on_each_other() -> None:
    rng = np.random.default_rng(5)
    grids = rng.choice(np.array([UNKNOWN, FREE, WALL], np.int8), (7, 31, 45), p=[0.1, 0.8, 0.1])
    poses, origins = rng.uniform(0.2, 1.4, (7, 3)), rng.uniform(-0.1, 0.1, (7, 2))
    ranges = rng.uniform(0.1, 3.5, (7, SECTORS)).astype(np.float32)
    together = frontier_histogram(grids, origins, poses, ranges, RESOLUTION)
    for w in range(7):
        alone = frontier_histogram(
            grids[w : w + 1], origins[w : w + 1], poses[w : w + 1], ranges[w : w + 1], RESOLUTION
        )
        assert alone[0].tobytes() == together[w].tobytes()


def test_the_needle_points_where_the_edge_lies() -> None:
    for k in range(SECTORS):
        edge = np.zeros((1, SECTORS), np.float32)
        edge[0, k] = 0.3
        x, y = 2.0 * mean_direction(edge)[0] - 1.0
        assert math.hypot(x, y) == pytest.approx(1.0, abs=1e-6)
        assert math.cos(math.atan2(y, x) - 2.0 * math.pi * k / SECTORS) == pytest.approx(1.0, abs=1e-6)


def test_the_needle_is_the_mean_of_all_directions_and_rests_where_there_is_none() -> None:
    edge = np.zeros((3, SECTORS), np.float32)
    edge[0, [9, 27]] = 0.7  # left and right
    edge[1, [0, 9]] = 0.2, 0.6
    np.testing.assert_allclose(mean_direction(edge), [[0.5, 0.5], [0.625, 0.875], [0.5, 0.5]], atol=1e-6)
