"""The baselines by name."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from lidarena.base.errors import ConfigError, suggest
from lidarena.baselines.policy import Policy

Made = TypeVar("Made", bound=Callable[..., Policy])

_FAMILY_OF_ID = {
    "Env": "exploration",
    "Exploration": "exploration",
    "Arena": "arena",
}  # begins of ids, after "lidarena/"


@dataclass(frozen=True)
class _Entry:
    make: Callable[..., Policy]
    family: str | None


_entries: dict[str, _Entry] = {}


def register(name: str, family: str | None = None) -> Callable[[Made], Made]:
    """Return a decorator that makes a policy known to :func:`make`.

    Args:
        name: What users type.
        family: The family of environments it is for, such as ``"exploration"``; None = any environment.

    Returns:
        A decorator for a class or function called with the environment and keyword options.

    Raises:
        ConfigError: if the name is taken.
    """

    def decorate(maker: Made) -> Made:
        if name in _entries and _entries[name].make is not maker:
            raise ConfigError(f"a baseline named {name!r} is registered already; choose another name")
        _entries[name] = _Entry(maker, family)
        return maker

    return decorate


def names() -> list[str]:
    """Return the names of all baselines, sorted."""
    return sorted(_entries)


def make(name: str, env: Any, **options: Any) -> Policy:
    """Make a baseline for an environment.

    Args:
        name: One of :func:`names`.
        env: The environment that it will drive (single; of a vector environment, its worlds are driven one by one).
        options: The baseline's own, see its class.

    Returns:
        The policy; call its ``reset`` before every episode.

    Raises:
        ConfigError: for an unknown name or option, an option out of range, or an environment of another family.
    """
    if name not in _entries:
        raise ConfigError(f"unknown baseline {name!r}{suggest(name, names())}")
    entry = _entries[name]
    if entry.family is not None and family_of(env) != entry.family:
        raise ConfigError(f"baseline {name!r} drives {entry.family} environments only, not {_describe(env)}")
    allowed = [
        key for key, value in inspect.signature(entry.make).parameters.items() if value.kind == value.KEYWORD_ONLY
    ]
    for key in options:
        if key not in allowed:
            known = suggest(key, allowed) if allowed else "; it has no options"
            raise ConfigError(f"baseline {name!r} has no option {key!r}{known}")
    return entry.make(env, **options)


def family_of(env: Any) -> str | None:
    """Return an environment's family: its attribute ``family``, else what its id says, else None."""
    inner = getattr(env, "unwrapped", env)
    family = getattr(inner, "family", None)
    if family is not None:
        return str(family)
    spec = getattr(env, "spec", None)
    room, _, word = spec.id.partition("/") if spec is not None else ("", "", "")
    if room.split(":")[-1] != "lidarena":
        return None
    return _FAMILY_OF_ID.get(word.partition("-")[0].rstrip("0123456789"))


def _describe(env: Any) -> str:
    spec = getattr(env, "spec", None)
    return repr(spec.id) if spec is not None else type(getattr(env, "unwrapped", env)).__name__
