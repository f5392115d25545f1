"""The keywords of ``lidarena/GoalChoice-v0``."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import Limits, check_names, check_range, options_of
from lidarena.envs.exploration.goal_choice.rewards import REWARDS
from lidarena.envs.exploration.options import ExplorationKeywords, ExplorationOptions
from lidarena.envs.rewards import RewardSpec, choose_reward

_NOT_TAKEN = ("action", "observation", "reward", "stop_at", "max_episode_steps", "eta", "certain_enough", "patience")
LEAST_FRONTIERS = (0.05, 10.0)
"""The smallest frontier that is a candidate may be so long, from and to [m]."""
_LIMITS = Limits(ranges={"choice_period": (0.2, 60.0), "least_frontier": LEAST_FRONTIERS},
                 whole={"candidates": (2, 256), "places": (0, 100)})  # fmt: skip


class GoalChoiceKeywords(ExplorationKeywords, total=False):
    """The keywords of ``GoalChoiceOptions`` with their types, for editors and type checkers."""

    preference: float | str
    candidates: int
    places: int
    least_frontier: float
    choice_period: float
    time_limit: float | None


@dataclass(frozen=True)
class GoalChoiceOptions:
    """Keywords of ``lidarena/GoalChoice-v0``; beside these, those of ``ExplorationOptions`` that make the world.

    Attributes:
        preference: How much certainty is worth, from 0, the shortest way, to 1; ``"random"`` draws it anew for every
            episode, evenly.
        candidates: Most candidates that are told of.
        places: Known places among them, at most.
        least_frontier: Smallest frontier that is a candidate [m].
        choice_period: A choice may be changed so often [s].
        time_limit: Truncates [s]; None never.
        reward: ``"preference"``, or weights of the terms of ``GoalChoiceTerms``, or a function, as everywhere.
        max_episode_steps: Choices after which an episode is truncated; -1 never, None the usual 2000.
        world: The rest.
    """

    preference: float | str = "random"
    candidates: int = 24
    places: int = 6
    least_frontier: float = 0.4
    choice_period: float = 2.0
    time_limit: float | None = 2000.0
    reward: RewardSpec = "preference"
    max_episode_steps: int = 2000
    world: ExplorationOptions = field(default_factory=ExplorationOptions)

    @classmethod
    def checked(cls, keywords: Mapping[str, Any]) -> "GoalChoiceOptions":
        """Check keywords and fill in the defaults.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type.
            MapError: A start that is neither a pose, ``"random"`` nor None.
        """
        own = {one.name for one in fields(cls)} - {"world"}
        worlds = [one.name for one in fields(ExplorationOptions) if one.name not in _NOT_TAKEN]
        check_names("GoalChoice-v0", keywords, [*sorted(own), *worlds, "particles"])
        given = {name: value for name, value in keywords.items() if name in own}
        rest = {name: value for name, value in keywords.items() if name not in own}
        world = ExplorationOptions.checked({"max_episode_steps": -1, "stop_at": None, **rest})
        options = replace(options_of(cls, "GoalChoice-v0", given, _LIMITS), world=world)
        options._check()
        return options

    def _check(self) -> None:
        if self.time_limit is not None:
            check_range("time_limit", self.time_limit, 1.0, 1e6)
        if self.preference != "random":
            if isinstance(self.preference, str):
                raise ConfigError(f"preference = {self.preference!r} must be a number from 0 to 1, or 'random'")
            check_range("preference", self.preference, 0.0, 1.0)
        choose_reward(self.reward, REWARDS)

    @property
    def render_mode(self) -> str | None:
        """None or ``"rgb_array"``."""
        return self.world.render_mode
