"""Earlier keywords become part of new ones, with a warning where they were used."""

import warnings

import pytest

from lidarena.base.earlier_keywords import nest_earlier
from lidarena.base.errors import ConfigError
from lidarena.envs import ExplorationEnv

EARLIER = {"noise": ("lidar", "noise"), "beams": ("lidar", "beams"), "radius": ("robot", "radius")}


def test_new_keywords_pass_in_silence() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert nest_earlier("a world", {"lidar": {"noise": 1}, "map": "a"}, EARLIER) == {
            "lidar": {"noise": 1},
            "map": "a",
        }


def test_earlier_keywords_are_gathered_and_warn_of_their_new_form() -> None:
    with pytest.warns(DeprecationWarning, match="is now part of") as caught:
        found = nest_earlier("a world", {"noise": 0.1, "beams": 9, "radius": None, "map": "a"}, EARLIER)
    assert found == {"map": "a", "lidar": {"noise": 0.1, "beams": 9}} and len(caught) == 3
    assert "give lidar={'beams': 9}" in str(caught[1].message)


def test_the_warning_points_at_the_users_line() -> None:
    with pytest.warns(DeprecationWarning, match="collision_distance") as caught:
        ExplorationEnv(map="env1", slam="truth", collision_distance=0.2)  # type: ignore[call-arg]
    assert caught[0].filename == __file__


def test_both_forms_at_once_are_refused() -> None:
    with pytest.raises(ConfigError, match="earlier form of lidar"):
        nest_earlier("a world", {"noise": 0.1, "lidar": "lds_01"}, EARLIER)
