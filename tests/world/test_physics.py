import math

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar
from lidarena.world.physics import Physics, may_touch
from lidarena.world.robots import RobotSpec
from lidarena.world.spaces import chord

HALL = Floorplan.from_shapes("hall", (0, 0, 20, 20), walls=[(15, 0, 15, 20)], start=(5, 5, 0))


def drive(
    speed: float, rate: float, steps: int, pose: tuple[float, float, float], far: bool, duration: float = 0.2
) -> np.ndarray:
    physics = Physics(1)
    physics.place(0, HALL, [pose])
    for _ in range(steps):
        physics.advance(np.array([[[speed, rate]]]), duration, np.array([not far]))
    return physics.poses[0, 0]


@settings(max_examples=40, deadline=None)
@given(st.floats(0.0, 0.5), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))
def test_a_robot_follows_the_arc_of_its_wheels_with_one_step_or_many(speed: float, rate: float, theta: float) -> None:
    turned = theta + 2.0 * rate
    if abs(rate) > 1e-6:
        radius = speed / rate
        x = 5 + radius * (math.sin(turned) - math.sin(theta))
        y = 5 - radius * (math.cos(turned) - math.cos(theta))
    else:
        x, y = 5 + 2.0 * speed * math.cos(theta), 5 + 2.0 * speed * math.sin(theta)
    for far in (True, False):
        pose = drive(speed, rate, 10, (5, 5, theta), far)
        assert pose[:2] == pytest.approx((x, y), abs=1e-5)
        assert math.remainder(pose[2] - turned, 2 * math.pi) == pytest.approx(0, abs=1e-9)
        assert -math.pi <= pose[2] <= math.pi


def test_a_wall_stops_the_robot() -> None:
    pose = drive(0.5, 0.0, 60, (12, 5, 0), far=False)
    assert pose[0] <= 15 - 0.05 - 0.105 + 0.02
    assert pose[0] > 14.5


def test_two_robots_cannot_share_a_place() -> None:
    physics = Physics(1, robots=2)
    physics.place(0, HALL, [(5, 5, 0), (6, 5, math.pi)])
    for _ in range(20):
        physics.advance(np.array([[[0.3, 0.0], [0.3, 0.0]]]), 0.2, np.ones(1, np.bool_))
    gap = np.hypot(*(physics.poses[0, 0, :2] - physics.poses[0, 1, :2]))
    assert gap >= 2 * 0.105 - 0.02


def test_placing_again_forgets_the_old_robot() -> None:
    physics = Physics(1)
    physics.place(0, HALL, [(5, 5, 0)])
    physics.place(0, HALL, [(7, 7, 1)])
    physics.advance(np.zeros((1, 1, 2)), 0.2, np.zeros(1, np.bool_))
    assert physics.poses[0, 0] == pytest.approx((7, 7, 1))


@settings(max_examples=60, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(-1.0, 1.0), st.floats(-3.1, 3.1), st.floats(0.04, 0.5))
def test_gliding_is_pymunks_own_step_to_the_bit(speed: float, rate: float, theta: float, duration: float) -> None:
    space, body = pymunk.Space(), pymunk.Body(1.0, 1.0)
    space.add(body, pymunk.Circle(body, 0.105))
    body.position, body.angle = (5.0, 5.0), theta
    body.velocity, body.angular_velocity = chord(theta, speed, rate, duration), rate
    space.step(duration)
    physics = Physics(1)
    physics.place(0, HALL, [(5.0, 5.0, theta)])
    physics.advance(np.array([[[speed, rate]]]), duration, np.zeros(1, np.bool_))
    assert physics.poses[0, 0, :2].tolist() == list(body.position)
    assert physics.poses[0, 0, 2] == pytest.approx(math.remainder(body.angle, 2 * math.pi), abs=1e-15)


@settings(max_examples=100, deadline=None)
@given(st.floats(13.5, 14.9), st.floats(0.2, 0.5), st.floats(-1.0, 1.0), st.floats(-3.1, 3.1))
def test_whoever_is_not_near_touches_nothing(x: float, speed: float, rate: float, theta: float) -> None:
    lidar, physics, near = Lidar([HALL]), Physics(1), np.zeros(1, np.bool_)
    physics.place(0, HALL, [(x, 5.0, theta)])
    command = np.array([[[speed, rate]]])
    ranges = lidar.cast(physics.poses, np.zeros(1, np.int64))
    may_touch(command, 0.2, 0.105, ranges, lidar.directions, near)
    centre = physics.poses[0, 0, 0]
    physics.advance(command, 0.2, np.zeros(1, np.bool_))  # as if nothing were there
    closest = HALL.clearance(np.array([[centre, 5.0], physics.poses[0, 0, :2]])).min()
    if not near[0]:
        assert closest > 0.105
    elif closest > 0.105 + 0.12:
        raise AssertionError("asks the solver although the wall is out of reach")


def test_touching_is_told_for_the_last_step_only() -> None:
    physics = Physics(2)
    for world in range(2):
        physics.place(world, HALL, [(14.7 if world else 5.0, 5.0, 0.0)])
    forward, near = np.tile([0.5, 0.0], (2, 1, 1)), np.ones(2, np.bool_)
    physics.advance(forward, 0.4, near)
    assert physics.touched.tolist() == [False, True]
    physics.advance(-forward, 0.2, near)
    physics.advance(-forward, 0.2, near)
    assert physics.touched.tolist() == [False, False]
    physics.advance(forward, 2.0, near)
    assert physics.touched[1]
    physics.place(1, HALL, [(5.0, 5.0, 0.0)])
    assert not physics.touched[1]


def test_a_world_may_have_a_body_of_its_own() -> None:
    physics = Physics(2)
    for world, spec in enumerate((None, RobotSpec(radius=1.0))):
        physics.place(world, HALL, [(12.0, 5.0, 0.0)], spec)
    for _ in range(40):
        physics.advance(np.tile([0.5, 0.0], (2, 1, 1)), 0.2, np.ones(2, np.bool_))
    assert physics.poses[:, 0, 0] == pytest.approx([14.95 - 0.105, 14.95 - 1.0], abs=0.02)
