"""What robots are told of their neighbours, against a slow oracle."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.envs.corridor.kernels import TeamMeasurements, write_observations

Floats = NDArray[np.float64]


def observed(poses: Floats, speeds: Floats, neighbours: int) -> Floats:
    """The numbers that tell robot 0 about its neighbours."""
    robots = len(poses)
    measurements = TeamMeasurements(
        np.ones((1, robots, 4)), np.ones((1, robots, 4), np.float32), poses[None],
        np.stack([speeds, 0 * speeds], axis=1)[None], np.ones((1, robots)), np.ones((1, robots, 2)),
        np.zeros((1, robots)), np.zeros(1),
    )  # fmt: skip
    out = np.full((1, robots, 4 + 8 + 5 * neighbours), np.nan, np.float32)
    nobody = np.zeros((1, robots), np.bool_)
    write_observations(measurements, np.ones((1, robots, 2)), nobody, 3.5, np.array([0.5, 2.0]), neighbours, out)
    return out[0, 0, 12:].astype(np.float64)


def slow_neighbours(poses: Floats, speeds: Floats, neighbours: int) -> list[float]:
    velocities = speeds[:, None] * np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=1)
    ahead = np.array([math.cos(poses[0, 2]), math.sin(poses[0, 2])])
    left = np.array([-ahead[1], ahead[0]])
    told: list[float] = []
    order = sorted(range(1, len(poses)), key=lambda k: (round(math.dist(poses[k, :2], poses[0, :2]), 9), k))
    for other in order[:neighbours]:
        away, change = poses[other, :2] - poses[0, :2], velocities[other] - velocities[0]
        distance = float(np.hypot(*away))
        told += [away @ ahead / distance, away @ left / distance, distance / (distance + 2.0)]
        told += [float(change @ ahead), float(change @ left)]  # over 1 m/s
    return told + [0.0] * (5 * neighbours - len(told))


@pytest.mark.parametrize(("robots", "neighbours"), [(2, 1), (5, 3), (4, 6)])
def test_neighbours_are_told_nearest_first_in_the_robots_own_frame(robots: int, neighbours: int) -> None:
    rng = np.random.default_rng(robots)
    for _ in range(20):
        poses, speeds = rng.uniform(-3, 3, (robots, 3)), rng.uniform(-0.5, 0.5, robots)
        assert observed(poses, speeds, neighbours) == pytest.approx(
            slow_neighbours(poses, speeds, neighbours), abs=1e-6
        )


def test_of_neighbours_that_are_equally_near_none_is_left_out() -> None:
    poses = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 2.0, 0.0)])
    speeds = np.array([0.0, 0.1, 0.2, 0.3, 0.4])
    assert observed(poses, speeds, 4) == pytest.approx(slow_neighbours(poses, speeds, 4), abs=1e-6)
