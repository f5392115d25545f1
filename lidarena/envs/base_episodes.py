"""What the families in which one agent acts in a world have in common: counting, rewards, observers, endings."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.compilation import announced_compilation
from lidarena.envs.episodes import Generators, Outcome, Seeds
from lidarena.envs.infos import Info, of_world
from lidarena.envs.observers import OneByOne, choose_observer
from lidarena.envs.rewards import ChosenReward, StepRewards


class OneAgentEpisodes(ABC):
    """Episodes in ``worlds`` worlds with one agent each; see ``lidarena.envs.episodes.Episodes``.

    A family says how a world begins (``_begin``), what it tells (``_facts``), what it shows (``_look``) and what a step
    does (``step``), which ends in ``_note_step``.

    Args:
        worlds: How many.
        options: The checked keywords; those that all families share are read from it.
        reward: What a step is worth.
        action_space: Of one world.
    """

    def __init__(self, worlds: int, options: Any, reward: ChosenReward, action_space: gym.Space[Any]) -> None:
        self.options: Any = options
        self.worlds = self.envs = worlds
        self.single_action_space = action_space
        self._rewards = StepRewards(reward, (worlds,), self._snapshot)
        self._steps = np.zeros(worlds, np.int64)
        self._compiled = False

    def _choose_observation(self, names: Sequence[str], space: Callable[[str], gym.Space[Any]]) -> None:
        """Take the space of the family's own observation of a name, or that of an observer of one's own."""
        chosen = choose_observer(self.options.observation, names)
        own = None if isinstance(chosen, str) else chosen
        self._own = None if own is None else OneByOne(own, (self.worlds,))
        self.single_observation_space: gym.Space[Any] = space(str(chosen)) if own is None else own.space

    @abstractmethod
    def _begin(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        """Begin a new episode in one world; ``seed`` is what it was reset with, if anything."""

    def _complete_reset(self, worlds: list[int]) -> None:  # noqa: B027 - most families have nothing to add
        """Do what is left after the worlds that were reset have begun."""

    @abstractmethod
    def _facts(self) -> Info:
        """What every step tells, as arrays over worlds, but for what it was worth."""

    @abstractmethod
    def _look(self) -> Any:
        """Fresh observations of all worlds, of the family's own kind."""

    @abstractmethod
    def step(self, actions: Any) -> Outcome:
        """Act in every world; returns rewards, terminated and truncated, each (worlds,).

        Raises:
            ActionError: An action that is NaN, out of range, or of the wrong shape or type.
        """

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``.

        Args:
            worlds: Which ones.
            generators: Of all worlds; each draws from its own.
            seeds: That all worlds were reset with, if they were.
        """
        begun = list(worlds)
        with self._compilation():
            for world in begun:
                self._begin(world, generators[world], seeds[world] if seeds is not None else None)
                self._steps[world] = 0
                self._rewards.begin(world)
            self._complete_reset(begun)
        self._rewards.look(begun)

    def _compilation(self) -> AbstractContextManager[None]:
        """Announces that kernels are compiled, as long as no step was made."""
        return nullcontext() if self._compiled else announced_compilation()

    def _note_step(self) -> None:
        """Count a step that was made in every world."""
        self._compiled = True
        self._steps += 1

    def _out_of_steps(self) -> NDArray[np.bool_]:
        """Which worlds have made ``max_episode_steps``."""
        most = self.options.max_episode_steps
        return np.zeros(self.worlds, np.bool_) if most == -1 else self._steps >= most

    def observe(self) -> Any:
        """Fresh observations, leading with (worlds,), or what an observer of one's own makes of the worlds."""
        return self._look() if self._own is None else self._own.observe(self._snapshot())

    def infos(self) -> Info:
        """What every step tells, as arrays over worlds."""
        return self._rewards.tell(self._facts())

    def _snapshot(self) -> Callable[[tuple[int, ...]], Info]:
        """What every step tells, as it is now; one world's part by its number."""
        facts = self._facts()
        return lambda index: of_world(facts, index[0])

    def last_infos(self) -> Info:
        """The same as ``infos``, whose arrays are copies."""
        return self.infos()

    def close(self) -> None:  # noqa: B027 - nor to give back
        """Nothing is held."""
