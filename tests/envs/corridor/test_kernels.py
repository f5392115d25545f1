"""The kernels of the multi-robot worlds against slow oracles: ways, wheels, who is near something."""

import heapq
import math

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.envs.corridor.kernels import (
    LOOK_AHEAD,
    Ground,
    MotionNoise,
    apply_motion_noise,
    distance_to_goal,
    find_near,
)
from lidarena.world.load import load_floorplan
from tests.envs.corridor.corridor_worlds import EXACT, begin, gaps

Floats = NDArray[np.float64]
PERIOD = 0.2


def streams(worlds: int, seed: int = 0) -> NDArray[np.uint64]:
    return np.stack([seed_stream(np.random.default_rng([seed, world])) for world in range(worlds)])


def cheapest_ways(name: str, goal: Floats, origin: Floats, shape: tuple[int, int]) -> Floats:
    """Dijkstra from the goal's cell, as the documents say: beside walls dearer, no nearer to them than 3 cm."""
    (rows, cols), cell, radius = shape, 0.2, 0.105
    y, x = np.mgrid[:rows, :cols]
    centres = np.stack([x.ravel() + 0.5, y.ravel() + 0.5], axis=1) * cell + origin
    beyond = load_floorplan(name).clearance(centres).reshape(shape) - radius
    price = np.where(beyond < 0.03, np.inf, 1.0 + 1.5 * np.clip(1.0 - beyond / 0.4, 0.0, 1.0))
    col, row = ((goal - origin) / cell).astype(int)
    ways = np.full(shape, np.inf)
    ways[row, col] = 0.0
    queue = [(0.0, int(row), int(col))]
    while queue:
        spent, r, c = heapq.heappop(queue)
        for dr, dc in [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)]:
            if not (0 <= r + dr < rows and 0 <= c + dc < cols):
                continue
            if not (np.isfinite(price[r + dr, c]) and np.isfinite(price[r, c + dc])):
                continue  # no corner is cut
            new = spent + math.hypot(dr, dc) * cell * price[r + dr, c + dc]
            if new < ways[r + dr, c + dc] - 1e-9:
                ways[r + dr, c + dc] = new
                heapq.heappush(queue, (float(new), r + dr, c + dc))
    return ways


def test_the_way_that_remains_is_the_cheapest_past_the_walls() -> None:
    places = {"starts": [(0.9, 0.7), (5.1, 1.9), (8.3, 0.5)], "goals": [(9.5, 0.7), (1.3, 0.7), (5.3, 2.3)]}
    episodes = begin(map="passing", robots=3, **EXACT, **places)
    core = episodes.core
    for robot in range(3):
        ground = core.ground
        ways = cheapest_ways("passing", core.goals[0, robot], ground.origin, core.fields.shape[2:])
        x, y = core.starts[0, robot]
        row, col = int((y - ground.origin[1]) / 0.2), int((x - ground.origin[0]) / 0.2)
        around = [(r, c) for r in (row - 1, row, row + 1) for c in (col - 1, col, col + 1)]
        least = min(
            ways[r, c] + math.hypot(ground.origin[0] + (c + 0.5) * 0.2 - x, ground.origin[1] + (r + 0.5) * 0.2 - y)
            for r, c in around
        )
        assert core.measurements.remaining[0, robot] == pytest.approx(least, rel=1e-5)
        assert np.allclose(np.where(core.fields[0, robot] < 1e9, core.fields[0, robot], np.inf), ways, rtol=1e-4)


def slope(rows: int = 9, cols: int = 12) -> tuple[NDArray[np.float32], Ground]:
    """Ways that lead straight to the left, in cells of 0.5 m, around the cell in the lower-left corner."""
    field = np.repeat(0.5 * np.arange(cols, dtype=np.float32)[None], rows, axis=0)
    empty = np.zeros((1, 1), np.float32)
    return field, Ground(empty, np.zeros(2), 1.0, np.array([-1.0, 2.0]), 0.5)


