"""What robots do and see in the multi-robot worlds: bodies stay apart, walls hold, rays end where things are."""

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.envs.corridor.episodes import CorridorEpisodes
from tests.envs.corridor.corridor_worlds import EXACT, begin, gaps

Floats = NDArray[np.float64]
EXACT_24 = EXACT | {"lidar": {"noise": 0.0, "beams": 24}}
TOLERANCE = 0.04
"""Bodies may overlap so little for a moment, until the physics has pushed them apart [m]."""


def restless(episodes: CorridorEpisodes, steps: int, seed: int = 0, least_speed: float = 0.3) -> list[Floats]:
    """Let everybody drive about, mostly ahead; the true poses (worlds, robots, 3) before and after every step."""
    rng, shape = np.random.default_rng(seed), episodes.finished.shape
    seen, turns = [episodes.core.physics.poses.copy()], np.zeros(shape)
    for step in range(steps):
        if step % 8 == 0:
            turns = rng.uniform(-0.6, 0.6, shape)
        episodes.step(np.stack([rng.uniform(least_speed, 1.0, shape), turns], axis=-1))
        seen.append(episodes.core.physics.poses.copy())
    return seen


@pytest.mark.parametrize("name", ["office", "unstructured"])
def test_robots_overlap_neither_each_other_nor_walls_nor_pass_through_them(name: str) -> None:
    episodes = begin(
        2, map=name, robots=8, places="random", robot={"radius": 0.2}, collision_ends=False, max_episode_steps=None
    )
    seen = np.stack(restless(episodes, 80))
    assert gaps(seen).min() > 0.4 - TOLERANCE
    for share in (0.25, 0.5, 0.75, 1.0):
        points = seen[:-1] + share * np.diff(seen, axis=0)
        assert episodes.core.plan.clearance(points[..., :2].reshape(-1, 2)).min() > 0.2 - TOLERANCE
    assert episodes.touches.sum() > 20  # there was something to overlap with


def test_a_touch_is_noted_if_and_only_if_something_is_there() -> None:
    episodes = begin(3, robots=8, map="unstructured", places="random", collision_ends=False, motion_noise=2.0)
    touched = 0
    for step in range(60):
        restless(episodes, 1, seed=step)
        physics = episodes.core.physics
        apart = gaps(physics.poses).min(axis=-1) - 0.21
        beside = episodes.core.plan.clearance(physics.poses[..., :2].reshape(-1, 2)).reshape(apart.shape) - 0.105
        assert (apart[physics.touched_robot] < 0.11).all()  # it may have driven on for a period
        assert (beside[physics.touched_wall] < 0.11).all()
        assert (physics.touched_robot | physics.touched_wall)[(apart < -2e-3) | (beside < -2e-3)].all()
        touched += int(physics.touched_wall.sum() + physics.touched_robot.sum())
    assert touched > 5


@pytest.mark.parametrize(("speed", "turn"), [(1.0, 0.0), (0.6, 0.5), (-0.8, -1.0), (0.0, 1.0)])
def test_wheels_that_obey_drive_arcs(speed: float, turn: float) -> None:
    episodes = begin(robots=1, starts=[(5.0, 7.5)], goals=[(17.0, 7.5)], **EXACT)
    episodes.core.physics.poses[0, 0, 2] = 0.4
    for _ in range(5):
        episodes.step(np.array([[(speed, turn)]]))
    pose = np.array([5.0, 7.5, 0.4])
    for _ in range(10_000):  # a second in tiny steps
        pose += 1e-4 * np.array([0.5 * speed * np.cos(pose[2]), 0.5 * speed * np.sin(pose[2]), 2.0 * turn])
    pose[2] = (pose[2] + np.pi) % (2.0 * np.pi) - np.pi
    assert episodes.core.physics.poses[0, 0] == pytest.approx(pose, abs=2e-4)
    assert episodes.core.measurements.velocity[0, 0] == pytest.approx([0.5 * speed, 2.0 * turn], abs=1e-2)
    assert episodes.core.travelled[0, 0] == pytest.approx(abs(0.5 * speed), abs=5e-3)


