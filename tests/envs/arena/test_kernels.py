"""The swept gap against sampling, the lidar of a one-tile geometry against the ordinary one."""

import math

import numpy as np
import pytest

from lidarena.envs.arena.kernels import turn_and_sweep, way_gap
from lidarena.envs.arena.options import ArenaOptions
from lidarena.envs.arena.state import ArenaCore
from lidarena.world.lidar import Lidar

SPECS = ["random", "u_trap", "yang:u", "env2", "gnron"]


def core_of(spec: str, worlds: int = 3, **keywords: object) -> ArenaCore:
    goal = {"goal": (1.0, 6.5)} if spec == "env2" else {}
    core = ArenaCore(worlds, ArenaOptions.checked({"arena": spec, **goal, **keywords}))
    for world in range(worlds):
        core.reset_world(world, np.random.default_rng(world), None)
    return core


@pytest.mark.parametrize("spec", SPECS)
def test_the_gap_of_a_way_is_the_least_clearance_on_it(spec: str) -> None:
    core, rng = core_of(spec), np.random.default_rng(1)
    for world in range(core.worlds):
        scenario = core.scenarios[world]
        assert scenario is not None
        low, high = np.array(scenario.arena.bounds[:2]), np.array(scenario.arena.bounds[2:])
        for _ in range(20):
            a = rng.uniform(low, high)
            b = a + core.step_length * rng.uniform(-3.0, 3.0, 2)
            sampled = scenario.plan.clearance(a + np.linspace(0.0, 1.0, 400)[:, None] * (b - a))
            found = way_gap(*a, *b, world, core.geometry)
            if sampled.min() > 0:
                assert found == pytest.approx(sampled.min(), abs=0.02 * core.step_length)
                assert found <= sampled.min() + 1e-12
            else:
                assert (
                    found <= 0.02 * core.step_length or scenario.plan.clearance(a[None])[0] < 0
                )  # within a solid wall


def test_a_way_across_a_wall_has_no_gap() -> None:
    core = core_of("yang", 1)
    assert way_gap(90.0, 50.0, 99.0, 50.0, 0, core.geometry) == 0.0


@pytest.mark.parametrize("spec", SPECS)
def test_the_lidar_sees_what_the_ordinary_one_sees(spec: str) -> None:
    core = core_of(spec)
    for world in range(core.worlds):
        scenario = core.scenarios[world]
        assert scenario is not None
        lidar = Lidar([scenario.plan], core.beam)
        ranges = lidar.cast(core.physics.poses[world : world + 1], np.zeros(1, np.int64))
        assert core.measurements.ranges[world] == pytest.approx(ranges[0], abs=1e-12)


def test_turning_wraps_the_heading_and_tells_who_is_near() -> None:
    core = core_of("yang", 2)
    core.physics.poses[:, 0] = [(40.0, 43.5, 3.0), (20.0, 20.0, -3.0)]
    gaps, near = np.zeros(2), np.zeros(2, np.bool_)
    turns = np.array([math.pi / 2 - 3.0, -1.0])
    turn_and_sweep(turns, 1.0, 1e-3, core.geometry, core.radii, core.physics.poses, gaps, near)
    assert core.physics.poses[:, 0, 2] == pytest.approx([math.pi / 2, 2 * math.pi - 4.0])
    assert near.tolist() == [True, False]
    assert gaps[0] == pytest.approx(45.0 - 44.5 - 0.8 - 0.1)


def test_noise_is_added_within_the_range() -> None:
    exact, noisy = core_of("random", 1), core_of("random", 1, lidar={"noise": 0.3})
    assert np.array_equal(exact.measurements.ranges, noisy.measurements.ranges)
    off = noisy.measurements.scans - noisy.measurements.ranges
    hit = noisy.measurements.ranges < 30.0
    assert 0.1 < off[hit].std() < 0.6 and (noisy.measurements.scans <= 30.0).all()
    assert exact.measurements.scans == pytest.approx(exact.measurements.ranges, abs=1e-5)


def test_worlds_grow_when_a_larger_arena_comes() -> None:
    core = core_of("random", 2, density=[0.0, 0.3])
    rng = np.random.default_rng(0)
    for _ in range(12):
        for world in range(2):
            core.reset_world(world, rng, None)
            scenario = core.scenarios[world]
            assert scenario is not None
            tile = core.geometry.first_tile[world]
            items = core.geometry.items[core.geometry.tile_start[tile] : core.geometry.tile_start[tile + 1]]
            circles = items[items >= len(core.geometry.edges)] - len(core.geometry.edges)
            assert np.array_equal(core.geometry.circles[circles], scenario.plan.circles)
            assert len(items) == len(scenario.plan.circles) + 4


def test_the_robots_length_of_a_step_is_driven_exactly_where_nothing_is_near() -> None:
    core = core_of("yang", 1)
    before = core.physics.poses.copy()
    core.step(np.array([0.3]))
    moved = core.physics.poses[0, 0, :2] - before[0, 0, :2]
    assert math.hypot(*moved) == pytest.approx(1.0)
    assert core.measurements.path_length[0] == pytest.approx(1.0)
    assert not core.physics.touched[0]


def test_a_robot_stops_at_what_it_touches() -> None:
    core, rng = core_of("random", 8, density=0.22), np.random.default_rng(3)
    contacts = 0
    for _ in range(150):
        core.step(rng.uniform(-0.3, 0.3, 8))
        for world in np.flatnonzero(core.physics.touched).tolist():
            contacts += 1
            scenario = core.scenarios[world]
            assert scenario is not None
            away = scenario.plan.clearance(core.physics.poses[world, :, :2])[0] - core.radii[world]
            assert -0.251 < away < 0.3  # the solver looks four times a step; then it stops, or slides along
            core.reset_world(world, np.random.default_rng(contacts), None)
    assert contacts > 10
