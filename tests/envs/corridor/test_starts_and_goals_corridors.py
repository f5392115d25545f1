"""Robots in bent corridors hardly wider than they are, wherever the cells happen to lie."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import TeamError
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.envs.corridor.starts_and_goals import StartGoalSampler
from lidarena.planning import plan_team
from lidarena.world.floorplan import Floorplan

ARM = 1.5  # length of the corridor before and after its kink [m]


def corridor(width: float, kink: float, angle: float, offset: tuple[float, float]) -> tuple[Floorplan, np.ndarray]:
    """A corridor that turns by ``kink``, itself turned by ``angle`` and shifted; its two ends."""
    middle = np.array([(0.0, 0.0), (ARM, 0.0), (ARM + ARM * math.cos(kink), ARM * math.sin(kink))])
    ahead, behind = np.array([1.0, 0.0]), np.array([math.cos(kink), math.sin(kink)])
    left, then_left = np.array([0.0, 1.0]), np.array([-behind[1], behind[0]])
    mitre = (left + then_left) * (width / 2) / (1.0 + left @ then_left)
    first, last = middle[0] - 0.3 * ahead, middle[2] + 0.3 * behind
    side, end = left * width / 2, then_left * width / 2
    corners = np.array(
        [first + side, middle[1] + mitre, last + end, last - end, middle[1] - mitre, first - side]
    )  # fmt: skip
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    corners, middle = corners @ turn.T + offset, middle @ turn.T + offset
    bounds = (*(corners.min(axis=0) - 0.1), *(corners.max(axis=0) + 0.1))
    walls = np.hstack([corners, np.roll(corners, -1, axis=0)])
    return Floorplan("bent", walls, np.empty((0, 3)), bounds, (*middle[0], angle)), middle[[0, 2]]


def keywords(plan: Floorplan, ends: np.ndarray, radius: float) -> dict:
    return {"map": plan, "robots": 1, "starts": [ends[0]], "goals": [ends[1]], "robot": {"radius": radius}}


corridors = {
    "radius": st.floats(0.08, 0.28),
    "spare": st.floats(0.05, 0.3),
    "kink": st.floats(-2.0, 2.0),
    "angle": st.one_of(st.sampled_from([0.0, math.pi / 2, math.pi, -math.pi / 2]), st.floats(-3.1, 3.1)),
    "offset": st.tuples(st.floats(0.0, 0.25), st.floats(0.0, 0.25)),
}


@settings(max_examples=30, deadline=None)
@given(**corridors)
def test_whatever_is_five_centimetres_wider_than_the_robot_is_planned_through(radius, spare, kink, angle, offset):
    plan, ends = corridor(2 * radius + spare, kink, angle, offset)
    places = StartGoalSampler(CorridorOptions.checked(keywords(plan, ends, radius)), plan)
    graph = places.grid.graph(radius)
    cells = places.grid.standing(ends, graph)
    found = plan_team(graph, cells[:1], cells[1:], "independent_astar")
    assert found.solved
    assert plan.clearance(places.grid.points(found.paths[0])).min() >= radius - 1e-3


@settings(max_examples=15, deadline=None)
@given(**(corridors | {"spare": st.floats(-0.05, -0.01)}))
def test_what_is_too_narrow_is_refused(radius, spare, kink, angle, offset):
    plan, ends = corridor(2 * radius + spare, kink, angle, offset)
    with pytest.raises(TeamError, match=r"a robot of radius .* does not fit"):
        StartGoalSampler(CorridorOptions.checked(keywords(plan, ends, radius)), plan)
