"""Bodies of teams really collide, touches are noted, and robots far from everything never bother pymunk."""

import numpy as np
import pytest

from lidarena.world.load import load_floorplan
from lidarena.world.robots import RobotSpec
from lidarena.world.team_physics import TeamPhysics

SPEC = RobotSpec(substep=0.07)
ALL = np.ones((1, 2), np.bool_)


def make(poses):
    physics = TeamPhysics(1, len(poses), SPEC)
    physics.furnish(0, load_floorplan("office"))
    physics.poses[0] = poses
    return physics


def drive(physics, commands, near, periods=20):
    touched = np.zeros((2, physics.poses.shape[1]), np.bool_)
    for _ in range(periods):
        physics.advance(np.array([commands], float), 0.2, near)
        touched |= np.concatenate([physics.touched_wall, physics.touched_robot])
    return touched


def test_two_robots_that_meet_touch_and_do_not_pass_through_each_other():
    physics = make([(5.0, 7.5, 0.0), (6.0, 7.5, np.pi)])
    touched = drive(physics, [(0.5, 0.0), (0.5, 0.0)], ALL)
    assert touched.tolist() == [[False, False], [True, True]]
    gap = np.hypot(*(physics.poses[0, 0] - physics.poses[0, 1])[:2])
    assert gap > 2 * SPEC.radius - 0.03


def test_a_wall_stops_a_robot():
    physics = make([(5.0, 8.0, np.pi / 2), (8.0, 7.5, 0.0)])
    physics.poses[0, 0, 0] = 4.0  # below a piece of the wall at y = 8.6
    touched = drive(physics, [(0.5, 0.0), (0.0, 0.0)], ALL)
    assert touched.tolist() == [[True, False], [False, False]]
    assert physics.poses[0, 0, 1] < 8.6 - SPEC.radius + 0.01


@pytest.mark.parametrize("rate", [0.0, 1.0, -2.0])
def test_gliding_ends_where_pymunk_does(rate):
    poses = [(5.0, 7.5, 0.3), (8.0, 7.5, 1.0)]
    glided, pushed = make(poses), make(poses)
    for physics, near in ((glided, ~ALL), (pushed, ALL)):
        assert not drive(physics, [(0.4, rate), (-0.2, rate)], near, 5).any()
    assert np.allclose(glided.poses, pushed.poses, atol=1e-6)


def test_a_robot_that_is_pushed_gives_way():
    physics = make([(5.0, 7.5, 0.0), (5.25, 7.5, 0.0)])
    assert drive(physics, [(0.5, 0.0), (0.0, 0.0)], ALL)[1].all()
    assert physics.poses[0, 1, 0] > 5.25


def test_touches_are_forgotten_with_the_next_step():
    physics = make([(5.0, 7.5, 0.0), (5.25, 7.5, np.pi)])
    drive(physics, [(0.5, 0.0), (0.5, 0.0)], ALL, 2)
    assert physics.touched_robot.all()
    drive(physics, [(-0.2, 0.0), (-0.2, 0.0)], ALL, 3)
    physics.advance(np.array([[(-0.2, 0.0), (-0.2, 0.0)]]), 0.2, ALL)
    assert not physics.touched_robot.any()
