"""What the keywords ``robot`` and ``lidar`` take: a preset's name, changes by name, an object, or who makes one."""

from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.import_names import import_named

Spec = TypeVar("Spec")
Presets = Mapping[str, Mapping[str, Any]]


def read_spec(
    keyword: str,
    value: Any,
    kind: type[Spec],
    fields: Iterable[str],
    presets: Presets,
    either: tuple[str, ...] = (),
) -> Spec | dict[str, Any]:
    """Read a keyword's value.

    Args:
        keyword: Its name.
        value: None; a preset's name; a mapping of changes, with ``preset`` of changes to that; a ``kind``; or
            ``"module:callable"``, which is called without arguments and returns a mapping or a ``kind``.
        kind: Class of the object.
        fields: What may be changed.
        presets: Changes by name.
        either: Fields of which one takes the place of the others.

    Returns:
        The object, or all changes to the default by name.

    Raises:
        ConfigError: Something else, an unknown preset or field, or a module or name that is not there.
    """
    if isinstance(value, str) and ":" in value:
        value = _made(keyword, value, kind)
    if isinstance(value, kind):
        return value
    if value is None:
        return {}
    if isinstance(value, str):
        value = {"preset": value}
    if not isinstance(value, Mapping):
        raise ConfigError(
            f"{keyword} = {value!r} must be the name of a preset, numbers by name, a {kind.__name__}, or "
            "'module:callable' that makes one"
        )
    changes, own = _changes(keyword, value, list(fields), presets)
    chosen = [name for name in either if own.get(name) is not None]
    if len(chosen) > 1:
        raise ConfigError(f"{keyword} was given {' and '.join(chosen)}; one of them says what it is like")
    return {name: item for name, item in changes.items() if not chosen or name not in either or name in own} | own


def _made(keyword: str, name: str, kind: type[Any]) -> Any:
    """What ``"module:callable"`` makes."""
    made = import_named(name, f"{keyword} {name!r}")
    made = made() if callable(made) else made
    if not isinstance(made, kind | Mapping):
        raise ConfigError(f"{keyword} = {name!r} made a {type(made).__name__}, a {kind.__name__} is needed")
    return made


def _changes(
    keyword: str, value: Mapping[str, Any], fields: list[str], presets: Presets
) -> tuple[Mapping[str, Any], dict[str, Any]]:
    """A preset's changes, and those given."""
    for name in value:
        if name not in (*fields, "preset"):
            raise ConfigError(f"{keyword} has no {name!r}{suggest(str(name), [*fields, 'preset'])}")
    preset = value.get("preset")
    if preset is not None and preset not in presets:
        raise ConfigError(f"{keyword} = {preset!r} is not known{suggest(str(preset), presets)}")
    own = {name: item for name, item in value.items() if name != "preset"}
    return presets[preset] if preset is not None else {}, own
