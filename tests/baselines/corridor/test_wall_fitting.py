"""Poses laid onto the walls: against the truth in bent corridors, whatever was believed, and beside other robots."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import lidarena
from lidarena.baselines.corridor.robot_interface import FleetState
from lidarena.baselines.corridor.wall_fitting import WallTracker, fit_to_walls
from lidarena.envs import corridor_v0
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.world.lidar import LidarSpec
from tests.envs.corridor.test_starts_and_goals_corridors import corridor, corridors

LIDAR = LidarSpec(beams=36, max_range=3.5, noise=0.0)


def scan_of(walls: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """What beams measure among segments (n, 4), by the intersection of lines."""
    ranges = np.full(LIDAR.beams, LIDAR.max_range)
    for k, (cos, sin) in enumerate(LIDAR.directions.T):
        way = np.array(
            [cos * math.cos(pose[2]) - sin * math.sin(pose[2]), cos * math.sin(pose[2]) + sin * math.cos(pose[2])]
        )
        for wall in walls:
            a, along = wall[:2] - pose[:2], wall[2:] - wall[:2]
            across = way[0] * along[1] - way[1] * along[0]
            if abs(across) > 1e-12:
                t = (a[0] * along[1] - a[1] * along[0]) / across
                s = (a[0] * way[1] - a[1] * way[0]) / across
                if t > 0.0 and 0.0 <= s <= 1.0:
                    ranges[k] = min(ranges[k], t)
    return ranges


believed = st.tuples(st.floats(-0.02, 0.02), st.floats(-0.02, 0.02), st.floats(-0.05, 0.05))


@settings(max_examples=40, deadline=None)
@given(**(corridors | {"spare": st.floats(0.05, 0.12)}), off=believed, share=st.floats(0.1, 0.9))
@example(0.125, 0.0625, -2.0, 0.0, (0.0, 0.0), (0.0, 0.0, 0.046875), 0.25)  # a long beam meets another wall
def test_a_pose_in_a_corridor_is_found_across_it(radius, spare, kink, angle, offset, off, share):
    plan, ends = corridor(2 * radius + spare, kink, angle, offset)
    grid = FloorGrid.of(plan, 0.025, exact=True)
    truth = np.array([*(ends[0] + 1.5 * share * np.array([math.cos(angle), math.sin(angle)])), angle + off[2]])
    fitted = fit_to_walls(truth + off, scan_of(plan.edges, truth), LIDAR.directions, LIDAR.max_range, grid)
    across = np.array([-math.sin(angle), math.cos(angle)])
    assert abs((fitted - truth)[:2] @ across) < 0.006
    assert abs(math.remainder(fitted[2] - truth[2], 2 * math.pi)) < 0.03


def test_what_is_no_wall_counts_for_nothing() -> None:
    plan, _ = corridor(0.3, 0.7, 0.0, (0.0, 0.0))
    grid, truth = FloorGrid.of(plan, 0.025, exact=True), np.array([0.7, 0.0, 0.0])
    scan = scan_of(plan.edges, truth)
    blocked = scan.copy()
    blocked[[0, 1, -1]] = 0.3  # another robot ahead
    fitted = [fit_to_walls(truth + 0.01, s, LIDAR.directions, LIDAR.max_range, grid) for s in (scan, blocked)]
    assert abs(fitted[0][1]) < 0.006 and abs(fitted[1][1]) < 0.006
    nothing = np.full(LIDAR.beams, LIDAR.max_range)
    np.testing.assert_array_equal(fit_to_walls(truth, nothing, LIDAR.directions, LIDAR.max_range, grid), truth)


def test_where_there_is_room_localisation_is_believed() -> None:
    fleet: Any = SimpleNamespace(lidar=LIDAR, period=0.2)
    grid = FloorGrid(np.zeros((4, 4), np.bool_), (0.0, 0.0), 0.2)
    state = FleetState(np.ones((1, 3)), np.zeros((1, 2)), np.ones(1, np.bool_), np.zeros(1, np.bool_), 0.0)
    tracker = WallTracker(fleet)
    assert tracker.look(state, {}, grid) is state
    tracker.drive(np.ones((1, 2)))
    assert tracker.look(state, {}, grid) is state


def test_without_a_scan_a_pose_lies_between_where_commands_led_and_localisation() -> None:
    fleet: Any = SimpleNamespace(lidar=LIDAR, period=0.2, scan=lambda robot, info: None)
    grid = FloorGrid(np.zeros((4, 4), np.bool_), (0.0, 0.0), 0.1, np.ones((4, 4), np.float32))
    poses = np.array([[0.0, 0.0, math.pi - 0.01]])
    state = FleetState(poses, np.zeros((1, 2)), np.ones(1, np.bool_), np.zeros(1, np.bool_), 0.0)
    tracker = WallTracker(fleet)
    np.testing.assert_array_equal(tracker.look(state, {}, grid).poses, poses)
    tracker.drive(np.array([[0.5, 0.1]]))
    seen = tracker.look(FleetState(np.array([[0.0, 0.0, -math.pi + 0.01]]), *(getattr(state, n) for n in (
        "goals", "active", "arrived", "time"))), {}, grid).poses[0]  # fmt: skip
    assert seen[0] == pytest.approx(-0.65 * 0.1, abs=1e-3)
    assert abs(math.remainder(seen[2] - math.pi, 2 * math.pi)) < 0.02  # no turn all the way round


@pytest.mark.parametrize("policy", ["prioritized_search", "prioritized_astar"])
def test_two_robots_follow_each_other_through_a_bend(policy: str) -> None:
    plan, ends = corridor(0.26, -1.2, 0.4, (0.03, 0.11))
    ahead, behind = ((0.5 * math.cos(a), 0.5 * math.sin(a)) for a in (0.4, 0.4 - 1.2))
    env = corridor_v0.parallel_env(
        map=plan, robots=2, starts=[ends[0] + ahead, ends[0]], goals=[ends[1], ends[1] - np.array(behind)]
    )
    team = cast(Any, lidarena.baselines.make(policy, env))
    observations, infos = env.reset(seed=2)
    team.reset(seed=2)
    ended: dict[str, tuple[bool, bool]] = {}
    while env.agents:
        observations, _, _, _, infos = env.step(team.act(observations, infos))
        ended |= {name: (bool(info["success"]), bool(info["collision"])) for name, info in infos.items()}
    assert list(ended.values()) == [(True, False)] * 2
