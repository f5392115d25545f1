"""How far a robot could drive and turn before it touches what its lidar sees."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf, take_next
from lidarena.envs.worker_threads import on_threads

AHEAD = (0.0, 0.1, 0.2, 0.4, 0.8)
"""After so much straight ahead it is asked how far the robot could turn [m]."""
TURNS = 12
"""After so many turns each way, by multiples of ``TURN_STEP``, it is asked how far it could go straight ahead."""
TURN_STEP = math.pi / 12
FARTHEST = 2.0
"""Straight ahead, no more is told than this [m]."""
MARGIN = 0.02
"""Room around the robot within which things count as touched: what a lidar's noise may hide [m]."""
ARCS = 1 + 2 * len(AHEAD) + 2 * TURNS
"""Numbers of a robot's ``free_arcs``."""
_ALL_AROUND = 2.0 * math.pi


class Arc(NamedTuple):
    """What a robot's turns are like.

    Attributes:
        turning_radius: Of the circle on which its middle drives [m].
        contact: Distance from its middle at which it touches something [m].
    """

    turning_radius: float
    contact: float


@leaf
def _straight(points: NDArray[np.float64], n: int, x: float, y: float, theta: float, contact: float) -> float:
    """How far a robot at a pose in the points' frame can go straight ahead [m]."""
    cos, sin = math.cos(theta), math.sin(theta)
    free = FARTHEST
    for k in range(n):
        dx, dy = points[0, k] - x, points[1, k] - y
        ahead, left = cos * dx + sin * dy, cos * dy - sin * dx
        if ahead > 0.0 and abs(left) < contact:
            free = min(free, ahead - math.sqrt(contact * contact - left * left))
    return max(free, 0.0)


@leaf
def _turn(points: NDArray[np.float64], n: int, ahead: float, side: float, arc: Arc) -> float:
    """How far a robot that is ``ahead`` on the x axis can turn, left if ``side`` is 1, right if -1 [rad]."""
    free, radius = _ALL_AROUND, arc.turning_radius
    for k in range(n):
        dx, dy = points[0, k] - ahead, side * points[1, k] - radius  # from the middle of a circle to the left
        squared = dx * dx + dy * dy
        distance = math.sqrt(squared)
        if abs(distance - radius) >= arc.contact:
            continue
        half = math.pi
        if distance * radius > 1e-9:
            cosine = (squared + radius * radius - arc.contact * arc.contact) / (2.0 * distance * radius)
            half = math.acos(min(max(cosine, -1.0), 1.0))
        where = math.atan2(dx, -dy)  # along the circle from the robot's middle on
        if where < -half:
            where += _ALL_AROUND
        elif where < 0.0:
            where += _ALL_AROUND  # it touches that now, and leaves it behind
        free = min(free, max(where - half, 0.0))
    return free


@leaf
def _measure(points: NDArray[np.float64], n: int, arc: Arc, out: NDArray[np.float32]) -> None:
    """Write one robot's numbers, see ``free_arcs``."""
    straight = _straight(points, n, 0.0, 0.0, 0.0, arc.contact)
    out[0] = math.sqrt(straight / FARTHEST)
    at = 1
    for k in range(len(AHEAD)):
        for side in (1.0, -1.0):
            free = _turn(points, n, AHEAD[k], side, arc) if AHEAD[k] <= straight else 0.0
            out[at] = math.sqrt(free / _ALL_AROUND)
            at += 1
    for side in (1.0, -1.0):
        most = _turn(points, n, 0.0, side, arc)
        for k in range(1, TURNS + 1):
            turn = k * TURN_STEP
            free = 0.0
            if turn <= most:
                x, y = arc.turning_radius * math.sin(turn), arc.turning_radius * (1.0 - math.cos(turn))
                free = _straight(points, n, x, side * y, side * turn, arc.contact)
            out[at] = math.sqrt(free / FARTHEST)
            at += 1


@kernel
def _measure_all(
    scans: NDArray[np.float32],
    directions: NDArray[np.float64],
    far: float,
    arc: Arc,
    out: NDArray[np.float32],
    counter: NDArray[np.int64],
) -> None:
    beams = scans.shape[1]
    points = np.empty((2, beams), np.float64)
    matters = min(far, FARTHEST + 2.0 * (arc.turning_radius + arc.contact))
    while True:
        w = take_next(counter)
        if w >= out.shape[0]:
            break
        n = 0
        for k in range(beams):
            if scans[w, k] < matters:
                points[0, n], points[1, n] = scans[w, k] * directions[0, k], scans[w, k] * directions[1, k]
                n += 1
        _measure(points, n, arc, out[w])


def free_arcs(
    scans: NDArray[np.float32], directions: NDArray[np.float64], max_range: float, turning_radius: float, contact: float
) -> NDArray[np.float32]:
    """Say how far robots could drive and turn before they touch what their scans show.

    Args:
        scans: (worlds, beams) [m]; a hit too near to be measured is 0.
        directions: (2, beams) cosines and sines of the beams.
        max_range: Of beams without a hit [m].
        turning_radius: Of the robots' turns [m].
        contact: Distance from a robot's middle at which it touches something [m]; ``MARGIN`` is added.

    Returns:
        (worlds, ARCS) in [0, 1]: how far straight ahead, as the root of its share of 2 m; how far to the left and to
        the right after each of ``AHEAD``, as the root of its share of a full circle (0 where it cannot go so far); how
        far straight ahead after 15, 30 … 180 degrees to the left and then to the right (0 where it cannot turn so far).
    """
    out = np.empty((len(scans), ARCS), np.float32)
    counter, arc = np.zeros(1, np.int64), Arc(turning_radius, contact + MARGIN)
    on_threads(len(out), lambda _: _measure_all(scans, directions, max_range, arc, out, counter))
    return out
