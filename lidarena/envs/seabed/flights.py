"""The flight of an underwater vehicle along the lanes of a survey; planar motion is pymunk's."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.vision.seabed_renderer import downward_pose

Floats = NDArray[np.float64]

LANE, SPACING = 24.0, 3.0
"""Length of a lane of the survey, and the distance between two [m]."""
_MASS, _MOMENT, _WATER = 30.0, 4.0, 0.6
"""Of the vehicle [kg, kg m²], and the share of its velocity that water leaves it in a second."""
_AHEAD = 1.2
"""The vehicle steers for a point so far ahead on its way [m]."""


@dataclass(frozen=True)
class Flight:
    """Where the vehicle was when each frame was taken, and what its instruments measured.

    Attributes:
        poses: (frames, 4, 4) left camera to world.
        planar: (frames, 3) x, y, heading [m, m, rad].
        attitudes: (frames, 3, 3) camera to world, as the navigation system measured it.
        positions: (frames, 3) as a Doppler log sums them up, without the start's [m].
    """

    poses: Floats
    planar: Floats
    attitudes: Floats
    positions: Floats


def survey_lanes(length: float) -> Floats:
    """Corners (n, 2) of a boustrophedon survey of at least this length [m]."""
    corners, x, y = [(0.0, 0.0)], 0.0, 0.0
    done = 0.0
    while done < length + 2.0 * _AHEAD:
        x = LANE - x
        corners.append((x, y))
        y += SPACING
        corners.append((x, y))
        done += LANE + SPACING
    return np.array(corners)


def survey_area(length: float) -> tuple[float, float, float, float]:
    """x_min, y_min, x_max, y_max of what a survey of this length flies over [m]."""
    corners, done = survey_lanes(length), 0.0
    last = 1
    for one, two in pairwise(corners):
        if done >= length:
            break
        done += float(np.hypot(*(two - one)))
        last += 1
    low, high = corners[:last].min(axis=0) - 1.0, corners[:last].max(axis=0) + 1.0
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def fly(rng: np.random.Generator, frames: int, rate: float, speed: float, depth: float) -> Flight:
    """Fly a survey.

    Args:
        rng: Of the currents, the unsteady water and the instruments' noise.
        frames: How many are taken.
        rate: Frames a second.
        speed: [m/s].
        depth: Height at which the vehicle is held [m].
    """
    planar = _planar_motion(rng, frames, rate, speed)
    heave = 0.06 * _slow_noise(rng, frames, rate, 4.0)
    pitch, roll = (0.02 * _slow_noise(rng, frames, rate, 2.0) for _ in range(2))
    poses = np.stack([
        downward_pose(x, y, depth + up, heading, nod, lean)
        for (x, y, heading), up, nod, lean in zip(planar, heave, pitch, roll, strict=True)
    ])  # fmt: skip
    return Flight(poses, planar, rng.standard_normal((frames, 3)), poses[:, :3, 3] - poses[0, :3, 3])


def _planar_motion(rng: np.random.Generator, frames: int, rate: float, speed: float) -> Floats:
    """Poses (frames, 3) of a body that is pushed along the lanes in a current."""
    way = _dense(survey_lanes(frames / rate * speed))
    space = pymunk.Space()
    space.damping = _WATER
    body = pymunk.Body(_MASS, _MOMENT)
    body.position, body.velocity = (0.0, 0.0), (speed, 0.0)
    space.add(body)
    push = 4.0 * np.stack([_slow_noise(rng, frames, rate, 6.0) for _ in range(2)], axis=1)
    twist = 0.15 * _slow_noise(rng, frames, rate, 3.0)
    out, nearest = np.empty((frames, 3)), 0
    for frame in range(frames):
        x, y = body.position
        out[frame] = x, y, math.remainder(body.angle, 2.0 * math.pi)
        near = way[nearest : nearest + 60] - (x, y)
        nearest += int(np.argmin(near[:, 0] ** 2 + near[:, 1] ** 2))
        aim = way[min(nearest + int(_AHEAD / 0.05), len(way) - 1)]
        wanted = math.atan2(aim[1] - y, aim[0] - x)
        off = math.remainder(wanted - body.angle, 2.0 * math.pi)
        body.torque = _MOMENT * (1.6 * off - 2.0 * body.angular_velocity) + float(twist[frame])
        goal = speed * np.array([math.cos(wanted), math.sin(wanted)])
        force = _MASS * (1.5 * (goal - np.array(body.velocity)) - math.log(_WATER) * goal) + push[frame]
        body.apply_force_at_world_point((float(force[0]), float(force[1])), body.position)
        space.step(1.0 / rate)
    return out


def _dense(corners: Floats) -> Floats:
    """Points every 0.05 m along a way."""
    parts = [
        one
        + np.linspace(0.0, 1.0, max(round(float(np.hypot(*(two - one))) / 0.05), 1), endpoint=False)[:, None]
        * (two - one)
        for one, two in pairwise(corners)
    ]
    return np.vstack([*parts, corners[-1:]])


def _slow_noise(rng: np.random.Generator, frames: int, rate: float, period: float) -> Floats:
    """Smooth noise (frames,) of deviation 1 that changes over ``period`` [s]."""
    keep = math.exp(-1.0 / (period * rate))
    made, first, second = np.empty(frames), 0.0, 0.0
    for frame, drawn in enumerate(rng.standard_normal(frames)):
        first = keep * first + math.sqrt(1.0 - keep * keep) * drawn
        second = keep * second + (1.0 - keep) * first
        made[frame] = second
    return made * math.sqrt(2.0)
