"""Random arenas and random U traps: circles, start, goal and room from a seed."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Bounds

Shapes = tuple[NDArray[np.float64], tuple[float, float], tuple[float, float], Bounds, float]
"""Circles (K, 3), start, goal, bounds, radius of the robot; all in metres."""

ROOM: Bounds = (0.0, 0.0, 100.0, 100.0)
DENSITY = 0.15
"""Share of the room that circles cover unless another is asked for."""
DENSITIES = (0.08, 0.15, 0.22)
"""The three densities that are reported: low, middle and high."""
_LEAST_DENSITY, _MOST_DENSITY = 0.0, 0.3
_RADII = (2.0, 5.0)
_ROBOT = 1.0
_APART = 60.0
"""Least distance from start to goal."""
_ROOMY = 1.0
"""Clearance that start and goal have beside the robot's radius."""
_TRIES = 10_000


def random_arena_shapes(seed: int, density: float) -> Shapes:
    """Draw circles of 2 to 5 m, overlapping or not, until they cover a share of the 100 m room.

    The start and the goal lie 60 m or more apart and 1 m off every obstacle; whether a path connects them is left to
    chance.

    Args:
        seed: Of everything random here.
        density: Sum of the circles' areas over the room's, 0 to 0.3.

    Raises:
        MapError: The density is out of range.
    """
    if not _LEAST_DENSITY <= density <= _MOST_DENSITY:  # also refuses NaN
        raise MapError(f"a random arena has density {density:g}; {_LEAST_DENSITY:g} to {_MOST_DENSITY:g} are allowed")
    rng = np.random.default_rng(seed)
    circles: list[tuple[float, float, float]] = []
    covered, wanted = 0.0, density * 100.0 * 100.0
    while covered < wanted:
        x, y = rng.uniform(0.0, 100.0, 2)
        radius = rng.uniform(*_RADII)
        circles.append((x, y, radius))
        covered += math.pi * radius**2
    discs = np.array(circles).reshape(-1, 3)
    for _ in range(_TRIES):
        ends = rng.uniform(_ROBOT + _ROOMY, 100.0 - _ROBOT - _ROOMY, (2, 2))
        away = np.hypot(discs[:, None, 0] - ends[:, 0], discs[:, None, 1] - ends[:, 1]) - discs[:, None, 2]
        if np.hypot(*(ends[1] - ends[0])) >= _APART and (away > _ROBOT + _ROOMY).all():
            break
    start, goal = (float(ends[0, 0]), float(ends[0, 1])), (float(ends[1, 0]), float(ends[1, 1]))
    return discs, start, goal, ROOM, _ROBOT


def u_trap_shapes(seed: int) -> Shapes:
    """Draw a U, open towards the start, across the straight way to the goal, and a few circles beside it.

    The U is an arc of 140° to 240° and 5 to 12 m, closed for every robot, turned by up to 20°.

    Args:
        seed: Of everything random here.
    """
    rng = np.random.default_rng(seed)
    start, goal = rng.uniform(5.0, 15.0, 2), rng.uniform(80.0, 92.0, 2)
    radius, opening = rng.uniform(5.0, 12.0), math.radians(rng.uniform(140.0, 240.0))
    middle = start + rng.uniform(0.3, 0.65) * (goal - start) + rng.normal(0.0, 1.0, 2)
    ahead = math.atan2(*(goal - start)[::-1]) + math.radians(rng.uniform(-20.0, 20.0))
    angles = ahead + np.linspace(-opening / 2, opening / 2, math.ceil(radius * opening / 1.2) + 1)
    trap = np.column_stack([middle[0] + radius * np.cos(angles), middle[1] + radius * np.sin(angles)])
    beside = rng.uniform(0.0, 100.0, (int(rng.integers(4, 9)), 2))
    clear = np.hypot(*(beside - middle).T) > radius + 8.0
    for end in (start, goal):
        clear &= np.hypot(*(beside - end).T) > 6.0
    circles = np.vstack([np.column_stack([trap, np.full(len(trap), 0.8)]), np.insert(beside[clear], 2, 2.0, axis=1)])
    ends = [(float(end[0]), float(end[1])) for end in (start, goal)]
    return circles, ends[0], ends[1], ROOM, 0.5
