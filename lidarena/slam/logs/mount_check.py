"""Whether the laser sits on the side of the robot where a log says: wheels and matched scans tell.

A robot turns about the middle between its wheels. While it turns, a laser ahead of it moves to the left or right, and
by how much tells how far ahead. Some writers of logs mix up the laser's pose and the robot's, and the laser comes out
on the wrong side.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.planar import between, wrapped

Floats = NDArray[np.float64]

_TURN, _WAY = 0.25, 0.3
"""Motions are looked at that turn by so much, at least, over so much way, at most [rad, m]."""
_FEWEST = 40
_SMALLEST = 0.03
"""Mounts nearer to the robot's centre are not questioned [m]: castors shift what is measured by so much."""
_CLEARLY = 3.0
"""The wrong side must be so many times farther from what is measured than the right one."""


def measured_offset(odometry: Floats, laser: Floats) -> float | None:
    """How far ahead of the wheels' middle a laser sits [m], by least squares without outliers.

    Args:
        odometry: (S, 3) the robot by its wheels.
        laser: (S, 3) the laser by matching its scans.

    Returns:
        None where the robot turned too seldom.
    """
    pairs = _turning(odometry)
    if len(pairs) < _FEWEST:
        return None
    moved = between(laser[pairs[:, 0]], laser[pairs[:, 1]])
    wheels = between(odometry[pairs[:, 0]], odometry[pairs[:, 1]])
    # wheels tell ways better than turns: their way, on an arc of the turn that the scans tell
    length = np.hypot(wheels[:, 0], wheels[:, 1]) * np.sign(wheels[:, 0])
    sideways, lever = moved[:, 1] - length * np.sin(0.5 * moved[:, 2]), np.sin(moved[:, 2])
    kept, offset = np.abs(lever) > 0.5 * np.sin(_TURN), 0.0
    if kept.sum() < _FEWEST:
        return None
    for _ in range(8):
        offset = float(lever[kept] @ sideways[kept] / (lever[kept] @ lever[kept]))
        missed = np.abs(sideways - offset * lever)
        kept &= missed <= 2.5 * 1.4826 * np.median(missed[kept]) + 1e-6
    return offset


def checked_mount(mount: Floats, odometry: Floats, laser: Floats) -> tuple[Floats, str | None]:
    """The mount (3,), turned to the other side where the log has it clearly wrong, and a sentence that tells so.

    Args:
        mount: Where the log says that the laser sits on the robot.
        odometry: (S, 3) the robot by its wheels.
        laser: (S, 3) the laser by matching its scans.
    """
    if abs(mount[0]) < _SMALLEST or abs(mount[1]) > 0.5 * abs(mount[0]) or abs(mount[2]) > 0.1:
        return mount, None
    offset = measured_offset(odometry, laser)
    if offset is None or abs(offset - mount[0]) <= _CLEARLY * abs(offset + mount[0]):
        return mount, None
    sides = ("ahead of", "behind") if mount[0] > 0.0 else ("behind", "ahead of")
    sentence = (
        f"the log places the laser {abs(mount[0]):.2f} m {sides[0]} the robot's centre, but by wheels and scans "
        f"it sits {abs(offset):.2f} m {sides[1]} it; {abs(mount[0]):.2f} m {sides[1]} it is taken"
    )
    return np.array([-mount[0], -mount[1], mount[2]]), sentence


def _turning(odometry: Floats) -> NDArray[np.int64]:
    """(P, 2) moments between which the robot mostly turned."""
    steps = between(odometry[:-1], odometry[1:])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]))])
    turned = np.concatenate([[0.0], np.cumsum(wrapped(steps[:, 2]))])
    pairs, first = [], 0
    for k in range(1, len(odometry)):
        if abs(turned[k] - turned[first]) >= _TURN:
            pairs.append((first, k))
            first = k
        elif way[k] - way[first] > _WAY:
            first = k
    return np.array(pairs, np.int64).reshape(-1, 2)
