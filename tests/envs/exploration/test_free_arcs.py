"""How far a robot could drive and turn: against a robot that tries it in small steps."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.envs.exploration.free_arcs import AHEAD, ARCS, FARTHEST, MARGIN, TURN_STEP, TURNS, free_arcs
from lidarena.world.lidar import LidarSpec

LIDAR = LidarSpec()
DIRECTIONS = np.stack([np.cos(LIDAR.angles), np.sin(LIDAR.angles)])
RADIUS, CONTACT = 1.0 / 6.0, 0.12
STEP = 1e-3


def arcs(scan: NDArray[np.float32], radius: float = RADIUS) -> NDArray[np.float32]:
    return free_arcs(scan[None], DIRECTIONS, LIDAR.max_range, radius, CONTACT)[0]


def touches(points: NDArray[np.float64], before: NDArray[np.float64], now: NDArray[np.float64]) -> bool:
    """Whether a robot comes nearer to a point that is within its reach."""
    far, near = np.hypot(*(points - before).T), np.hypot(*(points - now).T)
    return bool(((near < CONTACT + MARGIN) & (near < far)).any())


def tried(points: NDArray[np.float64], pose: tuple[float, float, float], rate: float, most: float) -> float:
    """How far a robot gets from a pose, turning by ``rate`` a metre, in small steps."""
    x, y, theta = pose
    driven = 0.0
    while driven < most:
        before = np.array([x, y])
        x, y = x + STEP * math.cos(theta + 0.5 * STEP * rate), y + STEP * math.sin(theta + 0.5 * STEP * rate)
        theta += STEP * rate
        if touches(points, before, np.array([x, y])):
            return driven
        driven += STEP
    return most


def around(turn: float, side: float) -> tuple[float, float, float]:
    return RADIUS * math.sin(turn), side * RADIUS * (1.0 - math.cos(turn)), side * turn


@pytest.mark.parametrize("seed", range(6))
def test_all_is_as_a_robot_finds_that_tries_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scan = np.full(LIDAR.beams, LIDAR.max_range, np.float32)
    seen = rng.choice(LIDAR.beams, 12, replace=False)
    scan[seen] = rng.uniform(0.16, 1.5, 12)
    points = (scan[seen] * DIRECTIONS[:, seen]).T
    found = arcs(scan).astype(float) ** 2
    straight = tried(points, (0.0, 0.0, 0.0), 0.0, FARTHEST)
    assert FARTHEST * found[0] == pytest.approx(straight, abs=3e-3)
    turns = 2.0 * math.pi * RADIUS
    for k, ahead in enumerate(AHEAD):
        for j, side in enumerate((1.0, -1.0)):
            expected = tried(points, (ahead, 0.0, 0.0), side / RADIUS, turns) if ahead <= straight else 0.0
            assert turns * found[1 + 2 * k + j] == pytest.approx(expected, abs=3e-3)
    after = found[1 + 2 * len(AHEAD) :].reshape(2, TURNS)
    for j, side in enumerate((1.0, -1.0)):
        most = tried(points, (0.0, 0.0, 0.0), side / RADIUS, turns) / RADIUS
        for k in range(TURNS):
            turn = (k + 1) * TURN_STEP
            if abs(turn - most) < 0.02:
                continue
            expected = tried(points, around(turn, side), 0.0, FARTHEST) if turn < most else 0.0
            assert FARTHEST * after[j, k] == pytest.approx(expected, abs=5e-3)


def test_nothing_in_sight_leaves_all_room_and_a_hit_too_near_to_be_measured_none() -> None:
    free = np.full(LIDAR.beams, LIDAR.max_range, np.float32)
    np.testing.assert_array_equal(arcs(free), np.ones(ARCS))
    np.testing.assert_array_equal(arcs(np.zeros(LIDAR.beams, np.float32))[:3], [1.0, 0.0, 0.0])


def test_a_mirrored_world_swaps_left_and_right() -> None:
    rng = np.random.default_rng(1)
    scan = rng.uniform(0.2, 3.5, LIDAR.beams).astype(np.float32)
    mirrored = np.roll(scan[::-1], 1)
    here, there = arcs(scan), arcs(mirrored)
    swapped = np.concatenate([here[:1], here[1:11].reshape(-1, 2)[:, ::-1].ravel(), np.roll(here[11:], TURNS)])
    np.testing.assert_allclose(there, swapped, atol=1e-4)


def test_a_robot_that_turns_on_the_spot_turns_as_far_as_it_likes() -> None:
    scan = np.full(LIDAR.beams, 0.2, np.float32)
    assert arcs(scan, radius=0.0)[1:3].tolist() == [1.0, 1.0]


def test_worlds_do_not_depend_on_each_other() -> None:
    scans = np.random.default_rng(2).uniform(0.1, 3.5, (5, LIDAR.beams)).astype(np.float32)
    together = free_arcs(scans, DIRECTIONS, LIDAR.max_range, RADIUS, CONTACT)
    for w in range(5):
        np.testing.assert_array_equal(together[w], arcs(scans[w]))
