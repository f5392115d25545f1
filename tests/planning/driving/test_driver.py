import numpy as np

from lidarena.baselines.exploration.driving import Driver
from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.planning.driving import driver as compiled
from lidarena.planning.driving.following import next_command
from lidarena.planning.driving.survey import survey
from tests.planning.driving.worlds import hired, make_world, perceived


def test_a_drive_to_a_place_is_that_of_the_plain_driver() -> None:
    env, info = make_world(7, map="env1", observation="map", start=None)
    plain = Driver(Robot(env))
    settings, _, explorers = hired(env, info)
    drive, goal, driven = explorers.drive, None, 0
    observation = {"scan": info["scan"] / 3.5}
    for step in range(120):
        told = perceived(info)
        plain.sense(observation, info)
        compiled.sense(0, told, settings, drive)
        assert plain.must_plan == compiled.must_plan(0, told, settings, drive)
        assert plain.is_cornered == compiled.is_cornered(0, told, settings, drive)
        if step % 5 == 0:
            terrain = plain.survey()
            assert terrain is not None and survey(0, told, settings, drive)
            rows, columns = drive.ground.extent[0, 2:].tolist()
            assert np.array_equal(drive.ground.cost[0, : rows * columns].reshape(rows, columns), terrain.cost)
            assert np.array_equal(drive.ground.reachable[0, : rows * columns].reshape(rows, columns), terrain.reachable)
            if goal is None or step % 40 == 0:
                cells = np.argwhere(terrain.reachable)
                goal = tuple(terrain.around.points(cells[len(cells) * (step + 30) // 160 :][:1])[0].tolist())
            assert plain.go(goal, terrain) == compiled.go(0, *goal, told, settings, drive)
        action = plain.action()
        assert action == next_command(0, told, settings, drive)
        observation, _, ended, _, info = env.step(action)
        driven += 1
        assert not ended
    assert driven == 120
