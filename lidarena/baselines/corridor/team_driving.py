"""Driving a team along planned paths: by the clock, or in the plan's order."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.corridor.robot_interface import FleetState
from lidarena.envs.corridor.options import ROBOT
from lidarena.planning.team.precedence import Precedence
from lidarena.world.robots import RobotSpec

Floats = NDArray[np.float64]

_RESPONSE = 0.6  # a robot makes up for its distance to the target in so many seconds
_TURN_GAIN = 3.0  # turn rate for a bearing (1/s)
_TURN_FIRST = 0.9  # with a larger bearing it turns on the spot (rad)
_STILL = 0.02  # nearer than this to its target it rests (m)


def steer_to(pose: Floats, target: Floats, robot: RobotSpec = ROBOT) -> tuple[float, float]:
    """Return the speed [m/s] and turn rate [rad/s] that take a robot at a pose (3,) to a point (2,) nearby."""
    dx, dy = target[0] - pose[0], target[1] - pose[1]
    away = math.hypot(dx, dy)
    if away < _STILL:
        return 0.0, 0.0
    bearing = math.remainder(math.atan2(dy, dx) - pose[2], 2.0 * math.pi)
    rate = min(max(_TURN_GAIN * bearing, -robot.max_turn_rate), robot.max_turn_rate)
    if abs(bearing) > _TURN_FIRST:
        return 0.0, rate
    return min(away / _RESPONSE, robot.max_speed) * math.cos(bearing), rate


class ClockDriving:
    """Every robot is where its path says that it should be at that time, as nearly as it can.

    Args:
        curves: (T, 2) points of each robot, one a step of the plan [m].
        step: How long a step takes [s].
    """

    def __init__(self, curves: list[Floats], step: float) -> None:
        self.curves, self.step = curves, step

    def planned(self, robot: int, time: float) -> Floats:
        """Where a robot should be (2,) [m]."""
        curve = self.curves[robot]
        at = min(time / self.step, len(curve) - 1.0)
        low = min(int(at), len(curve) - 2) if len(curve) > 1 else 0
        share = at - low
        point: Floats = (1.0 - share) * curve[low] + share * curve[min(low + 1, len(curve) - 1)]
        return point

    def commands(self, state: FleetState) -> Floats:
        """Commands (k, 2) that take every robot to where it should be a moment later."""
        targets = [self.planned(robot, state.time + _RESPONSE) for robot in range(len(self.curves))]
        return np.array([steer_to(pose, target) for pose, target in zip(state.poses, targets, strict=True)])

    def remaining(self, robot: int, state: FleetState) -> Floats:
        """The points (n, 2) that a robot still has to pass."""
        return self.curves[robot][min(int(state.time / self.step), len(self.curves[robot]) - 1) :]


_LOOK = 0.35  # how far ahead on its path a robot aims (m)
_PASSED = 0.08  # nearer than this to a point of its path it has completed the step there (m)
_GAP = 0.06  # robots that would come nearer than this to each other stop (m)
_FORESIGHT = 0.3  # within so many seconds


class OrderedDriving:
    """Every robot drives its path as fast as it can, but never begins a step before those who are to pass there first.

    Args:
        curves: (T, 2) points of each robot, one a step of the plan [m].
        precedence: The plan's order.
        radius: Of the robots [m].

    Attributes:
        completed: (k,) steps that each robot has completed.
        waits: Pairs (i, j) at the last call of ``commands``: robot i waited for robot j.
    """

    def __init__(self, curves: list[Floats], precedence: Precedence, radius: float) -> None:
        self.curves, self._precedence, self._apart = curves, precedence, 2.0 * radius + _GAP
        self.completed = np.zeros(len(curves), np.int64)
        self.waits: tuple[tuple[int, int], ...] = ()

    def note(self, state: FleetState) -> None:
        """Note how far every robot has come."""
        for robot, curve in enumerate(self.curves):
            position = state.poses[robot, :2]
            if state.arrived[robot]:
                self.completed[robot] = len(curve) - 1
            while self.completed[robot] < len(curve) - 1 and self._may_begin(robot, int(self.completed[robot])):
                here, there = curve[self.completed[robot]], curve[self.completed[robot] + 1]
                along, length = there - here, float(np.hypot(*(there - here)))
                passed = length > 0 and float((position - here) @ along) / length > length - 0.3 * _PASSED
                aside = abs(float(along[0] * (position - here)[1] - along[1] * (position - here)[0]))
                if not (np.hypot(*(position - there)) < _PASSED or (passed and aside < length * 2 * _PASSED)):
                    break
                self.completed[robot] += 1
            target, _ = self._target(robot)
            if np.hypot(*(position - curve[target])) < _PASSED:  # it cut a corner, or need not step aside any more
                self.completed[robot] = target

    def _may_begin(self, robot: int, step: int) -> bool:
        return not len(self._precedence.blocking_agents(robot, step, self.completed))

    def commands(self, state: FleetState) -> Floats:
        """Commands (k, 2) towards the farthest point nearby that each robot may go to."""
        waits: list[tuple[int, int]] = []
        commands = np.zeros((len(self.curves), 2))
        for robot in np.flatnonzero(state.active).tolist():
            target, blocking_agents = self._target(robot)
            speed, rate = steer_to(state.poses[robot], self.curves[robot][target])
            ahead = self._in_the_way(robot, speed, state)
            commands[robot] = (0.0 if ahead else speed), rate
            waits += [(robot, int(other)) for other in {*blocking_agents, *ahead}]
        self.waits = tuple(waits)
        return commands

    def _in_the_way(self, robot: int, speed: float, state: FleetState) -> list[int]:
        """Robots that one is about to touch, whatever the plan says."""
        x, y, theta = state.poses[robot]
        soon = np.array([x + speed * _FORESIGHT * math.cos(theta), y + speed * _FORESIGHT * math.sin(theta)])
        now, then = (np.hypot(*(state.poses[:, :2] - point).T) for point in (state.poses[robot, :2], soon))
        near = (then < self._apart) & (then < now)
        near[robot] = False
        return [int(other) for other in np.flatnonzero(near)]

    def _target(self, robot: int) -> tuple[int, NDArray[np.int64]]:
        """The point of its path at which a robot aims, and for whom it waits there, if it may go no farther."""
        curve, step = self.curves[robot], int(self.completed[robot])
        travelled, nobody = 0.0, np.empty(0, np.int64)
        while step < len(curve) - 1 and travelled < _LOOK:
            blocking_agents = self._precedence.blocking_agents(robot, step, self.completed)
            if len(blocking_agents):
                return step, blocking_agents
            travelled += float(np.hypot(*(curve[step + 1] - curve[step])))
            step += 1
        return step, nobody

    def remaining(self, robot: int) -> Floats:
        """The points (n, 2) that a robot still has to pass."""
        return self.curves[robot][int(self.completed[robot]) :]
