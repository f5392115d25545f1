"""What a family of environments implements: its episodes, in a batch of worlds. Every interface wraps this."""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.infos import Info

Outcome = tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]
"""Rewards, terminated and truncated of a step, each (environments,)."""


Generators = Sequence[np.random.Generator]
"""Of all worlds; each draws from its own and from nothing else."""
Seeds = Sequence[int | None] | None
"""That all worlds were reset with; None where episodes follow on others."""


class Episodes(Protocol):
    """Episodes in ``worlds`` worlds that step together; whoever owns them decides when a world is reset.

    World ``i`` depends on nothing but its own generator and actions: neither on the other worlds nor on their number.
    Mostly a world is one environment; where robots share a policy each robot is one, and ``envs`` is a multiple of
    ``worlds``. ``SingleWorld`` wraps one world as a ``gymnasium.Env``, ``BatchedWorlds`` many as a ``VectorEnv``.

    Attributes:
        options: The checked keywords.
        worlds: Number of worlds.
        envs: Number of environments in them.
        single_observation_space: Of one environment.
        single_action_space: Of one environment.
    """

    options: Any
    worlds: int
    envs: int
    single_observation_space: gym.Space[Any]
    single_action_space: gym.Space[Any]

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``.

        Args:
            worlds: Which ones.
            generators: Of all worlds; each draws from its own and from nothing else.
            seeds: That all worlds were reset with; None where episodes follow on others.
        """

    def step(self, actions: Any) -> Outcome:
        """Act in every environment for one decision period; actions lead with (environments,).

        Raises:
            ActionError: An action that is NaN, out of range, or of the wrong shape or type.
        """

    def observe(self) -> Any:
        """Fresh observations, leading with (environments,): an array, or a dictionary of arrays."""

    def infos(self) -> Info:
        """What every step tells, as arrays over environments."""

    def last_infos(self) -> Info:
        """What is told of episodes that have ended, as arrays over environments that later steps leave alone."""

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """A picture (height, width, 3) of one world; None where nothing is drawn, or a window shows it."""

    def close(self) -> None:
        """Give back what the worlds hold, such as a window."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
