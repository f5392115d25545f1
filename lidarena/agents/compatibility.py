"""Whether an agent fits an environment: if not, one sentence that says which keyword would make it fit."""

from collections.abc import Mapping
from typing import Any

from gymnasium import spaces
from stable_baselines3.common.preprocessing import is_image_space
from stable_baselines3.common.vec_env.vec_transpose import VecTransposeImage

from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.base.errors import LidarenaError, PolicyFileError
from lidarena.envs.registration import family_named, family_of, owner_of, registration_of

_LONGEST = 120
"""Characters of a space in a message."""


def check_family(learned: LearnedPolicy, env: Any, origin: str) -> None:
    """Refuse an environment of another family than the one that an agent was trained in.

    Raises:
        PolicyFileError: It names both.
    """
    registered, here = registration_of(learned.env_id), family_of(env)
    if registered is not None and here is not None and registered[0].name != here:
        raise PolicyFileError(
            f"{origin} was trained for {registered[0].name} environments, but this one is of the family {here!r}"
        )


def check_options(learned: LearnedPolicy, env: Any, origin: str) -> None:
    """Refuse an environment whose observations or actions mean something else, even where they have the same shape.

    The environment's ``options`` are compared with those that the agent's keywords give, as far as they are not left
    to the environment (None); of an environment that has none nothing is known.

    Raises:
        PolicyFileError: It names what differs, and the keywords that make it right.
    """
    owner, family = owner_of(env, "options"), family_of(env)
    if owner is None or family is None:
        return
    names = family_named(family).agent_options
    trained = _options_of(learned, type(owner.options), {name.partition(".")[0] for name in names})
    if trained is None:
        return
    pairs = {name: (_value(trained, name), _value(owner.options, name)) for name in names}
    odd = {name: pair for name, pair in pairs.items() if pair[0] not in (None, pair[1])}
    if odd:
        wanted, found = (_enumerated([f"{name} {pair[side]!r}" for name, pair in odd.items()]) for side in (0, 1))
        raise PolicyFileError(
            f"{origin} was trained for {family} environments with {wanted}, but this environment has {found}; "
            f"make it with {_keywords({name: pair[0] for name, pair in odd.items()})}"
        )


def check_spaces(learned: LearnedPolicy, env: Any, origin: str) -> None:
    """Refuse an environment that shows something else or takes other actions than the one trained in.

    Bounds of observations do not matter, since a network does not know them.

    Raises:
        PolicyFileError: It names both spaces.
    """
    for what, trained in (("observation", learned.observation_space), ("action", learned.action_space)):
        space = space_of(env, what)
        if not _alike(what, space, trained):
            before, here = _shown(trained), _shown(space)
            raise PolicyFileError(
                f"{origin} was trained in {learned.env_id!r} with {what}s {before}, "
                f"but this environment has {what}s {here}{' of other bounds or types' if before == here else ''}"
            )


def fits(learned: LearnedPolicy, env: Any) -> bool:
    """Whether an environment has the spaces that an agent was trained with."""
    trained = {"observation": learned.observation_space, "action": learned.action_space}
    return all(_alike(what, space_of(env, what), space) for what, space in trained.items())


def _alike(what: str, space: Any, trained: spaces.Space[Any]) -> bool:
    """Whether a space is to a network as the one that it was trained with."""
    if what == "observation" and isinstance(space, spaces.Dict) and isinstance(trained, spaces.Dict):
        same = space.spaces.keys() == trained.spaces.keys()
        return same and all(_alike(what, space[key], part) for key, part in trained.spaces.items())
    if what == "observation" and isinstance(space, spaces.Box) and isinstance(trained, spaces.Box):
        return space.shape == trained.shape and space.dtype == trained.dtype
    return bool(space == trained)


def space_of(env: Any, what: str) -> Any:
    """One environment's space, ``"observation"`` or ``"action"``; pictures as Stable-Baselines3 turns them."""
    single = f"single_{what}_space"
    space = getattr(env, single) if hasattr(env, single) else getattr(env, f"{what}_space")
    if isinstance(space, spaces.Dict):
        return spaces.Dict({key: _turned(part) for key, part in space.spaces.items()})
    return _turned(space)


def _shown(space: Any) -> str:
    """A space in one line; long ones by their shape alone."""
    text = " ".join(str(space).split())
    return text if len(text) <= _LONGEST else f"{type(space).__name__} of shape {getattr(space, 'shape', None)}"


def _turned(space: Any) -> Any:
    """A picture's space with its channels first; any other space as it is."""
    if isinstance(space, spaces.Box) and is_image_space(space) and min(space.shape) == space.shape[-1] < space.shape[0]:
        return VecTransposeImage.transpose_space(space)
    return space


def _options_of(learned: LearnedPolicy, kind: Any, wanted: set[str]) -> Any:
    """The options that an agent was trained with; None where they cannot be told."""
    if not hasattr(kind, "checked"):
        return None
    needed = {key: value for key, value in learned.env_keywords.items() if key in wanted}
    for keywords in (learned.env_keywords, needed):
        try:
            return kind.checked(keywords)
        except LidarenaError:  # such as a file of the training's that is not here; it is of no matter to an agent
            continue
    return None


def _value(options: Any, name: str) -> Any:
    """An option, or a part of one: ``lidar.beams``."""
    for part in name.split("."):
        options = options.get(part) if isinstance(options, Mapping) else getattr(options, part, None)
    return options


def _enumerated(words: list[str]) -> str:
    """Such as ``"a, b and c"``."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _keywords(values: Mapping[str, Any]) -> str:
    """Options as they are typed: ``observation='proximity', lidar={'beams': 36}``."""
    typed: dict[str, Any] = {}
    for name, value in values.items():
        option, _, part = name.partition(".")
        typed[option] = {**typed.get(option, {}), part: value} if part else value
    return ", ".join(f"{name}={value!r}" for name, value in typed.items())
