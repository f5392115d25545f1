"""Families register themselves, once; what wraps an environment hides neither its family nor its options."""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import gymnasium as gym
import pytest

import lidarena  # noqa: F401
from lidarena.base.errors import ConfigError
from lidarena.envs import corridor_v0, registration
from lidarena.envs.registration import (
    Family,
    Registration,
    families,
    family_named,
    family_of,
    owner_of,
    register_all,
    register_family,
)

OURS = ("exploration", "arena", "corridor", "workshop")


@pytest.fixture
def mine() -> Iterator[Family]:
    family = Family(
        "mine", ids={"mine/Pole-v0": Registration("gymnasium.envs.classic_control:CartPoleEnv", max_episode_steps=9)}
    )
    register_family(family)
    yield family
    registration._families.pop("mine")
    gym.registry.pop("mine/Pole-v0", None)


def test_the_families_of_the_package_are_there_once() -> None:
    names = [family.name for family in families()]
    register_all()
    assert [family.name for family in families()] == names
    assert set(OURS) <= set(names)


def test_every_id_of_a_family_is_made_by_gymnasium() -> None:
    for family in families():
        for id_, registered in family.ids.items():
            spec = gym.spec(id_)
            assert spec.entry_point == registered.entry_point
            assert spec.vector_entry_point == registered.vector_entry_point


def test_a_family_from_outside_joins(mine: Family) -> None:
    assert family_named("mine") is mine and mine in families()
    env: Any = gym.make("mine/Pole-v0")
    assert env.spec.max_episode_steps == 9
    register_family(mine)


def test_two_families_cannot_have_one_name(mine: Family) -> None:
    with pytest.raises(ConfigError, match="a family named 'mine' is registered already"):
        register_family(Family("mine"))


def test_an_unknown_family_is_refused_with_the_nearest_right_one() -> None:
    with pytest.raises(ConfigError, match="'explorations'; did you mean 'exploration'"):
        family_named("explorations")


class Outer:
    """Something of one's own around an environment."""

    def __init__(self, env: Any) -> None:
        self.env = env


@pytest.mark.parametrize(
    ("make", "family"),
    [
        (lambda: gym.make("lidarena/Env1-v0"), "exploration"),
        (lambda: gym.make("lidarena/Arena-v0"), "arena"),
        (lambda: gym.make("lidarena/CorridorCentral-v0"), "corridor"),
        (lambda: gym.make_vec("lidarena/Arena-v0", 2, "vector_entry_point"), "arena"),
        (lambda: corridor_v0.parallel_env(), "corridor"),
        (lambda: corridor_v0.env(), "corridor"),
        (lambda: Outer(gym.wrappers.FlattenObservation(gym.make("lidarena/Arena-v0"))), "arena"),
        (lambda: Outer(Outer(corridor_v0.env())), "corridor"),
    ],
)
def test_family_and_options_are_found_through_wrappers(make: Any, family: str) -> None:
    env = make()
    assert family_of(env) == family
    assert owner_of(env, "options").options.max_episode_steps in (-1, 500, 1000)


def test_what_belongs_to_no_family_has_none() -> None:
    assert family_of(gym.make("CartPole-v1")) is None
    assert family_of(SimpleNamespace()) is None and owner_of(None, "options") is None


def test_something_that_wraps_itself_does_not_hang() -> None:
    loop = SimpleNamespace()
    loop.env = loop
    assert family_of(loop) is None
