import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import Limits, check_choice, check_names, check_range, check_switch, options_of
from lidarena.envs import ArenaEnv, CorridorCentralEnv, ExplorationEnv


def test_what_is_allowed_passes() -> None:
    check_names("a world", {"speed": 1, "beams": 3}, ["beams", "speed"])
    check_choice("mode", None, (None, "fast"))
    check_choice("mode", "fast", (None, "fast"))
    check_range("speed", 1, 0.0, 1.0)
    check_range("beams", 4, 4, 9, whole=True)
    check_switch("known", True)


def test_an_unknown_keyword_is_answered_with_the_nearest() -> None:
    sentence = r"a world got an unexpected keyword argument 'sped'; did you mean 'speed'\? Allowed: beams, speed"
    for kind in (ConfigError, TypeError):
        with pytest.raises(kind, match=sentence):
            check_names("a world", {"sped": 1}, ["beams", "speed"])


def test_an_unknown_choice_is_answered_with_the_nearest() -> None:
    with pytest.raises(ConfigError, match="mode = 'fats' is not known; did you mean 'fast'"):
        check_choice("mode", "fats", (None, "fast", "slow"))


@pytest.mark.parametrize("value", [-0.1, 1.1, math.nan, math.inf, "1", None, True, [1]])
def test_a_number_out_of_range_is_refused_with_the_range(value: Any) -> None:
    with pytest.raises(ConfigError, match=r"speed = .* is out of range; a number from 0 to 1 is allowed"):
        check_range("speed", value, 0.0, 1.0)


def test_a_fraction_is_no_whole_number() -> None:
    with pytest.raises(ConfigError, match=r"beams = 4\.5 must be a whole number"):
        check_range("beams", 4.5, 1, 9, whole=True)


@pytest.mark.parametrize("value", [0, 1, "yes", None])
def test_a_switch_is_true_or_false(value: Any) -> None:
    with pytest.raises(ConfigError, match=r"known = .* must be true or false"):
        check_switch("known", value)


@pytest.mark.parametrize("make", [ExplorationEnv, ArenaEnv, CorridorCentralEnv])
def test_numpys_numbers_are_numbers(make: Any) -> None:
    env = make(max_episode_steps=np.int64(3), lidar={"noise": np.float32(0.0)})
    env.reset(seed=0)
    steps = [env.step(env.action_space.sample())[2:4] for _ in range(3)]
    assert steps[-1][1] and not steps[0][1]


def test_numpys_numbers_are_numbers_in_dictionaries_too() -> None:
    env = ExplorationEnv(map="env1", reward={"path": np.float32(2), "collision": np.int64(3)})
    env.reset(seed=0)
    assert env.step(0)[4]["reward_terms"]["path"] < 0.0


@dataclass(frozen=True)
class Dish:
    """Keywords of an environment that there is not."""

    kind: str = "soup"
    salt: float = 1.0
    pepper: float | None = None
    spoons: int = 2
    hot: bool = True
    max_episode_steps: int = 100


LIMITS = Limits({"kind": ("soup", "salad")}, {"salt": (0.0, 2.0), "pepper": (0.0, 1.0)}, {"spoons": (1, 9)}, ("hot",))


def test_keywords_make_the_options_and_none_of_the_rest_is_touched() -> None:
    options = options_of(Dish, "a dish", {"salt": np.float64(0.5), "max_episode_steps": None}, LIMITS)
    assert options == Dish(salt=0.5) and type(options.salt) is float


@pytest.mark.parametrize(
    ("keywords", "says"),
    [
        ({"slat": 1.0}, "a dish got an unexpected keyword argument 'slat'; did you mean 'salt'"),
        ({"kind": "salat"}, "did you mean 'salad'"),
        ({"salt": 3.0}, "salt = 3.0 is out of range"),
        ({"salt": None}, "salt = None is out of range"),
        ({"pepper": 1.5}, "pepper = 1.5"),
        ({"spoons": 1.5}, "spoons = 1.5 must be a whole number"),
        ({"hot": 1}, "hot = 1 must be true or false"),
        ({"max_episode_steps": 0}, "or -1 for never"),
    ],
)
def test_keywords_beyond_their_limits_are_refused(keywords: dict[str, Any], says: str) -> None:
    with pytest.raises(ConfigError, match=says):
        options_of(Dish, "a dish", keywords, LIMITS)
