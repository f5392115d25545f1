"""What every family's batch has in common: worlds that step together and begin anew in the same step."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from typing import Any, ClassVar, Protocol

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.envs.infos import Info, masked, row_of

Seeds = int | list[int | None] | None
Outcome = tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]


class SavedWorlds(Protocol):
    """Worlds whose state is a set of arrays."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Put back what ``arrays`` gave."""


class BatchedWorlds(VectorEnv[Any, Any, Any], ABC):
    """``num_envs`` environments in worlds of one or more; one that ends begins its next episode in the same step.

    ``infos["final_obs"]`` and ``infos["final_info"]`` then hold the last observation and info of the old episode
    (``AutoresetMode.SAME_STEP``).

    Args:
        worlds: Number of worlds, each with a generator of its own.
        num_envs: Number of environments, a multiple of ``worlds``.
        saved: What holds the worlds' state.
        spaces: Of the observations and actions of a single environment.
        render_mode: None or ``"rgb_array"``.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 5,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(
        self,
        worlds: int,
        num_envs: int,
        saved: SavedWorlds,
        spaces: tuple[gym.Space[Any], gym.Space[Any]],
        render_mode: str | None,
    ) -> None:
        self.num_envs, self._worlds, self._saved, self.render_mode = num_envs, worlds, saved, render_mode
        self.single_observation_space, self.single_action_space = spaces
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._generators: list[np.random.Generator] = []

    @abstractmethod
    def _begin(self, worlds: Iterable[int], seeds: Sequence[int | None] | None) -> None:
        """Reset ``worlds``; ``seeds`` are those of all worlds, None where episodes follow on others."""

    @abstractmethod
    def _advance(self, actions: Any) -> Outcome:
        """Act for one decision period; rewards, terminated and truncated, each (num_envs,)."""

    @abstractmethod
    def _observe(self) -> Any:
        """Fresh observations, leading with (num_envs,): an array, or a dictionary of arrays."""

    @abstractmethod
    def _infos(self) -> Info:
        """What every step tells, as arrays over environments."""

    def _last_infos(self) -> Info:
        """What is told of episodes that have ended."""
        return self._infos()

    @abstractmethod
    def _picture(self, world: int) -> NDArray[np.uint8] | None:
        """A picture of one world."""

    def reset(self, *, seed: Seeds = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begin an episode in every world; a single seed ``s`` gives world ``i`` the seed ``s + i``.

        Raises:
            ConfigError: The number of seeds is not that of the worlds.
        """
        worlds = range(self._worlds)
        seeds = seed if isinstance(seed, list) else [None if seed is None else seed + i for i in worlds]
        if len(seeds) != self._worlds:
            raise ConfigError(f"{len(seeds)} seeds were given for {self._worlds} worlds; one for each is needed")
        before = self._generators
        self._generators = [
            before[world] if before and one is None else seeding.np_random(one)[0] for world, one in enumerate(seeds)
        ]
        self._begin(worlds, seeds)
        return self._observe(), masked(self._infos(), np.ones(self.num_envs, np.bool_))

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Act in every environment for one decision period; raises like the single environment's ``step``."""
        if not self._generators:
            raise ResetNeeded("step() needs running episodes; call reset() first")
        rewards, terminated, truncated = self._advance(actions)
        observations, done = self._observe(), terminated | truncated
        endings: Info = {}
        if done.any():
            endings = self._endings(observations, done)
            over = done.reshape(self._worlds, -1).any(axis=1)
            self._begin(np.flatnonzero(over).tolist(), None)
            _overwrite(observations, self._observe(), done)
        infos = masked(self._infos(), np.ones(self.num_envs, np.bool_)) | endings
        return observations, rewards, terminated, truncated, infos

    def _endings(self, observations: Any, done: NDArray[np.bool_]) -> Info:
        final = np.full(self.num_envs, None, dtype=object)
        for one in np.flatnonzero(done).tolist():
            final[one] = row_of(observations, one, copy=True)
        last = masked(self._last_infos(), done)
        return {"final_obs": final, "_final_obs": done.copy(), "final_info": last, "_final_info": done.copy()}

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """One picture a world; None without ``render_mode``."""
        if self.render_mode is None:
            return None
        pictures = [self._picture(world) for world in range(self._worlds)]
        return tuple(picture for picture in pictures if picture is not None)

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit."""
        arrays = {name: array.copy() for name, array in self._saved.arrays().items()}
        return arrays | {"generators": np.stack([generator_words(rng) for rng in self._generators])}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of a batch with the same keywords and size was called."""
        self._generators = [generator_from_words(words) for words in state["generators"]]
        self._saved.load_arrays(state)


def whole_number_of_worlds(num_envs: Any) -> int:
    """Check the number of worlds.

    Raises:
        ConfigError: It is not a whole number of at least 1.
    """
    if not isinstance(num_envs, int) or num_envs < 1:
        raise ConfigError(f"num_envs = {num_envs!r} must be a whole number of at least 1")
    return num_envs


def _overwrite(observations: Any, fresh: Any, rows: NDArray[np.bool_]) -> None:
    if isinstance(observations, dict):
        for name, array in observations.items():
            array[rows] = fresh[name][rows]
    else:
        observations[rows] = fresh[rows]
