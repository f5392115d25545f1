"""Observations of one's own: the keyword ``observation`` of every family takes an object that looks at an info.

    class Nearest:
        space = gym.spaces.Box(0.0, 1.0, (1,), np.float32)

        def observe(self, info):
            return info["scan"].min(keepdims=True) / np.float32(3.5)

    env = gym.make("lidarena/Env1-v0", observation=Nearest())  # or observation="my_module:Nearest", also in YAML

It is asked about one world (of a team: one robot) at a time, and never told the truth.
"""

from collections.abc import Callable, Sequence
from inspect import isclass
from typing import Any, Protocol, cast

import gymnasium as gym
import numpy as np
from gymnasium.vector.utils import concatenate, create_empty_array
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, ObservationError, suggest
from lidarena.base.import_names import import_named
from lidarena.envs.infos import Info

_KINDS = (gym.spaces.Box, gym.spaces.Discrete, gym.spaces.MultiDiscrete, gym.spaces.MultiBinary)


class Observer(Protocol):
    """Makes a policy's observation of one world, or of one robot of a team.

    Attributes:
        space: Of the observation: a ``Box``, ``Discrete``, ``MultiDiscrete`` or ``MultiBinary``, or a ``Dict`` of
            these; of a robot in a team a ``Box``.
    """

    space: gym.Space[Any]

    def observe(self, info: Info) -> Any:
        """Return what is observed, in ``space``.

        Args:
            info: What the environment tells at this moment, without ``reward_terms`` and ``truth``.
        """


ObservationSpec = str | Observer | Callable[[], Observer]


def choose_observer(spec: Any, names: Sequence[str], boxes_only: bool = False) -> str | Observer:
    """Make out what the keyword ``observation`` asks for.

    Args:
        spec: A name, an ``Observer``, what makes one when it is called, or ``"module:name"`` of either.
        names: The family's own.
        boxes_only: Refuse all spaces but boxes.

    Returns:
        One of the names, or the observer.

    Raises:
        ConfigError: There is no such observation, or its space is of another kind.
    """
    if isinstance(spec, str) and ":" not in spec:
        if spec not in names:
            raise ConfigError(f"observation = {spec!r} is not known{suggest(spec, names)}, or 'module:name'")
        return spec
    found = import_named(spec, f"observation = {spec!r}") if isinstance(spec, str) else spec
    if callable(found) and (isclass(found) or not _is_observer(found)):
        try:
            found = found()
        except TypeError as error:
            raise ConfigError(f"observation = {spec!r} cannot be made without arguments: {error}") from None
    if not _is_observer(found):
        allowed = ", ".join(names)
        raise ConfigError(f"observation = {spec!r} must have a space and observe(info), or be one of {allowed}")

    _check_space(spec, found.space, boxes_only)
    observer: Observer = found
    return observer


def _is_observer(found: Any) -> bool:
    return isinstance(getattr(found, "space", None), gym.Space) and callable(getattr(found, "observe", None))


def _check_space(spec: Any, space: gym.Space[Any], boxes_only: bool) -> None:
    parts = list(space.values()) if isinstance(space, gym.spaces.Dict) and not boxes_only else [space]
    kinds = _KINDS[:1] if boxes_only else _KINDS
    for part in parts:
        if not isinstance(part, kinds):
            allowed = ", ".join(kind.__name__ for kind in kinds)
            raise ConfigError(f"observation = {spec!r} has the space {part}; allowed are {allowed}")


class OneByOne:
    """Asks an observer about each world of a batch.

    Args:
        observer: Of one's own.
        shape: (worlds,) or (worlds, robots).
    """

    def __init__(self, observer: Observer, shape: tuple[int, ...]) -> None:
        self._observer, self._shape = observer, shape

    def observe(self, info_of: Callable[[tuple[int, ...]], Info], hidden: NDArray[np.bool_] | None = None) -> Any:
        """Return fresh observations of all, leading with the shape's product; zeros where ``hidden`` says so, in a box.

        Raises:
            ObservationError: One is not in the space.
        """
        space, count = self._observer.space, int(np.prod(self._shape))
        seen = [
            self._one(info_of(index))
            if hidden is None or not hidden[index]
            else np.zeros(space.shape or (), space.dtype)
            for index in np.ndindex(self._shape)
        ]
        return concatenate(space, seen, cast(Any, create_empty_array(space, n=count)))

    def _one(self, info: Info) -> Any:
        info.pop("truth", None)
        seen = self._observer.observe(info)
        if not self._observer.space.contains(seen):
            shown = getattr(seen, "dtype", ""), getattr(seen, "shape", "")
            raise ObservationError(
                f"observation {type(self._observer).__qualname__!r} gave {_shortened(seen)}"
                f"{' of ' + str(shown[0]) + ' ' + str(shown[1]) if shown[0] else ''}, "
                f"which is not in its space {self._observer.space}"
            )
        return seen


def _shortened(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) < 80 else text[:77] + "..."
