from typing import Any

import numpy as np
import pytest

from lidarena.baselines.arena.seen_obstacles import SeenObstacles, hidden_beside, hits_of, nearest_of_each
from lidarena.envs import ArenaEnv
from lidarena.world.arenas import Arena
from lidarena.world.lidar import LidarSpec

LIDAR = LidarSpec(72, 30.0, 0.0)
ROOM = (0.0, 0.0, 100.0, 100.0)


def scan_of(circles: list[list[float]], beams: int = 72) -> dict[str, Any]:
    """What a robot in the middle of the room sees."""
    arena = Arena("test", np.array(circles, float).reshape(-1, 3), (50.0, 50.0), (90.0, 50.0), ROOM, 1.0)
    return ArenaEnv(arena=arena, lidar={"beams": beams}).reset(seed=0)[1]


def test_hits_lie_on_the_obstacles() -> None:
    info = scan_of([[60, 50, 3], [50, 40, 2]])
    points, beams = hits_of(info, LIDAR)
    assert len(points) == len(beams) > 5
    gaps = [min(abs(np.hypot(x - 60, y - 50) - 3), abs(np.hypot(x - 50, y - 40) - 2)) for x, y in points]
    assert max(gaps) < 1e-4


def test_the_nearest_hit_stands_for_each_obstacle() -> None:
    points = nearest_of_each(scan_of([[60, 50, 3], [50, 40, 2], [35, 50, 4]]), LIDAR)
    found = sorted((round(float(x), 2), round(float(y), 2)) for x, y in points)
    assert found == [(39.0, 50.0), (50.0, 42.0), (57.0, 50.0)]


def test_an_obstacle_across_the_first_beam_counts_once() -> None:
    assert nearest_of_each(scan_of([[58, 50, 4]]), LIDAR) == pytest.approx(np.array([[54.0, 50.0]]), abs=1e-5)


def test_two_obstacles_behind_each_other_count_twice() -> None:
    points = nearest_of_each(scan_of([[56, 50, 2], [66, 55, 5]]), LIDAR)
    assert len(points) == 2


def test_nothing_seen_is_no_point() -> None:
    info = scan_of([])
    assert hits_of(info, LIDAR)[0].shape == (0, 2) and nearest_of_each(info, LIDAR).shape == (0, 2)


def test_memory_keeps_one_point_in_a_cell_and_tells_new_ones() -> None:
    seen = SeenObstacles(0.5)
    assert seen.hits().shape == (0, 3)
    assert seen.add(np.array([[0.1, 0.1], [0.2, 0.2], [3.0, 4.0]]), np.array([0.3, 0.4, 0.5]))
    assert not seen.add(np.array([[0.3, 0.1], [3.1, 4.2]]), np.array([0.3, 0.6]))
    assert seen.hits().tolist() == [[0.1, 0.1, 0.3], [3.0, 4.0, 0.5]]
    assert seen.add(np.array([[-0.1, 0.1]]), np.array([0.1]))


def test_memory_prefers_the_point_beside_which_the_least_is_hidden() -> None:
    seen = SeenObstacles(0.5)
    seen.add(np.array([[0.1, 0.1]]), np.array([0.3]))
    seen.add(np.array([[0.4, 0.3]]), np.array([0.2]))
    assert seen.hits().tolist() == [[0.4, 0.3, 0.2]]


def test_all_of_an_obstacle_is_within_what_may_be_hidden_beside_its_hits() -> None:
    info = scan_of([[60, 50, 3], [50, 40, 2], [35, 50, 4], [53, 52, 0.7]], beams=36)
    lidar = LidarSpec(36, 30.0, 0.0)
    points, hidden = hits_of(info, lidar)[0], hidden_beside(info, lidar)
    assert len(points) == len(hidden) and (hidden > 0).all()
    for x, y, radius in ([60, 50, 3], [50, 40, 2], [35, 50, 4], [53, 52, 0.7]):
        facing = np.arctan2(50 - y, 50 - x) + np.linspace(-0.9, 0.9, 81)  # what faces the robot
        surface = np.array([x, y]) + radius * np.column_stack([np.cos(facing), np.sin(facing)])
        away = np.hypot(*(surface[:, None] - points).transpose(2, 0, 1)) - 1.05 * hidden
        assert away.min(axis=1).max() < 0.05 * radius


def test_between_hits_of_one_surface_half_the_way_is_hidden_and_beyond_its_end_a_beam_s_width() -> None:
    info = scan_of([[60, 50, 3]])
    hidden, points = hidden_beside(info, LIDAR), hits_of(info, LIDAR)[0]
    away, increment = np.hypot(*(points - 50).T), 2 * np.pi / 72
    order = np.argsort(points[:, 1])
    ends, middle = order[[0, -1]], order[len(order) // 2]
    assert hidden[ends] == pytest.approx(away[ends] * increment)
    assert hidden[middle] == pytest.approx(0.5 * away[middle] * increment, rel=0.1)
