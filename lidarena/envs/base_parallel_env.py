"""What the families for PettingZoo have in common: one world in which several agents act."""

from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import ParallelEnv

from lidarena.base.errors import ActionError, ConfigError, suggest
from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.base.keyword_checks import check_names, check_step_limit
from lidarena.envs.infos import Info
from lidarena.envs.seeds import checked_seed
from lidarena.envs.window import may_draw

Observations = dict[str, NDArray[np.float32]]
Outcomes = tuple[Observations, dict[str, float], dict[str, bool], dict[str, bool], dict[str, Info]]
"""Observations, rewards, terminations, truncations and infos of a step, by agent."""


def check_cycles(what: str, max_cycles: int | None, keywords: Mapping[str, Any], known: list[str]) -> None:
    """Refuse keywords of an environment for PettingZoo that it does not have, and a limit that is none.

    Raises:
        ConfigError: Which, with the nearest right one.
    """
    if "max_episode_steps" in keywords:
        raise ConfigError("keyword 'max_episode_steps' is called 'max_cycles' here, as everywhere in PettingZoo")
    check_names(what, keywords, ["max_cycles", *known])
    if max_cycles is not None:
        check_step_limit(max_cycles, "max_cycles")


class ParallelWorld(ParallelEnv[str, NDArray[np.float32], Any]):  # type: ignore[misc]  # PettingZoo is untyped
    """One world of several agents, by their names; episodes end when they end.

    A family says what the agents observe (``_observations``) and are told (``_infos``), what a step does (``step``),
    and which are left of a restored world (``_remaining``).

    Args:
        episodes: A batch of one world.
        names: Of the agents.
        observation: Space of each.
        action: Space of each.

    Attributes:
        family: Name of the family, under which it is registered.
        episodes: That batch.
        max_cycles: Steps after which an episode is truncated; -1 never.
    """

    family: str

    def __init__(self, episodes: Any, names: list[str], observation: gym.Space[Any], action: gym.Space[Any]) -> None:
        self.episodes: Any = episodes
        self.max_cycles, self.render_mode = episodes.options.max_episode_steps, episodes.options.render_mode
        self.possible_agents = names
        self.agents: list[str] = []
        self._numbers = {name: number for number, name in enumerate(names)}
        self._observation_spaces = {name: _copy(observation) for name in names}
        self._action_spaces = {name: _copy(action) for name in names}
        self._generator: np.random.Generator | None = None

    def observation_space(self, agent: str) -> gym.Space[Any]:
        """Of an agent; always the same object."""
        return self._observation_spaces[self._known(agent)]

    def action_space(self, agent: str) -> gym.Space[Any]:
        """Of an agent; always the same object."""
        return self._action_spaces[self._known(agent)]

    def _known(self, agent: str) -> str:
        if agent not in self._numbers:
            raise ConfigError(f"there is no agent {agent!r}{suggest(str(agent), self.possible_agents)}")
        return agent

    @property
    def options(self) -> Any:
        """The checked keywords."""
        return self.episodes.options

    def reset(
        self, seed: int | np.integer[Any] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Info]]:
        """Begin an episode.

        Args:
            seed: None goes on with the generator that there is.
            options: There are none; whatever stands here is passed over, as PettingZoo's own tests ask for.

        Raises:
            ConfigError: A seed that is no whole number of at least 0.
        """
        number = checked_seed(seed)
        if number is not None or self._generator is None:
            self._generator = seeding.np_random(number)[0]
        self.episodes.reset([0], [self._generator])
        self.agents = list(self.possible_agents)
        return self._observations(self.agents), self._infos(self.agents)

    def _observations(self, agents: list[str]) -> Observations:
        raise NotImplementedError

    def _infos(self, agents: list[str]) -> dict[str, Info]:
        raise NotImplementedError

    def _remaining(self) -> list[str]:
        """Agents that still act, of a world that was restored."""
        raise NotImplementedError

    def _check_agents(self, actions: Any) -> None:
        """Refuse actions that are not those of the agents that act.

        Raises:
            ActionError: One that is missing, or of an unknown or finished agent.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        if not self.agents:
            raise ResetNeeded("step() needs a running episode; call reset() first, and again when no agents are left")
        if not isinstance(actions, Mapping):
            raise ActionError(f"actions of type {type(actions).__name__} were given; a dictionary by agent is needed")
        for name in actions:
            if name not in self._numbers:
                raise ActionError(f"there is no agent {name!r}{suggest(str(name), self.agents)}")
            if name not in self.agents:
                raise ActionError(f"agent {name!r} is finished{self._how_finished(name)}")
        for name in self.agents:
            if name not in actions:
                raise ActionError(f"the action of agent {name!r} is missing; one is needed for every agent in agents")

    def _how_finished(self, name: str) -> str:
        """What a message says of an agent that acts no more."""
        return ""

    def render(self) -> NDArray[np.uint8] | None:
        """Picture (height, width, 3); None without ``render_mode``, or where a window shows it (``"human"``).

        Raises:
            ResetNeeded: The environment was not reset.
        """
        return self._picture() if may_draw(self.render_mode, self._generator is not None) else None

    def _picture(self) -> NDArray[np.uint8] | None:
        picture: NDArray[np.uint8] | None = self.episodes.picture(0)
        return picture

    def close(self) -> None:
        """Close the window, if there is one."""
        self.episodes.close()

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit.

        Raises:
            ResetNeeded: The environment was not reset.
        """
        if self._generator is None:
            raise ResetNeeded("get_state() needs an episode; call reset() first")
        arrays = {name: array.copy() for name, array in self.episodes.arrays().items()}
        return arrays | {"generators": generator_words(self._generator)[None]}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of an environment with the same keywords was called."""
        self._generator = generator_from_words(state["generators"][0])
        self.episodes.load_arrays(state)
        self.agents = self._remaining()


def _copy(space: gym.Space[Any]) -> gym.Space[Any]:
    """An equal space with a generator of its own."""
    if isinstance(space, gym.spaces.Discrete):
        return gym.spaces.Discrete(int(space.n))
    assert isinstance(space, gym.spaces.Box)
    return gym.spaces.Box(space.low, space.high, dtype=space.dtype.type)