def test_the_lookahead_point_lies_some_cells_ahead_on_the_way() -> None:
    field, ground = slope()
    lookahead_point = np.empty(2)
    length = distance_to_goal(field, np.array([-0.75, 4.25]), 4.25, 4.25, ground, 0.0, lookahead_point)
    assert length == pytest.approx(5.0)  # from the left neighbour on: 4.5 m, and half a metre to it
    assert lookahead_point[0] == pytest.approx(4.25 - 0.5 * (LOOK_AHEAD + 1))


def test_near_the_goal_the_way_is_straight_and_the_lookahead_point_is_the_goal() -> None:
    field, ground = slope()
    goal, lookahead_point = np.array([1.0, 4.0]), np.empty(2)
    assert distance_to_goal(field, goal, 1.6, 4.7, ground, 0.0, lookahead_point) == pytest.approx(math.hypot(0.6, 0.7))
    assert lookahead_point.tolist() == goal.tolist()


@pytest.mark.parametrize("point", [(3.0, 4.0), (99.0, 99.0)], ids=["walled in", "outside"])
def test_where_no_way_begins_the_length_stays_what_it_was(point: tuple[float, float]) -> None:
    field, ground = slope()
    field[1:7, 5:11] = 1e9
    goal, lookahead_point = np.array([-0.75, 4.25]), np.empty(2)
    assert distance_to_goal(field, goal, *point, ground, 7.25, lookahead_point) == 7.25
    assert lookahead_point.tolist() == goal.tolist()


def noisy_motion(
    command: tuple[float, float], noise: MotionNoise, stall_rate: float = 0.0, steps: int = 1500, robots: int = 40
) -> Floats:
    """What wheels do (steps, robots, 2) when told the same over and over."""
    own, speed_bias, stalled = streams(1), np.zeros((1, robots)), np.zeros((1, robots))
    record = np.empty((steps, robots, 2))
    for step in range(steps):
        commands = np.tile(np.array(command), (1, robots, 1))
        apply_motion_noise(commands, PERIOD, noise, stall_rate, own, speed_bias, stalled)
        record[step] = commands[0]
    return record


def test_wheels_without_noise_do_what_they_are_told() -> None:
    record = noisy_motion((0.37, -1.1), MotionNoise().scaled(0.0), steps=5)
    assert (record == np.array([0.37, -1.1])).all()


def test_a_robot_that_is_told_to_stand_stands() -> None:
    assert not noisy_motion((0.0, 0.0), MotionNoise().scaled(10.0), steps=50).any()


def test_noise_turns_no_robot_round() -> None:
    assert (noisy_motion((0.5, 0.0), MotionNoise().scaled(10.0), steps=100)[..., 0] >= 0.0).all()
    assert (noisy_motion((-0.5, 0.0), MotionNoise().scaled(10.0), steps=100)[..., 0] <= 0.0).all()


def test_speeds_and_turn_rates_scatter_as_the_model_says() -> None:
    noise = MotionNoise(speed_bias=0.15, memory=4.0, speed=0.1, turn=0.1, yaw_noise=0.15)
    record = noisy_motion((0.5, 1.0), noise)[200:]  # the errors begin at 0 here
    assert record[..., 0].mean() == pytest.approx(0.5, rel=0.03)
    assert record[..., 0].std() == pytest.approx(0.5 * math.hypot(0.15, 0.1), rel=0.08)
    assert record[..., 1].mean() == pytest.approx(1.0, abs=0.01)
    assert record[..., 1].std() == pytest.approx(0.1 * 1.0 + 0.15 * 0.5, rel=0.05)
    speed = record[..., 0] - record[..., 0].mean()
    at_once, later = (speed[:-20] * speed[20:]).mean(), (speed[:-60] * speed[60:]).mean()
    assert at_once == pytest.approx((0.5 * 0.15) ** 2 * math.exp(-4.0 / 4.0), rel=0.3)  # 20 periods are 4 s
    assert later == pytest.approx((0.5 * 0.15) ** 2 * math.exp(-12.0 / 4.0), abs=4e-4)


