"""What a step is worth: the one mechanism behind the keyword ``reward`` of every family.

A family names its terms and some presets of their weights. ``reward`` is the name of a preset, weights by term, or a
function of one's own::

    def curious(step: Step) -> float:
        return step.info["completeness"] - step.previous["completeness"] - 0.1 * step.info["collision"]

    env = gym.make("lidarena/Env1-v0", reward=curious)  # or reward="my_module:curious", also in YAML

It is asked about one world (of a team: one robot) at a time, so that a world of a batch earns to the bit what it earns
alone.
"""

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from inspect import isclass, signature
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, RewardError, suggest
from lidarena.base.import_names import import_named
from lidarena.base.keyword_checks import check_range
from lidarena.envs.infos import Info

Floats = NDArray[np.float64]

OWN_TERM = "own"
"""Name of the term of a function that returns a single number."""
_LARGEST_WEIGHT = 1e6


@dataclass(frozen=True)
class Step:
    """One step of one world, or of one robot of a team, as a reward function sees it.

    Attributes:
        info: What the environment tells after the step, without ``reward_terms``.
        previous: What it told before the step.
        action: That was taken.
        terms: The family's own terms of this step by name, each of weight 1.
        robot: Number of the robot in its team; 0 where it is alone.
    """

    info: Info
    previous: Info
    action: Any
    terms: Mapping[str, float]
    robot: int = 0


RewardFunction = Callable[[Step], float | Mapping[str, float]]
RewardSpec = str | Mapping[str, float | str] | RewardFunction
Facts = Callable[[], Callable[[tuple[int, ...]], Info]]


@dataclass(frozen=True)
class RewardTerms:
    """What a family's steps can be worth.

    Attributes:
        names: Of the terms, in the order in which they are added up.
        presets: Weights by term, by the preset's name.
    """

    names: tuple[str, ...]
    presets: Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class ChosenReward:
    """What the keyword ``reward`` came to.

    Attributes:
        weights: By term, in the family's order; with a function of one's own every term has the weight 1.
        preset: The preset that the weights began with, if any.
        function: Of one's own, if any.
    """

    weights: Mapping[str, float]
    preset: str | None = None
    function: RewardFunction | None = None


def choose_reward(spec: Any, terms: RewardTerms) -> ChosenReward:
    """Make out what the keyword ``reward`` asks for.

    Args:
        spec: A preset's name, ``{term: weight}``, the same with ``"preset": name`` whose weights it changes, a function
            of a ``Step``, or ``"module:function"``.
        terms: The family's.

    Raises:
        ConfigError: There is no such preset, term or function, or a weight is out of range.
    """
    if isinstance(spec, str) and ":" in spec:
        return _of_function(import_named(spec, f"reward = {spec!r}"), spec, terms)
    if isinstance(spec, str):
        return _of_weights({"preset": spec}, terms)
    if isinstance(spec, Mapping):
        return _of_weights(spec, terms)
    return _of_function(spec, spec, terms)


def _of_weights(spec: Mapping[Any, Any], terms: RewardTerms) -> ChosenReward:
    preset = spec.get("preset")
    if preset is not None and not (isinstance(preset, str) and preset in terms.presets):
        raise ConfigError(
            f"reward = {preset!r} is not known{suggest(str(preset), terms.presets)}, or 'module:function'"
        )
    weights = dict(terms.presets[preset]) if preset is not None else {}
    for name, weight in spec.items():
        if name == "preset":
            continue
        if name not in terms.names:
            raise ConfigError(f"unknown term {name!r} of the reward{suggest(str(name), terms.names)}")
        check_range(f"reward.{name}", weight, 0.0, _LARGEST_WEIGHT)
        weights[name] = float(weight)
    if not weights:
        raise ConfigError(f"reward = {spec!r} names no term{suggest('', terms.names)}")
    return ChosenReward({name: weights[name] for name in terms.names if name in weights}, preset)


def _of_function(function: Any, shown: Any, terms: RewardTerms) -> ChosenReward:
    made = function
    if isclass(function):
        try:
            made = function()
        except TypeError as error:
            raise ConfigError(f"reward = {shown!r} is a class that cannot be made without arguments: {error}") from None
    if not callable(made):
        raise ConfigError(
            f"reward = {shown!r} must be a function of a step, weights by term, or one of {', '.join(terms.presets)}"
        )
    try:
        signature(made).bind(None)
    except TypeError as error:
        raise ConfigError(f"reward = {shown!r} must take one argument, the step: {error}") from None
    except ValueError:  # a compiled function that does not tell: the first step will
        pass
    return ChosenReward(dict.fromkeys(terms.names, 1.0), None, made)


