"""Simulated humans: how quickly they work, what they like to do next, when they rest or leave; and humans of one's own.

class Tidy:
    def choose(self, info, rng):
        return int(info["allowed_human"].nonzero()[0][0])   # a number of an action, or None to rest

env = gym.make("lidarena/Workshop-v0", human=Tidy)   # or human="my_module:Tidy", also in YAML
"""

from collections.abc import Callable
from inspect import isclass
from typing import Any, NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.import_names import import_named
from lidarena.envs.infos import Info
from lidarena.envs.workshop.task import HUMAN, ROBOT, WorkshopTask

KINDS = ("free", "helpful", "stubborn", "slow", "absent", "mixture")
"""Built in, by their names."""
EXTERNAL = "external"
"""The kind whose choices come from outside: of one's own, or PettingZoo's agent ``human``."""
TRUNCATION = 3.0
"""Log-normal durations are drawn within so many standard deviations of the logarithm."""
WITHIN_BOUNDS = 1.6449
"""Bounds are the 5% and 95% quantiles of the durations of a human of pace and spread 1."""


class Traits(NamedTuple):
    """What a human is like in an episode; numbers that the kernel reads."""

    pace: float = 1.0
    """Factor on the usual durations"""
    spread: float = 1.0
    """Factor on the standard deviation of their logarithm"""
    nearness: float = 0.0
    """How much a way of 10 s counts against an action"""
    urgency: float = 0.0
    """How much it counts for an action that everything waits for"""
    liking: float = 0.0
    """How much its own preferences count"""
    randomness: float = 1.0
    """Of choices: the scale of Gumbel noise; with 1 and no other weights all allowed actions are equally likely"""
    rest_chance: float = 0.0
    """Of a rest before a choice"""
    rest_time: float = 0.0
    """Its mean [s]"""
    leaves_at: float = np.inf
    """When it leaves for a while [s]"""
    away_time: float = 0.0
    """For how long [s]"""


class Human(Protocol):
    """A human of one's own."""

    def choose(self, info: Info, rng: np.random.Generator) -> int | None:
        """Return the number of the next action, or None to rest until something happens or 5 s have passed.

        An action that is not allowed, out of order or not the human's by the task, is done all the same.

        Args:
            info: What the environment tells, with ``allowed_human`` (n,).
            rng: The human's own generator.
        """


HumanSpec = str | Human | Callable[..., Any]


def choose_human(spec: Any) -> str | Human:
    """Make out what the keyword ``human`` asks for: one of ``KINDS`` or ``EXTERNAL``, or an object with ``choose``.

    Raises:
        ConfigError: There is no such human.
    """
    if isinstance(spec, str) and ":" not in spec:
        if spec not in (*KINDS, EXTERNAL):
            raise ConfigError(f"human = {spec!r} is not known{suggest(spec, KINDS)}, or 'module:callable'")
        return spec
    found = import_named(spec, f"human = {spec!r}") if isinstance(spec, str) else spec
    if isclass(found):
        try:
            found = found()
        except TypeError as error:
            raise ConfigError(f"human = {spec!r} cannot be made without arguments: {error}") from None
    if callable(found) and not hasattr(found, "choose"):
        return _Choosing(cast(Callable[[Info, np.random.Generator], int | None], found))
    if not callable(getattr(found, "choose", None)):
        raise ConfigError(f"human = {spec!r} must have choose(info, rng), or be one of {', '.join(KINDS)}")
    return cast(Human, found)


class _Choosing:
    """A function as a human."""

    def __init__(self, function: Callable[[Info, np.random.Generator], int | None]) -> None:
        self.choose = function


def draw_traits(
    kind: str, rng: np.random.Generator, task: WorkshopTask
) -> tuple[Traits, NDArray[np.float64], NDArray[np.bool_]]:
    """Draw a human for an episode.

    Args:
        kind: One of ``KINDS`` or ``EXTERNAL``.
        rng: Of the world.
        task: What is to be done.

    Returns:
        The traits; preferences (n,), standard normal; what the human refuses to do (n,), never what only it can do.
    """
    count = len(task.actions)
    likes, refused = rng.standard_normal(count), rng.random(count) < 0.5
    moods, times = rng.random(6), rng.random(3)
    if kind == "mixture":
        kind = ("free", "helpful", "stubborn", "slow", "absent")[int(moods[0] * 5)]
        pace, spread = 0.85 + 0.4 * moods[1], 0.7 + 0.8 * moods[2]
    else:
        pace, spread = 1.0, 1.0
    nobody = np.zeros(count, np.bool_)
    base = Traits(pace, spread)
    if kind == "helpful":
        return base._replace(nearness=1.0, urgency=3.0, randomness=0.1), likes, nobody
    if kind == "stubborn":
        able = task.arrays.capable
        return base._replace(liking=10.0, randomness=0.1), likes, refused & able[ROBOT] & able[HUMAN]
    if kind == "slow":
        slow = base._replace(pace=pace * (1.4 + 0.4 * moods[3]), rest_chance=0.3, rest_time=8.0)
        return slow, likes, nobody
    if kind == "absent":
        return (
            base._replace(leaves_at=0.6 * times[0] * task.deadline, away_time=(0.2 + 0.4 * times[1]) * task.deadline),
            likes,
            nobody,
        )
    return base, likes, nobody
