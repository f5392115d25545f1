"""The lidar against pymunk's own ray query, an independent implementation."""

import math

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import seed_stream
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec, add_range_noise, see_discs
from lidarena.world.load import load_floorplan

PLANS = ["env1", "env2", "env3", "env4", "willow_lobby", "turtlebot3_world", "aws_small_house", "maze:3"]


def pymunk_space(plan: Floorplan) -> pymunk.Space:
    space = pymunk.Space()
    for x1, y1, x2, y2 in plan.edges.tolist():
        space.add(pymunk.Segment(space.static_body, (x1, y1), (x2, y2), 0.0))
    for x, y, radius in plan.circles.tolist():
        space.add(pymunk.Circle(space.static_body, radius, (x, y)))
    return space


def pymunk_range(space: pymunk.Space, x: float, y: float, angle: float, reach: float) -> float:
    end = (x + reach * math.cos(angle), y + reach * math.sin(angle))
    hit = space.segment_query_first((x, y), end, 0.0, pymunk.ShapeFilter())
    return reach if hit is None else reach * hit.alpha


def free_poses(plan: Floorplan, count: int, rng: np.random.Generator) -> np.ndarray:
    low, high = np.array(plan.bounds[:2]), np.array(plan.bounds[2:])
    raster = plan.raster(0.05)
    found: list[np.ndarray] = []
    while len(found) < count:
        point = rng.uniform(low, high)
        column, row = np.floor((point - raster.origin) / raster.resolution).astype(int)
        if not raster.solid[row, column] and raster.clearance[row, column] > 0.1:
            found.append(np.array([*point, rng.uniform(-np.pi, np.pi)]))
    return np.array(found)


@pytest.mark.parametrize("name", PLANS)
def test_every_beam_agrees_with_pymunk_within_a_millimetre(name: str) -> None:
    plan = load_floorplan(name)
    poses = free_poses(plan, 60, np.random.default_rng(7))
    lidar = Lidar([plan], LidarSpec(beams=36))
    ranges = lidar.cast(poses[:, None], np.zeros(len(poses), np.int64))[:, 0]
    space = pymunk_space(plan)
    for pose, row in zip(poses, ranges, strict=True):
        for k, value in enumerate(row):
            expected = pymunk_range(space, pose[0], pose[1], pose[2] + k * 2 * math.pi / 36, 3.5)
            assert value == pytest.approx(expected, abs=1e-3)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(*[st.floats(0.3, 9.7)] * 4), min_size=1, max_size=12),
    st.lists(st.tuples(st.floats(1, 9), st.floats(1, 9), st.floats(0.05, 0.8)), max_size=4),
    st.floats(-3.1, 3.1),
)
def test_a_ray_never_passes_a_wall(
    walls: list[tuple[float, ...]], circles: list[tuple[float, ...]], theta: float
) -> None:
    frame = [(0, 0, 10, 0), (10, 0, 10, 10), (10, 10, 0, 10), (0, 10, 0, 0)]
    plan = Floorplan.from_shapes("drawn", (0, 0, 10, 10), walls=[*frame, *walls], circles=circles, start=None)
    x, y, _ = plan.start
    ranges = Lidar([plan]).cast(np.array([[[x, y, theta]]]), np.zeros(1, np.int64))[0, 0]
    angles = theta + np.arange(360) * (2 * np.pi / 360)
    along = np.linspace(0.0, 1.0, 80)[:, None, None]
    points = np.array([x, y]) + along * ((ranges - 1e-6)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    assert (plan.clearance(points.reshape(-1, 2)) >= -1e-6).all()


def test_other_robots_are_seen_as_discs() -> None:
    plan = Floorplan.from_shapes("empty", (0, 0, 9, 9), walls=[(0, 0, 9, 0)], start=(4, 4, 0))
    poses = np.array([[[3.0, 4.0, 0.0], [5.0, 4.0, 0.0]]])
    ranges = Lidar([plan]).cast(poses, np.zeros(1, np.int64), radius=0.105)
    assert ranges[0, 0, 0] == pytest.approx(2.0 - 0.105)
    assert ranges[0, 1, 180] == pytest.approx(2.0 - 0.105)
    assert ranges[0, 0, 180] == 3.5


def test_a_robot_outside_the_drawing_sees_its_walls() -> None:
    plan = load_floorplan("env1")
    ranges = Lidar([plan]).cast(np.array([[[-2.0, 2.0, 0.0]]]), np.zeros(1, np.int64))[0, 0]
    assert ranges[0] == pytest.approx(pymunk_range(pymunk_space(plan), -2.0, 2.0, 0.0, 3.5), abs=1e-9)
    assert ranges[180] == 3.5


def test_worlds_of_one_lidar_may_have_different_plans() -> None:
    plans = [load_floorplan("env1"), load_floorplan("willow_lobby")]
    poses = np.array([[plan.start] for plan in plans])
    together = Lidar(plans).cast(poses, np.array([0, 1]))
    for k, plan in enumerate(plans):
        alone = Lidar([plan]).cast(poses[k : k + 1], np.zeros(1, np.int64))
        assert np.array_equal(together[k], alone[0])


def test_noise_has_the_stated_deviation_and_leaves_missing_returns() -> None:
    ranges = np.full((1, 1, 20000), 2.0)
    ranges[0, 0, ::2] = 3.5
    scans = np.zeros(ranges.shape, np.float32)
    add_range_noise(0, 1, LidarSpec(), seed_stream(np.random.default_rng(1))[None], ranges, scans)
    assert (scans[0, 0, ::2] == 3.5).all()
    assert scans[0, 0, 1::2].std() == pytest.approx(0.01, rel=0.05)
    assert scans[0, 0, 1::2].mean() == pytest.approx(2.0, abs=5e-4)


@settings(max_examples=40, deadline=None)
@given(st.floats(-6.0, 6.0), st.floats(-6.0, 6.0), st.floats(-3.0, 3.0), st.floats(0.05, 1.0))
def test_discs_are_seen_as_pymunk_sees_them(x: float, y: float, theta: float, radius: float) -> None:
    spec = LidarSpec(beams=24, max_range=5.0)
    space = pymunk.Space()
    space.add(pymunk.Circle(space.static_body, radius, (x, y)))
    ranges = np.full(24, spec.max_range)
    ranges[3] = 0.01  # what is nearer stays
    see_discs(np.array([0.0, 0.0, theta]), np.array([[x, y, 9.0, 9.0]]), radius, spec.directions, spec, ranges)
    assert ranges[3] == pytest.approx(0.01)
    if math.hypot(x, y) <= radius + 1e-6:
        return
    for k, angle in enumerate(spec.angles + theta):
        beside = abs(x * math.sin(angle) - y * math.cos(angle))
        if k != 3 and abs(beside - radius) > 1e-4:  # whether a beam that grazes meets the disc is a matter of rounding
            assert ranges[k] == pytest.approx(pymunk_range(space, 0.0, 0.0, float(angle), 5.0), abs=2e-3)
