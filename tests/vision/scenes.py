"""Cameras, clouds and pictures of the seabed that the tests of vision share."""

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.vision.camera import StereoCamera
from lidarena.vision.matching import Matches
from lidarena.vision.rigid_motion import inverse, motion_of, moved, rotation_of
from lidarena.vision.seabed import Seabed, make_seabed
from lidarena.vision.seabed_renderer import downward_pose, render_pair
from lidarena.vision.water import Water

Floats = NDArray[np.float64]
Pair = tuple[NDArray[np.uint8], NDArray[np.uint8]]

CAMERA = StereoCamera.with_view(600, 400, math.radians(60.0), 0.4)
AREA = (0.0, 0.0, 25.0, 10.0)


def stream(seed: int = 0) -> NDArray[np.uint64]:
    return seed_stream(np.random.default_rng(seed))


@cache
def seabed() -> Seabed:
    return make_seabed(np.random.default_rng(1), 3.5, AREA)


def pose_at(x: float, heading: float = 0.1, z: float = 5.0) -> Floats:
    return downward_pose(x, 5.0 + 0.05 * x, z, heading, 0.02, -0.03)


@cache
def pair_at(x: float, water: Water = Water()) -> Pair:  # noqa: B008 - it is frozen
    return render_pair(seabed(), CAMERA, pose_at(x), water, stream(int(10 * x)))


def motion_between(a: Floats, b: Floats) -> Floats:
    """From the frame of pose a to that of pose b."""
    return inverse(b) @ a


def some_motion() -> Floats:
    return motion_of(rotation_of(np.array([0.01, -0.02, 0.05])), np.array([0.05, 0.6, -0.1]))


def matches_of(motion: Floats, count: int, noise: float, wrong: float = 0.0, seed: int = 0) -> tuple[Matches, Floats]:
    """Matches of random points before and after a motion, some of them wrong; and which are right."""
    rng = np.random.default_rng(seed)
    points = np.column_stack([rng.uniform(-2, 2, count), rng.uniform(-1.2, 1.2, count), rng.uniform(4.0, 6.0, count)])
    a, b = CAMERA.project(points), CAMERA.project(moved(motion, points))
    a, b = a + rng.normal(0, noise, a.shape), b + rng.normal(0, noise, b.shape)
    bad = rng.random(count) < wrong
    b[bad, ::2] += rng.uniform(15, 80, (bad.sum(), 1)) * rng.choice([-1, 1], (bad.sum(), 1))
    return Matches(np.arange(count), np.arange(count), a, b, np.ones(count)), ~bad
