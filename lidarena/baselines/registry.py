"""The baselines by name."""

import inspect
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any, TypeVar

from lidarena.base.errors import ConfigError, suggest
from lidarena.baselines.policy import Policy
from lidarena.envs.registration import families, family_of

Made = TypeVar("Made", bound=Callable[..., Policy])

ENTRY_POINTS = "lidarena.baselines"
"""Group under which an installed package declares its baselines: a module that registers them, or a policy's maker."""


@dataclass(frozen=True)
class _Entry:
    make: Callable[..., Policy]
    family: str | None


_entries: dict[str, _Entry] = {}
_loaded: set[str] = set()


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
    _load()
    return sorted(_entries)


def drives(name: str) -> str | None:
    """Return the family of environments that a baseline is for; None = any environment.

    Raises:
        ConfigError: for an unknown name.
    """
    if name not in names():
        raise ConfigError(f"unknown baseline {name!r}{suggest(name, names())}")
    return _entries[name].family


def _load() -> None:
    """Import what registers baselines: the families' modules, once each, and the entry points of other packages."""
    for family in families():
        if family.baselines is not None and family.baselines not in _loaded:
            import_module(family.baselines)
            _loaded.add(family.baselines)
    if ENTRY_POINTS not in _loaded:
        _loaded.add(ENTRY_POINTS)
        for point in entry_points(group=ENTRY_POINTS):
            try:
                _enter(point.name, point.load())
            except Exception as error:  # a package of somebody else must not keep ours from working
                package = getattr(point.dist, "name", "a package")
                words = f"{package} declares a baseline {point.name!r}, which is left out: {error}"
                warnings.warn(words, RuntimeWarning, stacklevel=4)


def _enter(name: str, found: Any) -> None:
    """Make known what an entry point leads to: a policy's maker, or a module that has registered its own by now."""
    if callable(found):
        register(name, getattr(found, "family", None))(found)
    elif not isinstance(found, ModuleType):
        raise ConfigError(f"{found!r} is neither callable nor a module")


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
    known = names()
    if name not in known:
        raise ConfigError(f"unknown baseline {name!r}{suggest(name, known)}")
    entry = _entries[name]
    if entry.family is not None and family_of(env) != entry.family:
        raise ConfigError(f"baseline {name!r} drives {entry.family} environments only, not {_describe(env)}")
    allowed = [
        key for key, value in inspect.signature(entry.make).parameters.items() if value.kind == value.KEYWORD_ONLY
    ]
    for key in options:
        if key not in allowed:
            hint = suggest(key, allowed) if allowed else "; it has no options"
            raise ConfigError(f"baseline {name!r} has no option {key!r}{hint}")
    return entry.make(env, **options)


def _describe(env: Any) -> str:
    spec = getattr(env, "spec", None)
    return repr(spec.id) if spec is not None else type(getattr(env, "unwrapped", env)).__name__
