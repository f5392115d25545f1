"""Checks of an environment's keywords at the border: one sentence that names the value and what is allowed."""

import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from inspect import Parameter, Signature, signature
from typing import Any, TypeVar, get_type_hints

import numpy as np

from lidarena.base.errors import ConfigError, KeywordError, suggest


def check_names(what: str, keywords: Mapping[str, Any], allowed: Iterable[str]) -> None:
    """Refuse a keyword that does not exist.

    Raises:
        KeywordError: With the nearest right one.
    """
    names = list(allowed)
    for name in keywords:
        if name not in names:
            raise KeywordError(f"{what} got an unexpected keyword argument {name!r}{suggest(name, names)}")


def plain(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keywords with every path as the string, and every NumPy scalar as the number, that it stands for.

    Also inside of dictionaries.
    """
    return {name: _plain(value) for name, value in keywords.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return plain(value)
    return value.item() if isinstance(value, np.generic) else value


def check_choice(name: str, value: Any, allowed: Sequence[str | None]) -> None:
    """Refuse a value that is none of ``allowed``.

    Raises:
        ConfigError: With the nearest right one.
    """
    if value not in allowed:
        words = [word for word in allowed if word is not None]
        raise ConfigError(f"{name} = {value!r} is not known{suggest(str(value), words)}")


def check_range(name: str, value: Any, low: float, high: float, whole: bool = False) -> None:
    """Refuse what is no finite number from ``low`` to ``high``, or with ``whole`` no whole one.

    Raises:
        ConfigError: It names the range.
    """
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not number or not math.isfinite(value) or not low <= value <= high:
        raise ConfigError(f"{name} = {value!r} is out of range; a number from {low:g} to {high:g} is allowed")
    if whole and not isinstance(value, int):
        raise ConfigError(f"{name} = {value!r} must be a whole number")


def check_step_limit(value: Any, name: str = "max_episode_steps") -> None:
    """Refuse what is neither a number of steps nor -1, which means never.

    Raises:
        ConfigError: It names what is allowed.
    """
    if isinstance(value, bool) or not isinstance(value, int) or (value != -1 and not 1 <= value <= 10**9):
        raise ConfigError(f"{name} = {value!r} must be a whole number from 1 to 1e+09, or -1 for never")


def check_switch(name: str, value: Any) -> None:
    """Refuse what is neither True nor False.

    Raises:
        ConfigError: It names the value.
    """
    if not isinstance(value, bool):
        raise ConfigError(f"{name} = {value!r} must be true or false")


@dataclass(frozen=True)
class Limits:
    """What keywords may be whose check is one of those above, by their names.

    Attributes:
        choices: Of which values.
        ranges: Least and greatest number; None is allowed too where it is the default.
        whole: Least and greatest whole number.
        switches: True or False.
    """

    choices: Mapping[str, Sequence[str | None]] = field(default_factory=dict)
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    whole: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    switches: Sequence[str] = ()


Options = TypeVar("Options")


def options_of(kind: type[Options], what: str, keywords: Mapping[str, Any], limits: Limits) -> Options:
    """Make a dataclass of keywords, its ``max_episode_steps`` the usual one where None is given.

    Args:
        kind: The dataclass.
        what: What messages call the environment.
        keywords: Those that were given.
        limits: What they may be.

    Raises:
        ConfigError: An unknown keyword, or a value out of its limits.
    """
    known: Any = kind
    check_names(what, keywords, [one.name for one in fields(known)])
    given = {name: value for name, value in plain(keywords).items() if (name, value) != ("max_episode_steps", None)}
    options = kind(**given)
    optional = {one.name for one in fields(known) if one.default is None}
    for name, allowed in limits.choices.items():
        check_choice(name, getattr(options, name), allowed)
    for whole, ranges in ((False, limits.ranges), (True, limits.whole)):
        for name, (low, high) in ranges.items():
            if getattr(options, name) is not None or name not in optional:
                check_range(name, getattr(options, name), low, high, whole)
    for name in limits.switches:
        check_switch(name, getattr(options, name))
    check_step_limit(getattr(options, "max_episode_steps", -1))
    return options


Function = TypeVar("Function", bound=Callable[..., Any])


def takes_keywords_of(options: type[Any], without: Iterable[str] = ()) -> Callable[[Function], Function]:
    """Return a decorator that shows a dataclass's fields as the keywords of a function that ends in ``**keywords``.

    Type checkers read them from the ``TypedDict`` in the annotation; an interactive session reads the signature.

    Args:
        options: The dataclass.
        without: Those of its fields that the function does not take.
    """
    hints = get_type_hints(options)
    shown = [
        Parameter(field.name, Parameter.KEYWORD_ONLY, default=field.default, annotation=hints[field.name])
        for field in fields(options)
        if field.name not in set(without)
    ]

    def decorate(function: Function) -> Function:
        own = list(signature(function).parameters.values())[:-1]
        names = {parameter.name for parameter in own}
        keywords = [parameter for parameter in shown if parameter.name not in names]
        function.__signature__ = Signature([*own, *keywords])  # type: ignore[attr-defined]
        return function

    return decorate
