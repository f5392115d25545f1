"""YAML files into pydantic models, and every mistake in them into one sentence.

What a configuration may hold is a pydantic model that derives from `ConfigModel`; this file reads and writes it:

    config = load_config("configs/train/quick.yaml", TrainingConfig, ["ppo.n_steps=256"])
    dump_config(config, "runs/quick/config.yaml")
"""

import re
import types
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

import yaml
from pydantic import BaseModel, ConfigDict, ValidationError, ValidationInfo, field_validator
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.files import write_text

M = TypeVar("M", bound=BaseModel)

_VALUE_WIDTH = 60
_EXOTIC_LINE_BREAKS = frozenset("\x85\u2028\u2029")


class ConfigModel(BaseModel):
    """Base of every configuration: immutable, no unknown keys, no NaN, and no `true` where a number belongs."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, ser_json_inf_nan="constants")

    @field_validator("*", mode="before")
    @classmethod
    def _no_boolean_numbers(cls, value: Any, info: ValidationInfo) -> Any:
        field = cls.model_fields.get(info.field_name or "")
        if isinstance(value, bool) and field is not None:
            kinds = set(_alternatives(field.annotation))
            if bool not in kinds and kinds & {int, float}:
                raise ValueError("should be a number, not true or false")
        return value


class _Loader(yaml.SafeLoader):
    """YAML 1.1 as PyYAML reads it, but ``3e-4`` is a number and a key given twice is an error."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        seen = set()
        for key_node, _ in node.value:
            if isinstance(key_node, yaml.ScalarNode) and key_node.tag != "tag:yaml.org,2002:merge":
                if key_node.value in seen:
                    raise yaml.constructor.ConstructorError(
                        None, None, f"the key {key_node.value!r} is given twice", key_node.start_mark
                    )
                seen.add(key_node.value)
        return super().construct_mapping(node, deep=deep)


class _Dumper(yaml.SafeDumper):
    """Writes what `_Loader` reads: the text ``3e-4`` goes into quotes."""


for _side in (_Loader, _Dumper):
    _side.add_implicit_resolver(
        "tag:yaml.org,2002:float", re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+$"), list("-+.0123456789")
    )


def load_config(path: str | Path, model: type[M], overrides: Sequence[str] = ()) -> M:
    """Read a YAML file, apply the overrides of the command line, and check everything.

    Args:
        path: The YAML file.
        model: What it may hold.
        overrides: ``key.sub=value`` each, later ones win; the value is read as YAML, a number in the key is a place in
            a list, and sections that the file leaves out are made.

    Returns:
        The checked configuration.

    Raises:
        ConfigError: The file is missing, empty or torn, or a key or value is wrong; one sentence.
    """
    return check_config(read_yaml(path), model, overrides, origin=str(path))


def check_config(
    content: Mapping[str, Any], model: type[M], overrides: Sequence[str] = (), origin: str = "the configuration"
) -> M:
    """Check a configuration that is already a mapping; see `load_config`.

    Args:
        content: The mapping; it is not changed.
        model: What it may hold.
        overrides: See `load_config`.
        origin: How a refusal calls the place that ``content`` came from.
    """
    try:
        values = _copy(content)
        for override in overrides:
            _apply(values, override)
        return model.model_validate(values)
    except ValidationError as error:
        detail = _most_telling(error)
        key = ".".join(_walk(model, detail["loc"])[0])
        raise ConfigError(_sentence(detail, model, _blamed(content, model, overrides, key, origin))) from None
    except RecursionError:
        raise ConfigError(f"{origin} is nested too deeply or contains itself") from None


def as_config(given: Any, model: type[M]) -> M:
    """Return the configuration that somebody gave in one of the ways in which one may.

    Args:
        given: One of ``model``, a mapping (see `check_config`) or the path of a YAML file (see `load_config`).
        model: What it may hold.

    Raises:
        ConfigError: It is none of them, or holds what is wrong.
    """
    if isinstance(given, model):
        return given
    if isinstance(given, Mapping):
        return check_config(given, model)
    if isinstance(given, str | Path):
        return load_config(given, model)
    raise ConfigError(f"{given!r} is no configuration; a {model.__name__}, a dictionary or a YAML file is needed")


