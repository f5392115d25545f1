"""Whether commands are safe by what the beams have hit lately, and the way out where those that were planned are not.

A robot that can neither stop nor reverse is safe as long as it knows commands that touch nothing and end where it could
turn on a circle. Maps are drawn from believed poses, which jitter by some centimetres; so what is left of a plan is
compared with the hits themselves, which stand where they are in the robot's own frame. Where the plan no longer holds
and there is no room for the circle, as in a passage, turning would end at a wall: a way out is searched instead.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.grid.steering import WEIGHT, Commands, move, search_commands

GUARDED = 2.5
"""What lies farther away is not looked at [m]."""
_FORESEEN = 2.0  # commands are compared with hits until the robot is so far away [m]
_PIECE = 0.05  # at points of the way so far apart [m]
_CIRCLE = 24  # points of a circle
_NEARER = 2e-3  # what the robot comes nearer to by less than this it does not approach [m]
_CELL = 0.04  # of the grid on which a way out is searched [m]
_EASINGS = np.array([0.06, 0.03, 0.0, -0.008])  # of the clearance, one after the other, until there is a way out [m]
_ROOMY, _MOST_STATES = 0.15, 6000.0  # clearance beyond the least that is preferred on a way out [m]
_TOUCHED = 0.02  # what is nearer than the least distance by more than this is no measure for the way out [m]


@kernel
def carried(
    points: NDArray[np.float64], before: NDArray[np.float64], after: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Where points lie for a robot's pose ``after`` that lie where they do for its pose ``before``.

    Args:
        points: (n, 2) [m].
        before: (3,).
        after: (3,).
    """
    cosine, sine = math.cos(after[2] - before[2]), math.sin(after[2] - before[2])
    moved = np.empty((len(points), 2))
    for i in range(len(points)):
        x, y = points[i, 0] - before[0], points[i, 1] - before[1]
        moved[i, 0] = after[0] + cosine * x - sine * y
        moved[i, 1] = after[1] + sine * x + cosine * y
    return moved


@kernel
def nearby(points: NDArray[np.float64], before: NDArray[np.float64]) -> NDArray[np.float64]:
    """Those of some points (n, 2) within ``GUARDED`` of a pose (3,), in its frame (m, 2)."""
    own = carried(points, before, np.zeros(3))
    count = 0
    for i in range(len(own)):
        if own[i, 0] ** 2 + own[i, 1] ** 2 <= GUARDED**2:
            own[count] = own[i]
            count += 1
    return own[:count].copy()


@leaf
def _distance(points: NDArray[np.float64], x: float, y: float) -> float:
    """From a place to the nearest of the points that are nearer to it than to the robot at the origin."""
    least = np.inf
    for i in range(len(points)):
        there = (points[i, 0] - x) ** 2 + (points[i, 1] - y) ** 2
        if there < least:
            here = max(math.hypot(points[i, 0], points[i, 1]) - _NEARER, 0.0)
            if there < here * here:
                least = there
    return math.sqrt(least)


@kernel
def circle_distance(points: NDArray[np.float64], pose: NDArray[np.float64], velocity: NDArray[np.float64]) -> float:
    """Least distance to approached points on the circle that a turning command drives from a pose.

    Args:
        points: (n, 2) in the frame of the robot now.
        pose: (3,) in that frame.
        velocity: (2,) v [m/s] and w [rad/s], w not 0.
    """
    radius = velocity[0] / velocity[1]
    x, y, least = pose[0] - radius * math.sin(pose[2]), pose[1] + radius * math.cos(pose[2]), np.inf
    for i in range(_CIRCLE if radius != 0.0 else 1):
        angle = pose[2] + i * 2.0 * math.pi / _CIRCLE
        least = min(least, _distance(points, x + radius * math.sin(angle), y - radius * math.cos(angle)))
    return float(least)


