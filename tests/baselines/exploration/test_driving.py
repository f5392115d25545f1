"""What the beams have hit counts, whatever the map says."""

import numpy as np

from lidarena.baselines.exploration.driving import Driver
from lidarena.baselines.exploration.robot_interface import Robot
from tests.baselines.exploration.fake_exploration import FakeExploration, drawn


def driver() -> Driver:
    return Driver(Robot(FakeExploration(drawn("###", "# #", "###", side=40), (1.0, 1.0, 0.0))))


def world() -> dict:
    free = np.zeros((60, 60), np.int8)
    return {"map": free, "pose": np.array([1.5, 1.5, 0.0]), "resolution": 0.05, "origin": np.zeros(2)}


def beams(front: float) -> np.ndarray:
    return np.array([front / 3.5, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0], np.float32)


def is_closed(drive: Driver, x: float, y: float) -> bool:
    terrain = drive.survey()
    assert terrain is not None
    return bool(terrain.around.closed[terrain.around.cell(x, y)])


def test_a_hit_nearby_is_an_obstacle_for_two_seconds() -> None:
    drive, info = driver(), world()
    drive.sense(beams(0.42), info)
    assert is_closed(drive, 1.92, 1.5)
    for _ in range(9):
        drive.sense(beams(3.5), info)
    assert is_closed(drive, 1.92, 1.5)
    drive.sense(beams(3.5), info)
    assert not is_closed(drive, 1.92, 1.5)


def test_hits_far_away_are_left_to_the_map_and_the_map_itself_unchanged() -> None:
    drive, info = driver(), world()
    drive.sense(beams(0.8), info)
    assert not is_closed(drive, 2.3, 1.5)
    drive.sense(beams(0.42), info)
    assert not info["map"].any()


def test_reset_forgets_hits() -> None:
    drive, info = driver(), world()
    drive.sense(beams(0.42), info)
    drive.reset()
    drive.sense(beams(3.5), info)
    assert not is_closed(drive, 1.92, 1.5)
