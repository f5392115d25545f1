"""Driving a team along planned paths: by the clock, or in the plan's order."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.corridor.robot_interface import FleetState
from lidarena.envs.corridor.options import ROBOT
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.precedence import Precedence
from lidarena.world.robots import RobotSpec

Floats = NDArray[np.float64]

_RESPONSE = 0.6  # a robot makes up for its distance to the target in so many seconds
_TURN_GAIN = 3.0  # turn rate for a bearing (1/s)
_TURN_FIRST = 0.9  # with a larger bearing it turns on the spot (rad)
_STILL = 0.02  # nearer than this to its target it rests (m)


_TURN_FIRST_WHERE_NARROW = 0.2  # where there is no room for an arc (rad)
_SLOW, _FASTER = 0.12, 2.0  # no faster there than this (m/s), or than the room in so much of a second (1/s)
_NARROW = 0.11  # less room than this beside a robot leaves none (m)
_LEAST_CUT = 0.01  # by so much a robot may always leave its path, or it would never get round a corner (m)


def centred(paths: list[NDArray[np.int64]], grid: FloorGrid, radius: float) -> tuple[list[Floats], list[Floats] | None]:
    """Return paths of cells as curves in the middle of narrow places, and the room beside a robot at their points.

    Args:
        paths: (T, 2) [row, column] of each robot.
        grid: Where they were planned; without a clearance its cells' centres are the curves, and the room is not known.
        radius: Of the robots [m].
    """
    curves = [grid.points(path) for path in paths]
    if grid.clearance is None:
        return curves, None
    away = np.pad(grid.clearance.astype(np.float64), 1)
    room = []
    for path, curve in zip(paths, curves, strict=True):
        row, col = path.T + 1
        room.append(away[row, col] - radius)
        for axis, (dr, dc) in enumerate(((0, 1), (1, 0))):
            one, other = away[row - dr, col - dc], away[row + dr, col + dc]
            # beside the ridge of the clearance the two differ by twice the way to it
            beside = (
                (room[-1] < _NARROW) & (np.minimum(one, other) > 0.0) & (np.maximum(one, other) < away[row, col] + 1e-3)
            )
            most = 0.5 * grid.resolution
            curve[:, axis] += np.where(beside, np.clip(0.5 * (other - one), -most, most), 0.0)
    return curves, room


def steer_to(
    pose: Floats, target: Floats, robot: RobotSpec = ROBOT, turn_first: float = _TURN_FIRST
) -> tuple[float, float]:
    """Return the speed [m/s] and turn rate [rad/s] that take a robot to a point nearby.

    Args:
        pose: (3,) of the robot.
        target: (2,) the point [m].
        robot: What it is like.
        turn_first: With a larger bearing it turns on the spot [rad].
    """
    dx, dy = target[0] - pose[0], target[1] - pose[1]
    away = math.hypot(dx, dy)
    if away < _STILL:
        return 0.0, 0.0
    bearing = math.remainder(math.atan2(dy, dx) - pose[2], 2.0 * math.pi)
    rate = min(max(_TURN_GAIN * bearing, -robot.max_turn_rate), robot.max_turn_rate)
    if abs(bearing) > turn_first:
        return 0.0, rate
    return min(away / _RESPONSE, robot.max_speed) * math.cos(bearing), rate


class ClockDriving:
    """Every robot is where its path says that it should be at that time, as nearly as it can.

    Args:
        curves: (T, 2) points of each robot, one a step of the plan [m].
        step: How long a step takes [s].
        narrow: Whether robots turn before they drive, since there is no room for an arc.
    """

    def __init__(self, curves: list[Floats], step: float, narrow: bool = False) -> None:
        self.curves, self.step = curves, step
        self._turn_first = _TURN_FIRST_WHERE_NARROW if narrow else _TURN_FIRST

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
        pairs = zip(state.poses, targets, strict=True)
        return np.array([steer_to(pose, target, turn_first=self._turn_first) for pose, target in pairs])

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
        room: (T,) what is free beside a robot at each point of its curve [m]; None: enough to cut corners.

    Attributes:
        completed: (k,) steps that each robot has completed.
        waits: Pairs (i, j) at the last call of ``commands``: robot i waited for robot j.
    """

    def __init__(
        self, curves: list[Floats], precedence: Precedence, radius: float, room: list[Floats] | None = None
    ) -> None:
        self.curves, self._precedence, self._apart = curves, precedence, 2.0 * radius + _GAP
        self._room = room
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
            target = self._without_cutting(robot, target, state.poses[robot, :2])
            room = math.inf if self._room is None else float(self._room[robot][target])
            narrow = room < _NARROW
            turn_first = _TURN_FIRST_WHERE_NARROW if narrow else _TURN_FIRST
            speed, rate = steer_to(state.poses[robot], self.curves[robot][target], turn_first=turn_first)
            speed = min(speed, max(_SLOW, _FASTER * room)) if narrow else speed
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

    def _without_cutting(self, robot: int, target: int, position: Floats) -> int:
        """The farthest point up to ``target`` to which the straight way leaves the path no farther than is free."""
        first, curve = int(self.completed[robot]), self.curves[robot]
        if self._room is None:
            return target
        for point in range(target, first, -1):
            way, passed = curve[point] - position, curve[first:point] - position
            length = max(float(np.hypot(*way)), 1e-9)
            along = np.clip(passed @ way / length**2, 0.0, 1.0)
            aside = np.hypot(*(passed - along[:, None] * way).T)
            allowed = np.maximum(self._room[robot][first:point] - _LEAST_CUT, _LEAST_CUT)
            if (aside <= allowed).all():
                return point
        return first if float(np.hypot(*(curve[first] - position))) >= _STILL else min(first + 1, target)

    def remaining(self, robot: int) -> Floats:
        """The points (n, 2) that a robot still has to pass."""
        return self.curves[robot][int(self.completed[robot]) :]
