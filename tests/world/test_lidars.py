"""Lidars by name and by number, and what is no lidar."""

import math
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.world.lidar import FULL_CIRCLE, LidarSpec
from lidarena.world.lidars import LIDARS, check_lidar, make_lidar

DEFAULT = LidarSpec(beams=36, max_range=5.0)


def quick() -> LidarSpec:
    """What a user's own function makes."""
    return LidarSpec(beams=90, max_range=2)


@pytest.mark.parametrize("name", LIDARS)
def test_a_preset_is_a_lidar_that_can_be_and_may_be_changed(name: str) -> None:
    spec = make_lidar(name, DEFAULT, 0.2)
    assert spec == DEFAULT._replace(**LIDARS[name]) and math.isinf(spec.rate)
    changed = make_lidar({"preset": name, "noise": 0.3, "rate": 2}, DEFAULT, 0.2)
    assert changed == spec._replace(noise=0.3, rate=2.0)
    assert all(isinstance(number, float) for number in changed[1:])


def test_nothing_changes_changes_objects_and_callables_are_understood() -> None:
    assert make_lidar(None, DEFAULT, 0.2) == make_lidar({}, DEFAULT, 0.2) == DEFAULT
    assert make_lidar({"beams": 50}, DEFAULT, 0.2) == DEFAULT._replace(beams=50)
    assert make_lidar({"rate": None}, DEFAULT, 0.2) == DEFAULT
    assert make_lidar(LidarSpec(beams=12), DEFAULT, 0.2) == LidarSpec(beams=12)
    assert make_lidar("tests.world.test_lidars:quick", DEFAULT, 0.2) == LidarSpec(beams=90, max_range=2.0)


@pytest.mark.parametrize(
    ("value", "says"),
    [
        ("hokuyo_ust10lx", "did you mean 'hokuyo_ust_10lx'"),
        ({"beam": 3}, "did you mean 'beams'"),
        ({"preset": "lds_1"}, "did you mean 'lds_01'"),
        ({"beams": 0}, "lidar.beams = 0 is out of range"),
        ({"beams": 36.5}, "whole number"),
        ({"max_range": float("nan")}, "lidar.max_range = nan"),
        ({"max_range": -1.0}, "lidar.max_range = -1.0"),
        ({"noise": -0.1}, "lidar.noise"),
        ({"min_range": 5.0}, "must be less than lidar.max_range = 5.0"),
        ({"field_of_view": 6.3}, "up to 2 pi"),
        ({"field_of_view": 0.0}, "up to 2 pi"),
        ({"field_of_view": float("nan")}, "up to 2 pi"),
        ({"field_of_view": "wide"}, "up to 2 pi"),
        ({"rate": 0.0}, "above 0"),
        ({"rate": float("nan")}, "above 0"),
        ({"rate": 6.0}, "at most 5 Hz"),
        (LidarSpec(beams=2), "lidar.beams = 2"),
        (7, "must be the name of a preset"),
        ("nowhere:lidar", "no module 'nowhere'"),
        ("math:pi", "made a float"),
    ],
)
def test_what_is_no_lidar_is_refused_in_one_sentence(value: Any, says: str) -> None:
    with pytest.raises(ConfigError, match=says) as caught:
        make_lidar(value, DEFAULT, 0.2)
    assert "\n" not in str(caught.value)


def test_a_rate_that_decisions_can_follow_is_taken() -> None:
    check_lidar(DEFAULT._replace(rate=5.0), 0.2)
    check_lidar(DEFAULT._replace(rate=0.01), 0.2)


@pytest.mark.parametrize("beams", [4, 36, 361])
@pytest.mark.parametrize("view", [0.5, math.pi, math.radians(270.0), FULL_CIRCLE])
def test_beams_are_even_and_symmetric_about_straight_ahead(beams: int, view: float) -> None:
    spec = LidarSpec(beams=beams, field_of_view=view)
    assert len(spec.angles) == beams and np.diff(spec.angles) == pytest.approx(spec.increment)
    np.testing.assert_allclose(spec.directions, [np.cos(spec.angles), np.sin(spec.angles)])
    if spec.sees_all_around:
        assert spec.angles[0] == 0.0 and spec.angles[-1] == pytest.approx(2 * np.pi - spec.increment)
    else:
        assert spec.angles[0] == pytest.approx(-view / 2) and spec.angles + spec.angles[::-1] == pytest.approx(0.0)
    for angle in (-3.0, 0.0, 1.0, 7.0):
        apart = np.abs(np.angle(np.exp(1j * (spec.angles - angle))))
        assert apart[spec.nearest_beam(angle)] == pytest.approx(apart.min())
