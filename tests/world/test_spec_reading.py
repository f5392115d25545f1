"""What ``robot=`` and ``lidar=`` take: names, changes, objects, and who makes one."""

from typing import Any, NamedTuple

import pytest

from lidarena.base.errors import ConfigError
from lidarena.world.spec_reading import read_spec


class Cart(NamedTuple):
    radius: float = 0.1
    outline: tuple[float, ...] = ()
    speed: float = 0.5


PRESETS = {"small": {"radius": 0.05, "speed": 0.2}}
HERE = __name__


def make_cart() -> Cart:
    return Cart(radius=0.3)


def make_nothing() -> int:
    return 3


def read(value: Any) -> Any:
    return read_spec("robot", value, Cart, Cart._fields, PRESETS, either=("radius", "outline"))


def test_what_is_taken() -> None:
    assert read(None) == {}
    assert read("small") == {"radius": 0.05, "speed": 0.2}
    assert read({"speed": 1.0}) == {"speed": 1.0}
    assert read({"preset": "small", "speed": 1.0}) == {"radius": 0.05, "speed": 1.0}
    assert read(Cart(speed=3.0)) == Cart(speed=3.0)
    assert read(f"{HERE}:make_cart") == Cart(radius=0.3)


def test_an_outline_takes_the_place_of_a_presets_radius() -> None:
    assert read({"preset": "small", "outline": (1.0, 2.0)}) == {"speed": 0.2, "outline": (1.0, 2.0)}


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        ("smal", "robot = 'smal' is not known; did you mean 'small'"),
        ({"sped": 1.0}, "robot has no 'sped'; did you mean 'speed'"),
        (3, "robot = 3 must be the name of a preset"),
        ({"radius": 1.0, "outline": (1.0,)}, "robot was given radius and outline"),
        (f"{HERE}:make_nothing", "made a int, a Cart is needed"),
        (f"{HERE}:nobody", "nobody"),
    ],
)
def test_what_is_refused(value: Any, sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        read(value)
