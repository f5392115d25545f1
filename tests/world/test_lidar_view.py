"""Lidars that do not see all around, robots that are no discs, ranges that are too short: against slow oracles."""

import math

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.random_streams import seed_stream
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import FULL_CIRCLE, Lidar, LidarSpec, add_range_noise, first_scan, scan_is_due
from lidarena.world.load import load_floorplan
from tests.world.test_lidar import free_poses, pymunk_range, pymunk_space

VIEWS = st.sampled_from([0.3, math.pi / 2, math.pi, math.radians(270.0), 6.2, FULL_CIRCLE])
OPEN = Floorplan.from_shapes("open", (-5, -5, 5, 5), circles=[(40.0, 40.0, 0.1)], start=(0.0, 0.0, 0.0))
BOX = np.array([[0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2], [0.3, -0.2]])


@pytest.mark.parametrize("name", ["env2", "turtlebot3_world", "willow_lobby"])
@settings(max_examples=12, deadline=None)
@given(VIEWS, st.integers(4, 200), st.integers(0, 10**6))
def test_every_beam_of_a_view_agrees_with_pymunk(name: str, view: float, beams: int, seed: int) -> None:
    plan = load_floorplan(name)
    poses = free_poses(plan, 4, np.random.default_rng(seed))
    spec = LidarSpec(beams=beams, field_of_view=view)
    ranges = Lidar([plan], spec).cast(poses[:, None], np.zeros(len(poses), np.int64))[:, 0]
    space = pymunk_space(plan)
    for pose, row in zip(poses, ranges, strict=True):
        expected = [pymunk_range(space, pose[0], pose[1], pose[2] + angle, 3.5) for angle in spec.angles]
        assert row == pytest.approx(expected, abs=1e-3)


@settings(max_examples=60, deadline=None)
@given(VIEWS, st.integers(0, 10**6))
def test_beams_meet_the_outline_of_another_robot(view: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    angle, away = rng.uniform(-np.pi, np.pi), rng.uniform(0.5, 3.0)
    poses = np.array(
        [[(0.0, 0.0, rng.uniform(-3, 3)), (away * np.cos(angle), away * np.sin(angle), rng.uniform(-3, 3))]]
    )
    spec = LidarSpec(beams=61, field_of_view=view)
    ranges = Lidar([OPEN], spec).cast(poses, np.zeros(1, np.int64), math.hypot(0.3, 0.2), BOX)[0, 0]
    space = pymunk.Space()
    body = pymunk.Body(body_type=pymunk.Body.STATIC)
    body.position, body.angle = tuple(poses[0, 1, :2]), poses[0, 1, 2]
    space.add(body, pymunk.Poly(body, [tuple(corner) for corner in BOX.tolist()]))
    space.reindex_shapes_for_body(body)
    expected = [pymunk_range(space, 0.0, 0.0, poses[0, 0, 2] + beam, 3.5) for beam in spec.angles]
    assert ranges == pytest.approx(expected, abs=1e-3)


def test_what_is_nearer_than_the_least_range_reads_as_zero() -> None:
    ranges = np.array([[[0.05, 0.2, 1.0, 3.5]]])
    scans, streams = np.empty((1, 1, 4), np.float32), seed_stream(np.random.default_rng(0))[None]
    add_range_noise(0, 1, LidarSpec(4, noise=0.0, min_range=0.12), streams, ranges, scans)
    assert scans[0, 0] == pytest.approx([0.0, 0.2, 1.0, 3.5])


@pytest.mark.parametrize(("rate", "scans"), [(math.inf, 30), (5.0, 30), (2.5, 15), (2.0, 12), (0.1, 1)])
def test_a_slow_lidar_scans_at_its_rate(rate: float, scans: int) -> None:
    spec, since = LidarSpec(rate=rate), np.zeros(1)
    since[0] = first_scan(0.2, spec)
    due = [scan_is_due.py_func(0, 0.2, spec, since) for _ in range(30)]
    assert due[0] and sum(due) == scans