@kernel
def is_safe(points: NDArray[np.float64], commands: Commands, sequence: NDArray[np.int64], keep: float) -> bool:
    """Whether a sequence of commands approaches no point nearer than ``keep``, and ends where a circle does not either.

    What is farther away than two metres is left to later.

    Args:
        points: (n, 2) that beams have hit, in the frame of the robot [m].
        commands: What the robot can do.
        sequence: (n,) indices of commands.
        keep: [m].
    """
    pose = np.zeros(3)
    for command in sequence:
        step = commands.moves[command]
        pieces = max(1, math.ceil(math.hypot(step[0], step[1]) / _PIECE - 1e-6))
        cosine, sine = math.cos(pose[2]), math.sin(pose[2])
        for k in range(1, pieces + 1):
            dx, dy = k / pieces * step[0], k / pieces * step[1]
            if _distance(points, pose[0] + cosine * dx - sine * dy, pose[1] + sine * dx + cosine * dy) < keep:
                return False
        move(pose, step)
        if math.hypot(pose[0], pose[1]) > _FORESEEN:
            return True
    for k in range(commands.velocities.shape[0]):
        if commands.velocities[k, 1] != 0.0 and circle_distance(points, pose, commands.velocities[k]) >= keep:
            return True
    return False


@kernel
def turn_in_place(points: NDArray[np.float64], commands: Commands, turning: int, keep: float, room: float) -> int:
    """The turning command with which the robot may stay where it is, -1 if none is safe.

    It is the one whose full circle keeps the most distance, the sharpest to the left where several keep ``room``. Once
    begun, it goes on as long as it is safe, for going left and right in turn would creep forwards.

    Args:
        points: (n, 2) that beams have hit, in the frame of the robot [m].
        commands: What the robot can do.
        turning: The command with which it has turned so far, -1 if with none.
        keep: Least distance [m].
        room: Distance that is enough [m].
    """
    velocities, here = commands.velocities, np.zeros(3)
    if turning >= 0 and circle_distance(points, here, velocities[turning]) >= keep:
        return turning
    best, most = -1, keep
    for k in range(velocities.shape[0]):
        if velocities[k, 1] == 0.0:
            continue
        own = min(circle_distance(points, here, velocities[k]), room)
        sharper = best >= 0 and velocities[k, 1] > velocities[best, 1]
        if own > most or (own == most and (best < 0 or sharper)):
            best, most = k, own
    return best


@kernel
def way_out(points: NDArray[np.float64], commands: Commands, keep: float) -> NDArray[np.int64]:
    """The quickest commands (n,) to where the robot has room for a circle, (0,) if none are found.

    They keep as much more than ``keep`` as can be had; at the last they may come a little nearer.

    Args:
        points: (n, 2) that beams have hit, in the frame of the robot [m].
        commands: What the robot can do.
        keep: Least distance [m].
    """
    side = 2 * round(GUARDED / _CELL)
    squares = np.full((side, side), np.inf)
    corner = -0.5 * side * _CELL
    for r in range(side):
        for c in range(side):
            x, y = corner + (c + 0.5) * _CELL, corner + (r + 0.5) * _CELL
            for i in range(len(points)):
                squares[r, c] = min(squares[r, c], (points[i, 0] - x) ** 2 + (points[i, 1] - y) ** 2)
    gap = np.sqrt(squares).astype(np.float32)
    closed, frame, here = np.zeros((side, side), np.bool_), np.array([corner, corner, _CELL]), np.zeros(3)
    own = np.inf
    for i in range(len(points)):
        own = min(own, math.hypot(points[i, 0], points[i, 1]))
    limits = np.array([10.0 * GUARDED, GUARDED - 0.5, _MOST_STATES])
    for easing in _EASINGS:
        least = min(keep + easing, max(own - _NEARER, keep - _TOUCHED))
        margins = np.array([least, keep + _ROOMY, WEIGHT])
        found = search_commands(gap, closed, frame, here, np.zeros(2), commands, margins, limits)
        if len(found) > 0:
            return found
    return np.empty(0, np.int64)
