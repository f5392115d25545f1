"""One kernel that measures everything, against its parts called one after the other."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import seed_stream
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec, add_range_noise
from lidarena.world.odometry import OdometryNoise, move, read_odometry
from lidarena.world.sensors import Sensing, Sensors, empty_sensors, sense

HALL = Floorplan.from_shapes(
    "hall", (0, 0, 6, 4), walls=[(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)], start=(3, 2, 0)
)
SPEC, BUMPER = LidarSpec(noise=0.02), 0.4
LIDAR = Lidar([HALL], SPEC)
WORLDS = 2


def measure(
    sensors: Sensors, w: int, before: np.ndarray, after: np.ndarray, streams: np.ndarray, noise: OdometryNoise
) -> None:
    plan = np.zeros(WORLDS, np.int64)
    place = (SPEC, BUMPER, LIDAR.geometry, LIDAR.directions)
    sense(w, Sensing(before, after, plan, streams, noise, *place, sensors, 0.2))


def ways(seed: int, steps: int) -> np.ndarray:
    """Poses (steps, worlds, 1, 3) of two robots in the hall."""
    rng = np.random.default_rng(seed)
    return rng.uniform((0.2, 0.2, -3.1), (5.8, 3.8, 3.1), (steps, WORLDS, 1, 3))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 5))
def test_a_measurement_is_that_of_odometry_lidar_and_bumper(seed: int, steps: int) -> None:
    poses, noise = ways(seed, steps), OdometryNoise()
    streams = np.stack([seed_stream(np.random.default_rng(seed + k)) for k in range(WORLDS)])
    again, sensors = streams.copy(), empty_sensors(WORLDS, SPEC.beams)
    readings, scans, reckoned = np.zeros((WORLDS, 1, 3)), np.zeros((WORLDS, 1, SPEC.beams), np.float32), np.zeros(3)
    way = true_way = 0.0
    for before, after in pairwise(poses):
        measure(sensors, 1, before, after, streams, noise)
        read_odometry(1, 2, before, after, noise, again, readings)
        ranges = LIDAR.cast(after, np.zeros(WORLDS, np.int64))
        add_range_noise(1, 2, SPEC, again, ranges, scans)
        move(reckoned, *readings[1, 0].tolist())
        way += math.hypot(*readings[1, 0, :2])
        true_way += math.dist(before[1, 0, :2], after[1, 0, :2])
        np.testing.assert_array_equal(sensors.ranges[1], ranges[1])
        np.testing.assert_array_equal(sensors.scans[1], scans[1])
        np.testing.assert_array_equal(sensors.readings[1], readings[1])
        assert sensors.collision[1] == (ranges[1].min() < BUMPER)
    np.testing.assert_allclose(sensors.dead_reckoning[1, 0], reckoned, atol=1e-12)
    assert sensors.path_length[1] == pytest.approx(way) and sensors.true_path_length[1] == pytest.approx(true_way)
    np.testing.assert_array_equal(streams, again)
    for array in sensors:  # the other world was not touched
        assert not array[0].any()


def test_without_noise_the_robot_reckons_its_own_way() -> None:
    poses = ways(3, 6)
    streams = np.stack([seed_stream(np.random.default_rng(k)) for k in range(WORLDS)])
    sensors = empty_sensors(WORLDS, SPEC.beams)
    sensors.dead_reckoning[0, 0] = poses[0, 0, 0]
    for before, after in pairwise(poses):
        measure(sensors, 0, before, after, streams, OdometryNoise().scaled(0.0))
        np.testing.assert_allclose(sensors.dead_reckoning[0, 0], after[0, 0], atol=1e-9)
    assert sensors.path_length[0] == pytest.approx(sensors.true_path_length[0])
