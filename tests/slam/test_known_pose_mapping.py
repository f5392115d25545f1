"""Mapping with known poses: which scans are traced, and that nothing else is."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.estimator import EstimatorSettings
from lidarena.slam.known_pose_mapping import KnownPoseEstimator, map_scan
from lidarena.slam.occupancy import empty_maps, trace_scan
from lidarena.slam.readings import Reading, ScanGeometry
from lidarena.slam.true_pose import TruePoseEstimator
from lidarena.world.lidar import LidarSpec
from lidarena.world.odometry import OdometryNoise

BEAMS, ROWS, COLUMNS, REACH = 24, 60, 80, 3.5
ANGLES = np.arange(BEAMS) * (2 * math.pi / BEAMS)
DIRECTIONS = np.stack([np.cos(ANGLES), np.sin(ANGLES)])
WANTED = np.ones((1, ROWS, COLUMNS), np.uint8)
LIDAR = LidarSpec(beams=BEAMS, max_range=REACH)
RNG = np.random.default_rng(0)
MOTION = st.tuples(st.floats(-0.7, 0.7), st.floats(-0.3, 0.3), st.floats(-0.15, 0.15), st.sampled_from([0.05, 0.2]))


def mapper(worlds: int = 1) -> KnownPoseEstimator:
    made = TruePoseEstimator(EstimatorSettings(worlds, WANTED, DIRECTIONS, LIDAR, 0.05, OdometryNoise()))
    for world in range(worlds):
        made.start(world, 0, np.zeros(2), np.zeros(3), RNG)
    return made


def feed(
    made: KnownPoseEstimator, reading: np.ndarray, scan: np.ndarray, pose: np.ndarray, seconds: float, world: int = 0
) -> None:
    measured, geometry = Reading(seconds, reading, scan, True), ScanGeometry(DIRECTIONS, REACH, 0.05)
    map_scan(world, measured, geometry, made.parameters, pose, made.since, made.maps, made.outlines, 0)


def random_scans(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Scans (count, beams) and the poses (count, 3) that they are taken at."""
    rng = np.random.default_rng(seed)
    poses = np.column_stack([rng.uniform(0.5, 3.5, count), rng.uniform(0.5, 2.5, count), rng.uniform(-3, 3, count)])
    return rng.uniform(0.2, 4.0, (count, BEAMS)).astype(np.float32), poses


def is_due(since: list[float]) -> bool:
    return since[0] >= 1.0 or since[1] >= 0.2 or since[2] > 0.5


@settings(max_examples=30, deadline=None)
@given(st.lists(MOTION, min_size=1, max_size=12), st.integers(0, 10**6))
def test_a_scan_is_traced_after_a_metre_a_turn_or_a_while(motions: list[tuple[float, ...]], seed: int) -> None:
    made, alone = mapper(), empty_maps(1, WANTED)
    scans, poses = random_scans(len(motions), seed)
    since = [math.inf] * 3  # the first one is always due
    for motion, scan, pose in zip(motions, scans, poses, strict=True):
        dx, dy, turn, seconds = motion
        feed(made, np.array([dx, dy, turn]), scan, pose, seconds)
        since = [since[0] + math.hypot(dx, dy), since[1] + abs(turn), since[2] + seconds]
        if is_due(since):
            trace_scan(alone, 0, 0.05, pose, scan, DIRECTIONS, REACH, 1, made.outlines, 0)
            since = [0.0] * 3
        assert made.since[0] == pytest.approx(since)
        assert np.array_equal(made.maps.visits, alone.visits)
    assert np.array_equal(made.maps.occupancy, alone.occupancy)
    assert made.maps.covered[0] == (made.maps.occupancy[0] >= 0).sum()


def test_the_noise_of_the_odometry_moves_nothing_on_the_map() -> None:
    scans, poses = random_scans(1, 0)
    maps = []
    for reading in (np.zeros(3), np.array([5.0, -3.0, 2.0])):
        made = mapper()
        feed(made, reading, scans[0], poses[0], 1.0)
        maps.append(made.maps.visits.copy())
    assert np.array_equal(*maps) and maps[0].any()


def test_each_world_has_its_own_map_and_its_own_rule() -> None:
    made = mapper(3)
    scans, poses = random_scans(1, 1)
    feed(made, np.zeros(3), scans[0], poses[0], 0.2, world=1)
    assert not made.maps.visits[[0, 2]].any() and made.maps.visits[1].any()
    assert made.since[1].tolist() == [0.0] * 3 and np.isinf(made.since[[0, 2]]).all()


def test_starting_again_forgets_the_map_and_traces_the_next_scan() -> None:
    made = mapper()
    scans, poses = random_scans(2, 2)
    feed(made, np.zeros(3), scans[0], poses[0], 0.1)
    feed(made, np.zeros(3), scans[1], poses[1], 0.1)  # not due
    first = made.maps.visits.copy()
    made.start(0, 0, np.array([-1.0, -2.0]), poses[0], RNG)
    assert not made.maps.visits.any() and (made.maps.occupancy == -1).all() and made.maps.covered[0] == 0
    feed(made, np.zeros(3), scans[0], poses[0] - (1.0, 2.0, 0.0), 0.1)
    assert made.maps.origin[0].tolist() == [-1.0, -2.0]
    assert (made.maps.visits > 0).sum() == pytest.approx((first > 0).sum(), rel=0.02)  # the same but for roundings
