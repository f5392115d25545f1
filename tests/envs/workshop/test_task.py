"""Tasks as arrays: numbers, ways and what cannot be done on a floor."""

import copy
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, MapError
from lidarena.envs.workshop.task import HUMAN, ROBOT, load_task
from tests.envs.workshop.workshops import action, chain, loose, task_of


def test_a_chain_as_arrays() -> None:
    task = load_task(chain(3))
    arrays = task.arrays
    assert task.actions == ("part_0", "part_1", "part_2") and len(task.locations) == 7
    assert arrays.before.tolist() == [[False, True, False], [False, False, True], [False, False, False]]
    assert arrays.capable.all() and arrays.lower[ROBOT].tolist() == [5.0] * 3
    assert arrays.stops[1].tolist() == [1, 4] and arrays.share[1].tolist() == [0.5, 0.5]
    usual = np.sqrt(24.0)
    assert arrays.tail == pytest.approx([3 * usual, 2 * usual, usual])
    assert arrays.step == pytest.approx([0.1, 0.05])


def test_only_who_is_named_can_do_an_action() -> None:
    task = load_task(task_of({"x": action("a", human=None), "y": action("b", robot=None)}))
    assert task.arrays.capable.tolist() == [[False, True], [True, False]]


def test_ways_alone_are_lengths_over_speeds() -> None:
    task = load_task(loose(2))
    a, b = task.locations.index("a"), task.locations.index("b")
    assert task.walks[HUMAN, a, b] == pytest.approx(2.0, rel=0.1)
    assert task.walks[ROBOT, a, b] == pytest.approx(2.0 * task.walks[HUMAN, a, b])
    fetched = load_task(chain(1))
    assert fetched.arrays.trip[HUMAN, 0] == pytest.approx(np.hypot(2, 2), rel=0.1)


def test_the_robot_may_be_another() -> None:
    assert load_task("pile", speed=1.4).speeds == (1.2, 1.4)
    assert load_task("pile", radius=0.4).radii == (0.25, 0.4)
    assert load_task("pile").key != load_task("pile", speed=1.4).key
    assert load_task("pile") is load_task("pile")


@pytest.mark.parametrize(
    ("more", "error", "message"),
    [
        ({"locations": {"a": [0.1, 5], "b": [3, 5]}}, ConfigError, "'a' at .0.1, 5. leaves no room for the human"),
        ({"floor": {"bounds": [0, 0, 8, 6], "walls": [[0, 4, 8, 4]]}}, ConfigError, "cannot reach the location 'a'"),
        ({"floor": {"bounds": [0, 0, 0, 6]}}, MapError, "x_min < x_max"),
        ({"floor": {"map": "env11"}}, MapError, "env1"),
        ({"constraints": [{"from": "part_0.start", "to": "part_0.end", "upper": 2}]}, ConfigError, "part_0.end"),
        ({"constraints": [{"from": "part_0.end", "to": "part_1.end", "lower": 9},
                          {"from": "part_0.end", "to": "part_1.end", "upper": 5}]}, ConfigError, "contradict"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_by_name(more: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message) as refusal:
        load_task(copy.deepcopy(loose(2)) | more)
    assert "\n" not in str(refusal.value)


def test_a_floor_may_be_a_plan_of_the_package() -> None:
    agents = {"human": {"home": [1.0, 1.0], "speed": 1.0, "radius": 0.1},
              "robot": {"home": [1.0, 2.0], "speed": 0.5, "radius": 0.1}}  # fmt: skip
    task = load_task(loose(1) | {"floor": {"map": "env1"}, "locations": {"a": [1.0, 3.0]}, "agents": agents})
    assert task.plan.name == "env1"