class StepRewards:
    """Adds up the rewards of a batch, and remembers what its last step was worth.

    Args:
        chosen: What a step is worth.
        shape: (worlds,) or (worlds, robots).
        facts: Called once a step; what it returns tells the info of one world, or robot, by its index.

    Attributes:
        chosen: As given.
        terms: Of the last step by name, of that shape each.
    """

    def __init__(self, chosen: ChosenReward, shape: tuple[int, ...], facts: Facts) -> None:
        self.chosen, self._shape, self._facts = chosen, shape, facts
        names = chosen.weights if chosen.function is None else ()
        self.terms: dict[str, Floats] = {name: np.zeros(shape) for name in names}
        self._previous: dict[tuple[int, ...], Info] = {}

    def begin(self, world: int) -> None:
        """Begin a new episode in a world that has been reset."""
        for term in self.terms.values():
            term[world] = 0.0

    def look(self, worlds: Any = slice(None)) -> None:
        """Remember what some worlds tell before their next step, if a function is to be told."""
        if self.chosen.function is None:
            return
        chosen = np.zeros(self._shape, np.bool_)
        chosen[worlds] = True
        info_of = self._facts()
        for index in map(tuple, np.argwhere(chosen).tolist()):
            self._previous[index] = info_of(index)

    def tell(self, facts: Info) -> Info:
        """Add to what a step tells what it was worth, as ``reward_terms``; returns the same dictionary."""
        facts["reward_terms"] = {name: term.copy() for name, term in self.terms.items()}
        return facts

    def add_up(self, weighed: dict[str, Floats], actions: Any, asked: NDArray[np.bool_] | None = None) -> Floats:
        """Return the rewards of a step.

        Args:
            weighed: The family's terms, each times its weight in ``chosen.weights``.
            actions: That were taken, leading with the shape.
            asked: Which worlds, or robots, earn anything; None for all.

        Raises:
            RewardError: The function gave no finite numbers.
        """
        if self.chosen.function is None:
            self.terms = weighed
        else:
            earning = np.ones(self._shape, np.bool_) if asked is None else asked
            self.terms = self._ask(self.chosen.function, weighed, np.asarray(actions), earning)
        rewards = np.zeros(self._shape)
        for term in self.terms.values():
            rewards += term
        return rewards

    def _ask(
        self, function: RewardFunction, weighed: dict[str, Floats], actions: NDArray[Any], asked: NDArray[np.bool_]
    ) -> dict[str, Floats]:
        made = {name: np.zeros(self._shape) for name in self.terms}
        info_of = self._facts()
        for index in map(tuple, np.argwhere(asked).tolist()):
            info, action = info_of(index), actions[index]
            own = {name: term[index].item() for name, term in weighed.items()}
            taken = action.item() if action.ndim == 0 else action.copy()
            step = Step(info, self._previous[index], taken, own, index[1] if len(index) > 1 else 0)
            given = numbers_of(function(step), function)
            if not made:
                made = {name: np.zeros(self._shape) for name in given}
            if given.keys() != made.keys():
                raise RewardError(
                    f"reward {_name_of(function)} gave the terms {', '.join(given)}, before it was {', '.join(made)}; "
                    "they must always be the same"
                )
            for name, value in given.items():
                made[name][index] = value
            self._previous[index] = info
        return made


def numbers_of(value: Any, function: RewardFunction) -> dict[str, float]:
    """Return what a reward function gave as terms by name.

    Raises:
        RewardError: It is neither a finite number nor a dictionary of them.
    """
    terms = value if isinstance(value, Mapping) else {OWN_TERM: value}
    if not terms:
        raise RewardError(f"reward {_name_of(function)} gave {value!r}, a dictionary without a single term")
    made = {}
    for name, number in terms.items():
        try:
            made[str(name)] = float(number) if np.ndim(number) == 0 and not isinstance(number, str) else math.nan
        except (TypeError, ValueError):
            made[str(name)] = math.nan
        if not math.isfinite(made[str(name)]):
            of_term = f" for its term {name!r}" if terms is value else ""
            raise RewardError(
                f"reward {_name_of(function)} gave {number!r}{of_term}; "
                "a finite number, or a dictionary of them by term, is needed"
            )
    return made


def _name_of(function: Any) -> str:
    return repr(getattr(function, "__qualname__", None) or type(function).__qualname__)


def reward_of_weights(keywords: Mapping[str, Any], weights: Mapping[str, str], preset: str) -> dict[str, Any]:
    """Return keywords in which the weights of version 0.1, a keyword each, are the keyword ``reward``.

    Args:
        keywords: As given.
        weights: The term of each such keyword.
        preset: Whose weights they change.

    Raises:
        ConfigError: They are given together with ``reward``.
    """
    old = [name for name in keywords if name in weights]
    if not old:
        return dict(keywords)
    if "reward" in keywords:
        raise ConfigError(f"both {old[0]} and reward are given; give the weight of {weights[old[0]]!r} in reward alone")
    reward: dict[str, Any] = {"preset": preset} | {weights[name]: keywords[name] for name in old}
    warnings.warn(f"{', '.join(old)} is given as reward = {reward!r} now", DeprecationWarning, stacklevel=4)
    return {name: value for name, value in keywords.items() if name not in weights} | {"reward": reward}
