from typing import Any

import numpy as np
import pytest

from lidarena.baselines.arena.seen_obstacles import SeenObstacles, hits_of, nearest_of_each
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
    assert seen.points().shape == (0, 2)
    assert seen.add(np.array([[0.1, 0.1], [0.2, 0.2], [3.0, 4.0]]))
    assert not seen.add(np.array([[0.3, 0.1], [3.1, 4.2]]))
    assert seen.points().tolist() == [[0.1, 0.1], [3.0, 4.0]]
    assert seen.add(np.array([[-0.1, 0.1]]))
