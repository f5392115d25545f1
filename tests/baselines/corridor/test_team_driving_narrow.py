"""Corridors that leave a robot 2.5 cm on either side, wherever they lie on the raster: planned and driven."""

import math

import numpy as np
import pytest

import lidarena
from lidarena.baselines.corridor.team_driving import OrderedDriving, centred, steer_to
from lidarena.envs import corridor_v0
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.precedence import Precedence
from lidarena.planning.team.team_plan import TeamPlan
from lidarena.world.floorplan import Floorplan

OFFSETS = [(0.0, 0.0), (0.03, 0.07), (0.11, 0.05), (0.06, 0.13)]


def bend(width: float, offset: tuple[float, float]) -> tuple[Floorplan, tuple[float, float], tuple[float, float]]:
    """An L of two corridors 4 m long, a start and a goal in the middle of its ends."""
    x0, y0 = 1.0 + offset[0], 1.0 + offset[1]
    x1, y1, t = x0 + 4.0, y0 + 4.0, 0.1
    boxes = [
        (x0 - t, y0 - t, x1 + t, y0),
        (x1, y0, x1 + t, y1 + t),
        (x0 - t, y0, x0, y0 + width + t),
        (x0, y0 + width, x1 - width, y0 + width + t),
        (x1 - width - t, y0 + width + t, x1 - width, y1),
        (x1 - width - t, y1, x1, y1 + t),
    ]
    polygons = [np.array([(a, b), (c, b), (c, d), (a, d)]) for a, b, c, d in boxes]
    start, goal = (x0 + 0.6, y0 + 0.5 * width), (x1 - 0.5 * width, y1 - 0.6)
    return Floorplan.from_shapes("bend", (0, 0, 7, 7), polygons=polygons, start=(*start, 0.0)), start, goal


def drive(radius: float, offset: tuple[float, float], seed: int, **noise: float) -> str:
    plan, start, goal = bend(2.0 * radius + 0.05, offset)
    env = corridor_v0.parallel_env(
        map=plan, robots=1, starts=[start], goals=[goal], robot={"radius": radius}, max_cycles=1000, **noise
    )
    policy = lidarena.baselines.make("prioritized_search", env)
    _, infos = env.reset(seed=seed)
    policy.reset(seed=0)
    while env.agents:
        _, _, _, _, infos = env.step(policy.act({}, infos))
        own = infos["robot_0"] if "robot_0" in infos else next(iter(infos.values()))
        if own["success"] or own["collision"]:
            return "arrived" if own["success"] else "collision"
    return "late"


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("radius", [0.105, 0.18])
def test_a_robot_that_obeys_and_knows_where_it_is_arrives(radius: float, offset: tuple[float, float]) -> None:
    assert drive(radius, offset, 0, motion_noise=0.0, localization_noise=0.0) == "arrived"


def test_with_the_usual_noise_they_arrive_too() -> None:
    ends = [drive(radius, offset, 100 + k) for radius in (0.105, 0.18) for k, offset in enumerate(OFFSETS)]
    assert ends == ["arrived"] * 8


@pytest.mark.parametrize("offset", OFFSETS)
def test_curves_lie_in_the_middle_of_a_narrow_corridor(offset: tuple[float, float]) -> None:
    plan, start, _ = bend(0.26, offset)
    grid = FloorGrid.of(plan, 0.025, exact=True)
    row = int(grid.cells([start])[0, 0])
    columns = np.arange(*grid.cells([start, (start[0] + 2.0, start[1])])[:, 1])
    path = np.column_stack([np.full(len(columns), row), columns])
    curves, room = centred([path], grid, 0.105)
    assert room is not None and room[0].min() > 0.0
    np.testing.assert_allclose(curves[0][:, 1], start[1], atol=2e-3)


def test_on_coarse_cells_curves_are_the_cells_centres() -> None:
    plan, start, _ = bend(1.0, (0.0, 0.0))
    grid = FloorGrid.of(plan, 0.2)
    path = grid.cells([start, (start[0] + 0.2, start[1])])
    curves, room = centred([path], grid, 0.1)
    assert room is None
    np.testing.assert_array_equal(curves[0], grid.points(path))


def test_corners_are_cut_only_as_far_as_there_is_room() -> None:
    cells = np.array([(0, c) for c in range(11)] + [(r, 10) for r in range(1, 11)])
    curve = 0.025 * cells[:, ::-1].astype(np.float64)
    precedence = Precedence(TeamPlan(True, [cells], 20, 20, False, ""), 0.0)
    wide, narrow = (OrderedDriving([curve], precedence, 0.1, [np.full(21, room)]) for room in (0.5, 0.025))
    position = np.array([0.2, 0.0])
    for driving in (wide, narrow):
        driving.completed[0] = 8
    assert wide._without_cutting(0, 20, position) == 20
    assert narrow._without_cutting(0, 20, position) == 10  # the corner itself
    narrow.completed[0] = 10
    assert narrow._without_cutting(0, 20, curve[10] - (0.01, 0.0)) > 10  # nobody rests beside the corner


def test_where_it_is_narrow_a_robot_turns_before_it_drives() -> None:
    pose, target = np.zeros(3), np.array([0.3 * math.cos(0.5), 0.3 * math.sin(0.5)])
    assert steer_to(pose, target)[0] > 0.0
    assert steer_to(pose, target, turn_first=0.2)[0] == 0.0