def _blamed(content: Mapping[str, Any], model: type[BaseModel], overrides: Sequence[str], key: str, origin: str) -> str:
    """Who is to blame for what is wrong at ``key``: the last override that sets it, all of them, or the file."""
    for override in reversed(overrides):
        name = override.partition("=")[0].strip()
        if key and f"{key}.".startswith(f"{name}."):
            return f"--set {override!r}"
    try:
        model.model_validate(_copy(content))
    except ValidationError:
        return origin
    return f"{origin} with --set {' '.join(overrides)}" if overrides else origin


def read_yaml(path: str | Path) -> dict[str, Any]:
    """Read a YAML file whose top level is a mapping.

    Raises:
        ConfigError: The file is missing, unreadable, empty, torn, or no mapping; one sentence.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise ConfigError(f"there is no file {str(path)!r}{_neighbours(file)}") from None
    except IsADirectoryError:
        raise ConfigError(f"{str(path)!r} is a folder, not a YAML file") from None
    except UnicodeDecodeError:
        raise ConfigError(f"{str(path)!r} is not a text file in UTF-8, so it is no YAML file") from None
    except OSError as error:
        raise ConfigError(f"cannot read {str(path)!r}: {error.strerror}") from None
    content = _parse(text, f"{str(path)!r}")
    if content is None:
        raise ConfigError(f"{str(path)!r} is empty; it should hold keys and values such as 'seed: 0'")
    if not isinstance(content, dict):
        raise ConfigError(
            f"{str(path)!r} holds {_kind(content)} at its top level, not keys and values such as 'seed: 0'"
        )
    return content


def dump_config(model: BaseModel, path: str | Path) -> Path:
    """Write a configuration so that `load_config` gives it back equal; the file appears whole or not at all."""
    content = model.model_dump(mode="json", by_alias=True)
    text = yaml.dump(content, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=120)
    if not _EXOTIC_LINE_BREAKS.isdisjoint(text):  # PyYAML writes them plainly, and reads them as spaces
        text = yaml.dump(content, Dumper=_Dumper, sort_keys=False, allow_unicode=False, width=120)
    return write_text(path, text)


def _parse(text: str, origin: str) -> Any:
    try:
        return yaml.load(text, Loader=_Loader)  # a SafeLoader, so it makes plain values only
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f" in line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise ConfigError(f"{origin} is not valid YAML{place}: {error.problem or error.context}") from None
    except yaml.YAMLError as error:
        raise ConfigError(f"{origin} is not valid YAML: {' '.join(str(error).split())}") from None
    except RecursionError:
        raise ConfigError(f"{origin} is nested too deeply") from None
    except ValueError as error:  # such as the date 2024-99-99
        raise ConfigError(f"{origin} is not valid YAML: {error}") from None


def _neighbours(file: Path) -> str:
    """The right spelling of a file that is not there, if its folder holds YAML files."""
    names = [other.name for other in (*file.parent.glob("*.yaml"), *file.parent.glob("*.yml"))]
    return suggest(file.name, names) if names else ""


def _copy(value: Any) -> Any:
    """A deep copy of the mappings and lists alone, in which aliases of YAML become separate values."""
    if isinstance(value, Mapping):
        return {key: _copy(sub) for key, sub in value.items()}
    if isinstance(value, list):
        return [_copy(item) for item in value]
    return value


def _apply(values: dict[str, Any], override: str) -> None:
    """Set one ``key.sub=value`` in ``values``."""
    key, equals, text = override.partition("=")
    names = key.strip().split(".")
    if not equals or not all(names):
        raise ConfigError(f"--set {override!r} should have the form key=value or key.sub=value")
    value = _parse(text, f"the value of --set {override!r}")
    place: Any = values
    for depth, name in enumerate(names):
        last = depth == len(names) - 1
        if isinstance(place, list):
            if not name.isdecimal() or int(name) >= len(place):
                where = ".".join(names[:depth])
                raise ConfigError(
                    f"--set {override!r}: {where!r} is a list of {len(place)}, so {name!r} should be a number"
                    f" from 0 to {len(place) - 1}"
                )
            index: Any = int(name)
        elif isinstance(place, dict):
            index = name
            if not last and place.get(name) is None:
                place[name] = {}
        else:
            where = ".".join(names[:depth])
            raise ConfigError(f"--set {override!r}: {where!r} is {_shown(place)}, which has no key {name!r}")
        if last:
            place[index] = value
        else:
            place = place[index]


def _most_telling(error: ValidationError) -> ErrorDetails:
    """The error that a sentence is made of: a key that there is not, or the one deepest inside."""
    details = error.errors(include_url=False)
    return min(details, key=lambda detail: (detail["type"] != "extra_forbidden", -len(detail["loc"])))


def _sentence(first: ErrorDetails, model: type[BaseModel], origin: str) -> str:
    """One of pydantic's errors as one sentence."""
    path, kinds = _walk(model, first["loc"])
    key = ".".join(path)
    if first["type"] == "extra_forbidden":
        section = f"a key of {'.'.join(path[:-1])!r}" if path[1:] else "a key"
        allowed = sorted({name for kind in kinds for name in _fields(kind)})
        return f"{origin}: {key!r} is not {section}{suggest(str(path[-1]), allowed)}"
    if first["type"] == "missing":
        return f"{origin}: the key {key!r} is missing"
    return f"{origin}: {_complaint(first, key)}"


