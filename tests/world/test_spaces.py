import math

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.world.load import load_floorplan
from lidarena.world.physics import Physics
from lidarena.world.robots import RobotSpec
from lidarena.world.spaces import Spaces, add_mover, add_robot, build_space, chord, glide_one
from lidarena.world.team_physics import TeamPhysics

OFFICE, MAZE = load_floorplan("office"), load_floorplan("env1")
KINDS = [Physics, TeamPhysics]


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_keeps_what_spaces_promise(kind: type[Spaces]) -> None:
    worlds = kind(2, 2, RobotSpec(radius=0.2))
    worlds.place(1, OFFICE, [(5.0, 7.5, 0.0), (8.0, 7.5, 1.0)], RobotSpec(radius=0.3))
    assert worlds.poses[1].tolist() == [[5.0, 7.5, 0.0], [8.0, 7.5, 1.0]] and not worlds.poses[0].any()
    space = worlds._space(1)
    assert space is worlds._space(1)
    worlds.furnish(1, OFFICE)
    assert space is worlds._space(1)  # the same walls are not built again
    worlds.furnish(1, MAZE)
    assert space is not worlds._space(1)


@pytest.mark.parametrize("kind", KINDS)
def test_a_world_s_own_body_is_the_one_that_collides(kind: type[Spaces]) -> None:
    """A wall stops a large robot farther off than a small one."""
    stops = []
    for radius in (0.1, 0.25):
        worlds = kind(1, 1, RobotSpec(radius=0.1))
        worlds.place(0, OFFICE, [(4.0, 8.0, math.pi / 2)], RobotSpec(radius=radius))
        near = np.ones((1, 1) if kind is TeamPhysics else 1, np.bool_)
        for _ in range(15):
            worlds.advance(np.array([[[0.5, 0.0]]]), 0.2, near)  # type: ignore[attr-defined]
        stops.append(float(worlds.poses[0, 0, 1]))
    assert stops[0] - stops[1] == pytest.approx(0.15, abs=0.03)


def test_walls_and_pillars_become_shapes() -> None:
    space = build_space(OFFICE)
    assert len(space.shapes) == len(OFFICE.edges) + len(OFFICE.circles)
    assert isinstance(add_robot(space, RobotSpec()), pymunk.Body) and len(space.bodies) == 1


@settings(max_examples=50, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))
def test_a_chord_ends_where_the_arc_ends(heading: float, speed: float, rate: float) -> None:
    vx, vy = chord(heading, speed, rate, 0.2)
    n = 4000
    angles = heading + rate * 0.2 * (np.arange(n) + 0.5) / n
    assert (vx, vy) == pytest.approx((speed * np.cos(angles).mean(), speed * np.sin(angles).mean()), abs=1e-6)


@settings(max_examples=50, deadline=None)
@given(st.floats(-3.1, 3.1), st.floats(-1.0, 1.0), st.floats(-9.0, 9.0))
def test_gliding_keeps_the_heading_within_a_turn(heading: float, speed: float, rate: float) -> None:
    pose = np.array([1.0, 2.0, heading])
    glide_one(np.array([speed, rate]), 0.5, pose)
    assert -math.pi <= pose[2] <= math.pi
    assert math.cos(pose[2] - heading - 0.5 * rate) == pytest.approx(1.0)
    assert math.hypot(pose[0] - 1.0, pose[1] - 2.0) <= 0.5 * abs(speed) + 1e-9


def test_a_mover_goes_on_at_its_speed_whatever_it_meets() -> None:
    space = build_space(load_floorplan("env1"))
    robot = add_robot(space, RobotSpec(radius=0.1))
    robot.position = (0.35, 0.0)
    mover = add_mover(space, 0.0, 0.0, 1.0, 0.0, 0.2)
    for _ in range(51):
        space.step(0.01)
    assert mover.position.x == pytest.approx(0.5, abs=1e-6) and mover.position.y == 0.0
    assert robot.position.x > 0.6  # it was pushed on