def test_robots_stall_as_often_and_as_long_as_the_model_says() -> None:
    still = noisy_motion((0.5, 0.3), MotionNoise().scaled(0.0), stall_rate=0.1)[..., 0] == 0.0
    begun = (still[1:] & ~still[:-1]).sum()
    moving = (~still[:-1]).sum() * PERIOD
    assert begun / moving == pytest.approx(0.1, rel=0.1)
    assert still.sum() * PERIOD / begun == pytest.approx(3.0 + PERIOD / 2, rel=0.12)


def scattered(worlds: int, robots: int) -> tuple[Floats, Floats]:
    """Poses where a robot fits, no two overlapping, and commands of all kinds."""
    plan, rng = load_floorplan("unstructured"), np.random.default_rng(5)
    points = rng.uniform((0.2, 0.2), (13.8, 11.8), (4000, 2))
    points = points[plan.clearance(points) > 0.106]
    poses = np.empty((worlds, robots, 3))
    for world in range(worlds):
        centre = points[rng.integers(len(points))]
        near = points[np.hypot(*(points - centre).T) < 1.5]
        chosen = [centre]
        for point in near[rng.permutation(len(near))]:
            if len(chosen) < robots and np.hypot(*(np.array(chosen) - point).T).min() > 0.2101:
                chosen.append(point)
        while len(chosen) < robots:
            chosen.append(np.array([90.0 + len(chosen), 90.0]))  # far from everything
        poses[world, :, :2], poses[world, :, 2] = chosen, rng.uniform(-np.pi, np.pi, robots)
    speeds = rng.uniform(-0.5, 0.6, (worlds, robots)) * (rng.random((worlds, robots)) < 0.8)
    return poses, np.stack([speeds, rng.uniform(-2, 2, speeds.shape)], axis=-1)


def test_whoever_is_not_near_anything_touches_nothing_on_the_way() -> None:
    core = begin(map="unstructured", robots=1).core
    plan, (poses, commands) = core.plan, scattered(120, 6)
    near = np.zeros(poses.shape[:2], np.bool_)
    find_near(commands, PERIOD, 0.105, False, poses, core.ground, near)
    half_turn = poses[..., 2] + 0.5 * PERIOD * commands[..., 1]
    bend = np.sinc(0.5 * PERIOD * commands[..., 1] / np.pi)
    reach = (PERIOD * commands[..., 0] * bend)[..., None] * np.stack([np.cos(half_turn), np.sin(half_turn)], axis=-1)
    for share in np.linspace(0.0, 1.0, 9):
        here = poses[..., :2] + share * reach
        assert plan.clearance(here[~near]).min() >= 0.105
        apart = gaps(here)
        assert (apart[~near] >= 0.21).all()
    assert 0.1 < near.mean() < 0.9


def test_whoever_a_pushed_robot_could_reach_is_near_too() -> None:
    core = begin(map="unstructured", robots=1).core
    poses, commands = scattered(120, 6)
    near = np.zeros(poses.shape[:2], np.bool_)
    find_near(commands, PERIOD, 0.105, False, poses, core.ground, near)
    fastest = np.abs(commands[..., 0]).max(axis=1)
    reach = 2.0 * (0.105 + PERIOD * fastest) + 0.02
    close = gaps(poses) < reach[:, None, None] - 1e-9
    assert not (close & near[:, :, None] & ~near[:, None, :]).any()


def test_robots_in_the_open_and_robots_at_rest_are_near_nothing() -> None:
    core = begin(robots=1).core
    poses = np.array([[(5.0, 7.5, 0.0), (6.0, 7.5, 0.0), (10.0, 6.5, 0.0), (10.211, 6.5, 0.0)]])
    commands = np.array([[(0.5, 0.0), (0.5, 0.0), (0.0, 1.0), (0.0, 0.0)]])
    near = np.ones((1, 4), np.bool_)
    find_near(commands, PERIOD, 0.105, False, poses, core.ground, near)
    assert not near.any()
