"""The lidar of the unknown: against a slow definition, and that it turns with the robot."""

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration_core import RESOLUTION
from lidarena.envs.frontier_compass import feel_frontiers

SECTORS = 36


def felt(grid: NDArray[np.int8], pose: tuple[float, float, float], origin: tuple[float, float]) -> NDArray[np.float32]:
    out = np.full((1, SECTORS), 9.0, np.float32)
    feel_frontiers(grid[None], np.array([origin]), np.array([pose]), RESOLUTION, out)
    return out[0]


def by_definition(
    grid: NDArray[np.int8], pose: tuple[float, float, float], origin: tuple[float, float]
) -> NDArray[np.float64]:
    sums = np.zeros(SECTORS)
    for row, column in np.argwhere(grid == -1):
        beside = [(row - 1, column), (row + 1, column), (row, column - 1), (row, column + 1)]
        inside = 0 < row < grid.shape[0] - 1 and 0 < column < grid.shape[1] - 1
        if not inside or not any(grid[cell] == 0 for cell in beside):
            continue
        away = np.array(origin) + RESOLUTION * (np.array([column, row]) + 0.5) - pose[:2]
        bearing = np.degrees(np.arctan2(away[1], away[0]) - pose[2])
        sums[int(np.round(bearing / 10.0)) % SECTORS] += np.exp(-np.hypot(*away) / 2.0)
    return np.minimum(sums / 10.0, 1.0)


def a_map(seed: int) -> NDArray[np.int8]:
    rng = np.random.default_rng(seed)
    return rng.choice(np.array([-1, 0, 100], np.int8), (40, 60), p=[0.1, 0.8, 0.1])


def test_the_sum_is_its_definition() -> None:
    for seed in range(5):
        pose = (1.1 + 0.3 * seed, 0.9, 0.7 * seed - 2.0)
        expected = by_definition(a_map(seed), pose, (-0.5, 0.25))
        np.testing.assert_allclose(felt(a_map(seed), pose, (-0.5, 0.25)), expected, atol=1e-5)


def test_what_is_known_all_around_or_closed_in_by_walls_is_not_felt() -> None:
    known = np.zeros((30, 30), np.int8)
    assert not felt(known, (0.7, 0.7, 0.0), (0, 0)).any()
    known[10:20, 10:20] = 100
    known[12:18, 12:18] = -1
    assert not felt(known, (0.2, 0.7, 0.0), (0, 0)).any()


def test_an_edge_ahead_is_felt_ahead_and_turns_with_the_robot() -> None:
    grid = np.zeros((41, 80), np.int8)
    grid[:, 60:] = -1
    ahead = felt(grid, (1.0, 1.025, 0.0), (0, 0))
    assert np.flatnonzero(ahead).tolist() == [0, 1, 2, 3, 33, 34, 35] and ahead[:2].min() > 0.05
    for quarter in range(4):
        turned = felt(grid, (1.0, 1.025, quarter * np.pi / 2), (0, 0))
        np.testing.assert_allclose(turned, np.roll(ahead, -9 * quarter), atol=1e-6)
