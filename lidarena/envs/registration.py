"""Families of environments: what each tells of itself, and the ids that are registered with Gymnasium.

A family is registered once, here or from outside with ``register_family``; nothing else lists families by name.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import gymnasium as gym

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.import_names import import_named

BUILT_IN = ("exploration", "arena", "corridor", "workshop", "seabed")
"""Packages of ``lidarena.envs`` that hold a ``FAMILY``."""
_MOST_WRAPPERS = 64


@dataclass(frozen=True)
class Registration:
    """How Gymnasium makes an id.

    Attributes:
        entry_point: ``"module:callable"`` of the single environment, or the callable; None if there is only a batch.
        vector_entry_point: The same of the native batch; None if there is none.
        max_episode_steps: After which ``gym.make`` truncates.
        keywords: That the id stands for.
        agent: ``"module:callable"`` of the policy by which a network that was trained under this id drives the family's
            environments, called with the environment and the network; None: the network itself does.
    """

    entry_point: str | Callable[..., Any] | None = None
    vector_entry_point: str | Callable[..., Any] | None = None
    max_episode_steps: int | None = None
    keywords: Mapping[str, Any] = field(default_factory=dict)
    agent: str | None = None


@dataclass(frozen=True)
class Family:
    """A family of environments.

    Attributes:
        name: Its environments carry it as ``family``.
        ids: What is registered with Gymnasium.
        measures: ``"module:name"`` of the ``FamilyMeasures`` by which ``evaluate`` measures its episodes, tabulates and
            draws them; None: by what every environment tells.
        baselines: Module that registers its baselines when it is imported; None if there are none.
        agent_options: What in the ``options`` of its environments says what an observation or an action means to an
            agent, such as ``"observation"``, with dots where it is inside of another: ``"lidar.beams"``.
        keywords_of_0_1: ``"module:function"`` that turns the keywords of a policy file or run of version 0.1 into those
            of today; None if nothing has changed.
    """

    name: str
    ids: Mapping[str, Registration] = field(default_factory=dict)
    measures: str | None = None
    baselines: str | None = None
    agent_options: tuple[str, ...] = ("observation", "action")
    keywords_of_0_1: str | None = None


_families: dict[str, Family] = {}


def register_family(family: Family) -> None:
    """Make a family and its ids known; doing so again with the same family changes nothing.

    Raises:
        ConfigError: Another family has this name.
    """
    known = _families.get(family.name)
    if known is not None and known != family:
        raise ConfigError(f"a family named {family.name!r} is registered already; choose another name")
    _families[family.name] = family
    for id_, registration in family.ids.items():
        if id_ not in gym.registry:
            gym.register(
                id=id_,
                entry_point=registration.entry_point,
                vector_entry_point=registration.vector_entry_point,
                max_episode_steps=registration.max_episode_steps,
                kwargs=dict(registration.keywords),
            )


def register_all() -> None:
    """Register the families of the package; doing so again changes nothing."""
    for name in BUILT_IN:
        register_family(import_module(f"lidarena.envs.{name}").FAMILY)


def families() -> tuple[Family, ...]:
    """Return all registered families, in the order of registration."""
    return tuple(_families.values())


def family_named(name: str) -> Family:
    """Return a family.

    Raises:
        ConfigError: There is none of this name.
    """
    if name not in _families:
        raise ConfigError(f"no family of environments is named {name!r}{suggest(name, _families)}")
    return _families[name]


def registration_of(env_id: str) -> tuple[Family, Registration] | None:
    """Return the family that an id belongs to and how it is made; None for an id of somebody else's."""
    name = env_id.rpartition(":")[2]
    for family in _families.values():
        if name in family.ids:
            return family, family.ids[name]
    return None


def keywords_of_version_0_1(env_id: str, keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keywords with which version 0.1 made an environment so that they mean today what they meant then.

    Args:
        env_id: Gymnasium's id.
        keywords: As a policy file or run folder of version 0.1 has them.
    """
    found = registration_of(env_id)
    if found is None or found[0].keywords_of_0_1 is None:
        return dict(keywords)
    modern: dict[str, Any] = import_named(found[0].keywords_of_0_1, f"family {found[0].name!r}")(keywords)
    return modern


def family_of(env: Any) -> str | None:
    """Return the name of an environment's family, None for one that belongs to none.

    It is the attribute ``family`` of the environment, or of what it wraps: by Gymnasium's wrappers, PettingZoo's, or
    one of one's own that keeps what it wraps as ``env``.
    """
    owner = owner_of(env, "family")
    return None if owner is None else str(owner.family)


def owner_of(env: Any, attribute: str) -> Any:
    """Return the environment itself or the nearest one inside it that has an attribute that is not None; else None."""
    for _ in range(_MOST_WRAPPERS):
        inner = getattr(env, "unwrapped", env)
        for one in (env, inner):
            if getattr(type(one), attribute, None) is not None or attribute in getattr(one, "__dict__", {}):
                return one
        env = inner.__dict__.get("env") if hasattr(inner, "__dict__") else None
        if env is None:
            return None
    return None
