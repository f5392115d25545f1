"""The bumper: collisions are told all around, whatever the lidar sees."""

import numpy as np
import pytest

from lidarena.envs.exploration.bumper import Bumper
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.robots import RobotSpec, make_robot
from lidarena.world.sensors import empty_sensors

ROOM = [(0, 0, 8, 0), (8, 0, 8, 8), (8, 8, 0, 8), (0, 8, 0, 0)]
PLAN = Floorplan.from_shapes("room", (0.0, 0.0, 8.0, 8.0), ROOM, thickness=0.1)
WALL = 0.05
"""x of the western wall's inner face [m]."""


def felt(spec: LidarSpec, robot: RobotSpec, away: float, heading: float) -> bool:
    """Whether a robot whose centre is ``away`` from the western wall feels it."""
    lidar = Lidar([PLAN], spec)
    bumper, sensors = Bumper(1, lidar, robot, 0.2), empty_sensors(1, spec.beams)
    poses = np.array([[[WALL + away, 4.0, heading]]])
    bumper.feel(poses, np.zeros(1, np.int64), sensors, 0, 1)
    return bool(sensors.collision[0])


@pytest.mark.parametrize("heading", [0.0, 1.0, 3.0])
def test_a_lidar_that_looks_ahead_leaves_no_blind_side(heading: float) -> None:
    ahead = LidarSpec(beams=90, field_of_view=np.pi / 2)
    robot = RobotSpec()
    assert felt(ahead, robot, robot.bumper - 0.01, heading)
    assert not felt(ahead, robot, robot.bumper + 0.02, heading)


def test_an_outline_is_felt_where_it_reaches() -> None:
    long = make_robot({"outline": ((0.4, 0.1), (-0.4, 0.1), (-0.4, -0.1), (0.4, -0.1))}, RobotSpec())
    assert felt(LidarSpec(), long, 0.3, 0.0)  # its back stands in the wall
    assert not felt(LidarSpec(), long, 0.3, np.pi / 2)  # its side does not


def test_a_lidar_all_around_is_the_bumper_itself() -> None:
    lidar = Lidar([PLAN], LidarSpec())
    bumper, sensors = Bumper(1, lidar, RobotSpec(), 0.2), empty_sensors(1, 360)
    assert bumper.ranges(sensors) is sensors.ranges and bumper.directions is lidar.directions
