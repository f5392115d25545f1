import numpy as np
import pytest

from lidarena.envs.workshop.compiler.motion import acquire_motion
from lidarena.envs.workshop.task import HUMAN, ROBOT, load_task
from tests.envs.workshop.workshops import action, loose, task_of


def test_ways_are_walked_and_whoever_stands_in_the_way_costs_time() -> None:
    task = load_task(loose(4))
    motion = acquire_motion(task, 0.4)
    a, b, c = (task.locations.index(name) for name in "abc")
    assert motion.time[HUMAN, a, c, -1] == pytest.approx(4.0, rel=0.05)
    assert motion.time[ROBOT, a, c, -1] == pytest.approx(8.0, rel=0.05)
    assert motion.time[ROBOT, a, c, b] > motion.time[ROBOT, a, c, -1] + 0.3  # b lies between a and c
    assert motion.time[ROBOT, a, b, c] == motion.time[ROBOT, a, b, -1]
    assert (motion.time[:, range(7), range(7)] == 0.0).all()


def test_locations_that_are_too_near_exclude_each_other() -> None:
    task = load_task(loose(2) | {"locations": {"a": [1, 5], "b": [1.8, 5]}})
    near = acquire_motion(task, 0.4).near
    assert near[0, 1] and near[1, 0] and near[0, 0] and not near[0, 2]
    assert not acquire_motion(task, 0.2).near[0, 1]


def test_a_blocked_way_is_dear_but_not_impossible() -> None:
    wall = [[4, 0, 4, 2.4], [4, 3.4, 4, 6]]
    floor = {"bounds": [0, 0, 8, 6], "walls": wall}
    places = {"left": [2, 3], "right": [6, 3], "door": [4, 2.9]}
    task = load_task(task_of({"x": action("left"), "y": action("right"), "z": action("door")}, floor=floor,
                             locations=places))  # fmt: skip
    time = acquire_motion(task, 0.4).time
    assert time[HUMAN, 0, 1, 2] == pytest.approx(time[HUMAN, 0, 1, -1] + 15.0)
    assert np.isfinite(time).all()


def test_without_space_everything_is_at_hand() -> None:
    motion = acquire_motion(load_task(loose(2)), 0.4, space=False)
    assert not motion.time.any() and not motion.near.any()
