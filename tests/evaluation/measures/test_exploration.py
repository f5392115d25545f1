"""Intersection over union of the mapped walls."""

import numpy as np
import pytest

from lidarena.envs.exploration.coverage import measure_coverage
from lidarena.evaluation.measures.exploration import map_iou
from lidarena.world.floorplan import Floorplan
from lidarena.world.robots import RobotSpec

ROOM = Floorplan.from_shapes(
    "room", (0, 0, 4, 3), walls=[(0, 0, 4, 0), (4, 0, 4, 3), (4, 3, 0, 3), (0, 3, 0, 0)], start=(1.0, 1.0, 0.0)
)
COVERAGE = measure_coverage(ROOM, 0.05, RobotSpec())


def perfect() -> np.ndarray:
    solid = ROOM.raster(0.05).solid
    return np.where(COVERAGE.wanted & solid, 100, np.where(COVERAGE.wanted, 0, -1)).astype(np.int8)


def test_the_true_map_is_perfect_also_a_cell_off() -> None:
    assert map_iou(ROOM, perfect(), COVERAGE.origin, 0.05) == 1.0
    assert map_iou(ROOM, perfect(), COVERAGE.origin + 0.05, 0.05) > 0.98
    assert map_iou(ROOM, perfect(), COVERAGE.origin + 0.15, 0.05) < 0.1


def test_missed_and_invented_walls_count_against_it() -> None:
    half = perfect()
    half[:, half.shape[1] // 2 :] = -1
    assert map_iou(ROOM, half, COVERAGE.origin, 0.05) == pytest.approx(0.5, abs=0.05)
    more = perfect()
    walls = int((more == 100).sum())
    row, columns = more.shape[0] // 2, slice(20, 40)
    more[row, columns] = 100
    assert map_iou(ROOM, more, COVERAGE.origin, 0.05) == pytest.approx(walls / (walls + 20))
    assert map_iou(ROOM, np.full_like(more, -1), COVERAGE.origin, 0.05) == 0.0


def test_a_larger_grid_changes_nothing() -> None:
    larger = np.pad(perfect(), 7, constant_values=-1)
    assert map_iou(ROOM, larger, COVERAGE.origin - 7 * 0.05, 0.05) == 1.0
