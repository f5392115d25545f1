"""Robots by name and by number, and what is no robot."""

import math
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.world.robots import ROBOTS, RobotSpec, gives_size, make_robot

DEFAULT = RobotSpec(max_turn_rate=2.0, reverse=True)
BOX = [[0.2, 0.1], [-0.2, 0.1], [-0.2, -0.1], [0.2, -0.1]]


def slow() -> dict[str, Any]:
    """What a user's own function makes."""
    return {"preset": "turtlebot3_waffle", "max_speed": 0.1}


def test_the_burger_is_the_default_and_keeps_the_familys_turn_rate() -> None:
    assert make_robot("turtlebot3_burger", DEFAULT) == make_robot(None, DEFAULT) == make_robot({}, DEFAULT) == DEFAULT


@pytest.mark.parametrize("name", ROBOTS)
def test_a_preset_is_a_robot_that_can_be_and_may_be_changed(name: str) -> None:
    spec = make_robot(name, DEFAULT)
    assert 0.0 < spec.inner_radius <= spec.radius < spec.bumper == spec.contact_distance
    changed = make_robot({"preset": name, "max_speed": 0.05, "collision_distance": 0.5}, DEFAULT)
    assert (changed.max_speed, changed.bumper, changed.radius) == (0.05, 0.5, spec.radius)


def test_an_outline_is_counter_clockwise_with_its_circle_about_it() -> None:
    spec = make_robot({"outline": np.array(BOX[::-1])}, DEFAULT)
    assert spec.radius == pytest.approx(math.hypot(0.2, 0.1)) and spec.inner_radius == pytest.approx(0.1)
    x, y = spec.corners.T
    assert np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0.0
    assert spec == make_robot({"outline": BOX}, DEFAULT) or len(spec.outline) == 4
    assert hash(spec) is not None


def test_a_radius_takes_the_place_of_a_presets_outline_and_an_outline_of_a_radius() -> None:
    assert make_robot({"preset": "jackal", "radius": 0.3}, DEFAULT).outline == ()
    box = make_robot({"preset": "turtlebot3_waffle", "outline": BOX}, DEFAULT)
    assert box.radius == pytest.approx(math.hypot(0.2, 0.1))


def test_callables_and_objects_are_understood() -> None:
    assert make_robot("tests.world.test_robots:slow", DEFAULT).max_speed == 0.1
    assert make_robot(RobotSpec(radius=0.3), DEFAULT).radius == 0.3
    assert not gives_size(None) and not gives_size({"max_speed": 1.0})
    assert gives_size("jackal") and gives_size({"radius": 1.0}) and gives_size(RobotSpec())


def test_a_fast_small_robot_passes_through_nothing_between_two_steps_of_the_physics() -> None:
    spec = make_robot({"radius": 0.05, "max_speed": 2.0}, DEFAULT)
    assert spec.substep * spec.max_speed < spec.radius


def test_a_bumper_is_as_far_off_as_the_outline_and_a_rim() -> None:
    spec = make_robot({"outline": BOX}, DEFAULT)
    assert spec.bumpers(np.array([0.0, np.pi / 2, np.pi])) == pytest.approx([0.215, 0.115, 0.215])
    assert RobotSpec().bumpers(np.zeros(2)) == pytest.approx([0.12, 0.12])


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ("turtlebot_waffle", "did you mean 'turtlebot3_waffle'"),
        ({"radios": 1}, "did you mean 'radius'"),
        ({"radius": -0.1}, "robot.radius = -0.1"),
        ({"radius": float("nan")}, "robot.radius = nan"),
        ({"max_speed": 0.0}, "robot.max_speed = 0.0"),
        ({"max_turn_rate": "fast"}, "robot.max_turn_rate = 'fast'"),
        ({"reverse": 1}, "robot.reverse = 1 must be true or false"),
        ({"collision_distance": 0.1}, "robot.collision_distance = 0.1"),
        ({"radius": 0.2, "outline": BOX}, "radius and outline"),
        ({"outline": BOX[:2]}, "at least 3"),
        ({"outline": [[0.2, 0.1], [-0.2, -0.1], [0.2, -0.1], [-0.2, 0.1]]}, "crosses or touches itself"),
        ({"outline": [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]}, r"must hold \(0, 0\)"),
        ({"outline": [[0.2, float("nan")], [-0.2, 0.1], [-0.2, -0.1]]}, "corners"),
        ({"outline": "box"}, "corners"),
        ([1, 2], "must be the name of a preset"),
    ],
)
def test_what_is_no_robot_is_refused_in_one_sentence(value: Any, says: str) -> None:
    with pytest.raises(ConfigError, match=says) as caught:
        make_robot(value, DEFAULT)
    assert "\n" not in str(caught.value)
