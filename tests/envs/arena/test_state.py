"""The worlds of arenas, without rewards or episodes."""

import math

import numpy as np
import pytest

from lidarena.envs.arena.options import ArenaOptions
from lidarena.envs.arena.state import ArenaCore


def core(worlds: int = 1, **keywords: object) -> ArenaCore:
    made = ArenaCore(worlds, ArenaOptions.checked(keywords))
    for world in range(worlds):
        made.reset_world(world, np.random.default_rng(world), None)
    return made


def test_a_robot_begins_at_its_start_and_knows_how_far_its_goal_is() -> None:
    worlds = core(arena="yang")
    scenario = worlds.scenarios[0]
    assert scenario is not None
    assert worlds.physics.poses[0, 0, :2].tolist() == pytest.approx(list(scenario.arena.start))
    assert worlds.measurements.distance[0] == pytest.approx(math.dist(scenario.arena.start, scenario.arena.goal))
    assert worlds.measurements.path_length[0] == 0.0 and not worlds.physics.touched.any()


def test_a_step_turns_first_and_then_drives_a_step_s_length() -> None:
    worlds = core(arena="random", density=0.0)
    before = worlds.physics.poses[0, 0].copy()
    worlds.step(np.array([0.5]))
    after = worlds.physics.poses[0, 0]
    assert after[2] == pytest.approx(math.remainder(before[2] + 0.5, 2 * math.pi))
    assert math.dist(before[:2], after[:2]) == pytest.approx(worlds.step_length)
    assert math.atan2(after[1] - before[1], after[0] - before[0]) == pytest.approx(after[2])
    assert worlds.measurements.path_length[0] == pytest.approx(worlds.step_length)


def test_worlds_do_not_know_each_other() -> None:
    alone, together = core(1, arena="random"), core(3, arena="random")
    for turn in (0.3, -0.2, 0.1):
        alone.step(np.array([turn]))
        together.step(np.array([turn, 1.0, -2.0]))
    for name in ("distance", "gap", "path_length"):
        assert getattr(alone.measurements, name)[0] == getattr(together.measurements, name)[0]
    assert np.array_equal(alone.measurements.scans[0], together.measurements.scans[0])


def test_what_is_saved_continues_to_the_bit() -> None:
    one, other = core(2, arena="random", lidar={"noise": 0.1}), core(2, arena="random", lidar={"noise": 0.1})
    other.reset_world(0, np.random.default_rng(99), None)
    one.step(np.array([0.1, -0.1]))
    other.load_arrays({name: array.copy() for name, array in one.arrays().items()})
    for worlds in (one, other):
        worlds.step(np.array([0.2, 0.4]))
    for name, array in one.arrays().items():
        assert np.array_equal(array, other.arrays()[name]), name