def _complaint(detail: ErrorDetails, key: str) -> str:
    """Pydantic's message as the second half of a sentence that names key and value."""
    message = detail["msg"].removeprefix("Value error, ").removeprefix("Assertion failed, ")
    if detail["type"] == "literal_error":
        allowed = re.findall(r"'([^']*)'", detail["ctx"]["expected"])
        return f"{key!r} is {_shown(detail['input'])}, which is not known{suggest(str(detail['input']), allowed)}"
    if not key:
        return message
    if detail["type"] in ("model_type", "model_attributes_type", "dict_type"):
        message = "it should be a section of keys and values"
    message = message.replace("Input should", "it should", 1)
    if message.startswith("should"):
        message = f"it {message}"
    return f"{key!r} is {_shown(detail['input'])}, but {message}"


def _walk(model: type[BaseModel], loc: tuple[int | str, ...]) -> tuple[list[str], list[type[BaseModel]]]:
    """Follow pydantic's error location through the types.

    Returns:
        The keys as the file spells them (without the names that pydantic gives to the branches of a union), and the
        models in which the last key was looked for.
    """
    path: list[str] = []
    kinds: list[Any] = [model]
    for depth, name in enumerate(loc):
        if len(kinds) > 1 and _is_branch(name, kinds):
            kinds = [kind for kind in kinds if getattr(kind, "__name__", None) == name] or kinds
            continue
        models = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
        if depth == len(loc) - 1 and models:
            return [*path, str(name)], models
        fields = [_fields(kind)[str(name)].annotation for kind in models if name in _fields(kind)]
        items = [arg for kind in kinds for arg in _item_types(kind)]
        if fields:
            kinds = [branch for field in fields for branch in _alternatives(field)]
        else:
            kinds = [branch for item in items for branch in _alternatives(item)]
        path.append(str(name))
    return path, []


def _fields(kind: type[BaseModel]) -> dict[str, FieldInfo]:
    """The fields of a model by the keys that a file spells them with."""
    return {field.alias or name: field for name, field in kind.model_fields.items()}


def _is_branch(name: int | str, kinds: Sequence[Any]) -> bool:
    """Whether pydantic put this name into a location to say which branch of a union it tried."""
    if not isinstance(name, str):
        return False
    name = name.removeprefix("constrained-")
    return "[" in name or any(getattr(kind, "__name__", None) == name for kind in kinds)


def _item_types(kind: Any) -> tuple[Any, ...]:
    """What a list, tuple or mapping type holds."""
    origin = get_origin(kind)
    if origin in (list, tuple, set, frozenset, Sequence):
        return tuple(arg for arg in get_args(kind) if arg is not Ellipsis)
    if origin in (dict, Mapping):
        return get_args(kind)[1:]
    return ()


def _alternatives(annotation: Any) -> Iterator[Any]:
    """The branches of a union, with `Annotated` taken off."""
    origin = get_origin(annotation)
    if origin is Annotated:
        yield from _alternatives(get_args(annotation)[0])
    elif origin in (Union, types.UnionType):
        for branch in get_args(annotation):
            yield from _alternatives(branch)
    else:
        yield annotation


def _shown(value: Any) -> str:
    """A value as the file spells it, shortened."""
    text = {"True": "true", "False": "false", "None": "empty"}.get(repr(value), repr(value))
    return text if len(text) <= _VALUE_WIDTH else f"{text[: _VALUE_WIDTH - 1]}…"


def _kind(value: Any) -> str:
    return {list: "a list", str: "a text", int: "a number", float: "a number"}.get(type(value), type(value).__name__)