@pytest.mark.parametrize("name", ["office", "unstructured"])
def test_a_ray_passes_neither_a_wall_nor_a_robot_and_ends_at_one(name: str) -> None:
    episodes = begin(2, map=name, robots=8, places="random", robot={"radius": 0.2}, collision_ends=False, **EXACT_24)
    restless(episodes, 25)
    core = episodes.core
    met_robots = 0
    for world, robot in itertools.product(range(2), range(8)):
        pose, ranges = core.physics.poses[world, robot], core.measurements.ranges[world, robot]
        angles = pose[2] + np.arange(24) * (2.0 * np.pi / 24)
        rays = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        others = np.delete(core.physics.poses[world, :, :2], robot, axis=0)
        shares = np.linspace(0.0, 1.0, 120)[:, None, None]
        points = pose[:2] + shares * (ranges - 1e-6)[:, None] * rays
        assert core.plan.clearance(points.reshape(-1, 2)).min() > -1e-7
        assert np.hypot(*(points[:, :, None] - others).transpose(3, 0, 1, 2)).min() > 0.2 - 1e-7
        met = ranges < 3.5
        ends = (pose[:2] + ranges[:, None] * rays)[met]
        at_wall = np.abs(core.plan.clearance(ends)) < 1e-6
        at_robot = np.abs(np.hypot(*(ends[:, None] - others).transpose(2, 0, 1)).min(axis=1) - 0.2) < 1e-6
        assert (at_wall | at_robot).all() and met.any()
        met_robots += int(at_robot.sum())
    assert met_robots > 0


@pytest.mark.parametrize("gap", [0.02, 0.1, 0.2, 0.4, 1.0])
def test_closeness_falls_from_one_at_a_touch_to_nothing_at_two_radii(gap: float) -> None:
    episodes = begin(
        robots=2, starts=[(5.0, 7.5), (5.2 + gap, 7.5)], goals=[(1.0, 7.5), (9.0, 7.5)], robot={"radius": 0.1}, **EXACT
    )
    assert episodes.core.measurements.closeness[0] == pytest.approx(2 * [max(1.0 - gap / 0.2, 0.0)], abs=1e-9)


def test_scans_and_poses_scatter_around_the_truth() -> None:
    episodes = begin(20, robots=6, places="random", lidar={"noise": 0.05}, localization_noise=0.03)
    core = episodes.core
    seen = core.measurements.ranges < 3.3  # no range is measured beyond the lidar's reach
    error = (core.measurements.scans - core.measurements.ranges)[seen & (core.measurements.ranges > 0.3)]
    assert error.std() == pytest.approx(0.05, rel=0.1) and abs(error.mean()) < 0.01
    stray = core.measurements.measured - core.physics.poses
    stray[..., 2] = np.angle(np.exp(1j * stray[..., 2]))
    assert stray.std() == pytest.approx(0.03, rel=0.15) and abs(stray.mean()) < 0.005
    assert (core.measurements.scans <= np.float32(3.5)).all() and (core.measurements.scans >= 0.0).all()


def test_robots_begin_at_rest_on_their_starts_facing_along_their_way() -> None:
    episodes = begin(4, map="unstructured", robots=6, **EXACT)
    core = episodes.core
    assert np.array_equal(core.physics.poses[..., :2], core.starts) and not core.measurements.velocity.any()
    bearing = np.arctan2(*(core.measurements.lookahead_point - core.starts).transpose(2, 0, 1)[::-1])
    assert np.allclose(np.angle(np.exp(1j * (core.physics.poses[..., 2] - bearing))), 0.0, atol=1e-9)
    assert (core.measurements.remaining >= 0.9 * np.hypot(*(core.goals - core.starts).transpose(2, 0, 1))).all()


@pytest.mark.parametrize("start", [(0.9, 0.6), (0.9, 0.7)])
def test_a_way_that_is_just_wide_enough_is_a_way(start: tuple[float, float]) -> None:
    """In a corridor of 0.8 m a robot of 0.29 m has no 3 cm to spare in any cell; its way is no less a way."""
    episodes = begin(map="passing", robots=1, robot={"radius": 0.29}, starts=[start], goals=[(3.5, 0.6)], **EXACT)
    remaining = first = float(episodes.core.measurements.remaining[0, 0])
    assert 2.6 <= remaining < 2.5 * 2.6 + 1.0
    for _ in range(20):
        rewards, _, _ = episodes.step(np.array([[(1.0, 0.0)]]))
        assert abs(rewards[0, 0]) < 12.0
        assert episodes.core.measurements.remaining[0, 0] <= remaining + 0.3
        remaining = float(episodes.core.measurements.remaining[0, 0])
    assert first - remaining > 1.5  # of the 2 m that it drove


def test_robots_in_different_worlds_know_nothing_of_each_other() -> None:
    places = {"robots": 1, "starts": [(5.0, 7.5)], "goals": [(9.0, 7.5)], "collision_ends": False} | EXACT
    together, alone = begin(2, **places), begin(1, **places)
    together.step(np.array([[(1.0, 0.0)], [(-0.5, 0.0)]]))
    alone.step(np.array([[(1.0, 0.0)]]))
    assert np.array_equal(together.core.measurements.ranges[0], alone.core.measurements.ranges[0])
    assert not together.touches.any()
