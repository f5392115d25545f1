"""The bumper around an exploration robot: what its collisions are told by, and whether it may touch something."""

import numpy as np
from numpy.typing import NDArray

from lidarena.world.lidar import NO_OUTLINE, Lidar, LidarSpec, cast_beams
from lidarena.world.robots import RobotSpec
from lidarena.world.sensors import Sensors

_BEAMS = 360
_ROOM = 0.1
"""Beams of the bumper are so much longer than what they are to tell [m]."""


class Bumper:
    """Exact ranges all around robots, whatever their lidars see.

    A lidar that sees all around with a beam a degree is taken as it is, as DA-SLAM does; for any other one, and for a
    robot with an outline, beams of the bumper's own are cast.

    Args:
        worlds: Number of worlds, one robot each.
        lidar: The robots' own.
        robot: The robots.
        period: Of the decisions [s].
    """

    def __init__(self, worlds: int, lidar: Lidar, robot: RobotSpec, period: float) -> None:
        self._lidar = lidar
        self._own: LidarSpec | None = None
        if robot.outline or not lidar.spec.sees_all_around or lidar.spec.beams < _BEAMS:
            reach = min(robot.bumper + robot.max_speed * period + _ROOM, lidar.spec.max_range)
            self._own = LidarSpec(_BEAMS, reach, 0.0)
            self._ranges = np.full((worlds, 1, _BEAMS), reach)
            self._limits = robot.bumpers(self._own.angles)
        self.directions = lidar.directions if self._own is None else self._own.directions

    def ranges(self, sensors: Sensors) -> NDArray[np.float64]:
        """Exact ranges (worlds, 1, beams) along ``directions`` (2, beams) [m]."""
        return sensors.ranges if self._own is None else self._ranges

    def feel(
        self, poses: NDArray[np.float64], plan: NDArray[np.int64], sensors: Sensors, first: int, last: int
    ) -> None:
        """Tell the collisions of worlds first … last - 1 where ``sensors`` cannot.

        Args:
            poses: (worlds, 1, 3) of the robots.
            plan: (worlds,) index of each world's floor plan.
            sensors: Whose ``collision`` is written.
            first: World.
            last: World after the last.
        """
        if self._own is None:
            return
        geometry = self._lidar.geometry
        cast_beams(first, last, poses, plan, 0.0, NO_OUTLINE, geometry, self.directions, self._own, self._ranges)
        sensors.collision[first:last] = (self._ranges[first:last, 0] < self._limits).any(axis=1)
