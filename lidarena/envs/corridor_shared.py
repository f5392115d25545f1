"""The multi-robot world as a batch of single robots that share one policy: what parameter sharing learns from."""

from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.envs.corridor_central import seeded_generators
from lidarena.envs.corridor_episodes import CorridorEpisodes, Info
from lidarena.envs.corridor_options import CorridorOptions
from lidarena.envs.exploration import masked
from lidarena.envs.generator_state import generator_from_words, generator_words
from lidarena.world.refusals import ConfigError

SHARED_ID = "lidarena/CorridorShared-v0"


class SharedCorridor(VectorEnv[NDArray[np.float32], Any, Any]):
    """``num_envs`` robots in teams of ``robots``, each an environment of its own to whoever trains.

    Robot ``r`` of team ``w`` is environment ``w · robots + r``; team ``w`` is the world of ``corridor_v0`` with seed
    ``seed + w``. A team's robots begin and end their episodes together: one that has arrived or collided sees zeros and
    earns nothing until the last one is finished or time is up. Where that happens is a termination for those that are
    finished and a truncation for those cut off on their way; the next episode begins in the same step
    (``AutoresetMode.SAME_STEP``).

    Spaces, rewards and keywords are those of ``corridor_v0``; ``max_episode_steps`` for its ``max_cycles``.

    Args:
        num_envs: Number of robots, a multiple of ``robots``.
        **keywords: See ``CorridorOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": [],
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }
    family = "corridor"

    def __init__(self, num_envs: int = 4, **keywords: Any) -> None:
        """Make the worlds.

        Raises:
            Refusal: As ``CorridorEnv``; or the number of robots does not divide into teams.
        """
        options = CorridorOptions.checked(keywords)
        if not isinstance(num_envs, int) or num_envs < 1 or num_envs % options.robots:
            raise ConfigError(f"num_envs = {num_envs!r} must be a multiple of the {options.robots} robots of a team")
        self.num_envs, self._teams = num_envs, num_envs // options.robots
        self.render_mode = None
        self.episodes = CorridorEpisodes(self._teams, options)
        self.single_observation_space = self.episodes.observation_space
        self.single_action_space = self.episodes.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._generators: list[np.random.Generator] = []

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], Info]:
        """Begin an episode in every team; a single seed ``s`` gives team ``w`` the seed ``s + w``."""
        self._generators = seeded_generators(self._generators, seed, self._teams)
        self.episodes.reset(range(self._teams), self._generators)
        return self._flat(self.episodes.observe()), {}

    def step(
        self, actions: Any
    ) -> tuple[NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Act with every robot for one decision period.

        Raises:
            ActionError: See ``corridor_v0``.
            ResetNeeded: The environment was not reset.
        """
        if not self._generators:
            raise ResetNeeded("step() needs running episodes; call reset() first")
        array = np.asarray(actions)
        if array.shape[:1] == (self.num_envs,):
            actions = array.reshape(self._teams, self.episodes.options.robots, *array.shape[1:])
        rewards, _, _ = self.episodes.step(actions)
        over = self.episodes.over
        terminated = self.episodes.finished & over[:, None]
        truncated = ~self.episodes.finished & over[:, None]
        observations, infos = self.episodes.observe(), Info()
        if over.any():
            infos = self._endings(observations, over)
            self.episodes.reset(np.flatnonzero(over).tolist(), self._generators)
            observations[over] = self.episodes.observe()[over]
        return self._flat(observations), rewards.ravel(), terminated.ravel(), truncated.ravel(), infos

    def _endings(self, observations: NDArray[np.float32], over: NDArray[np.bool_]) -> Info:
        ended = np.repeat(over, self.episodes.options.robots)
        final = np.full(self.num_envs, None, dtype=object)
        rows = self._flat(observations)
        for robot in np.flatnonzero(ended):
            final[robot] = rows[robot].copy()
        robots = self.episodes.robot_infos()
        last = {"collision": robots["collision"].ravel(), "arrived": robots["arrived"].ravel()}
        return {"final_obs": final, "_final_obs": ended, "final_info": masked(last, ended), "_final_info": ended}

    def _flat(self, observations: NDArray[np.float32]) -> NDArray[np.float32]:
        return observations.reshape(self.num_envs, -1)

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit."""
        arrays = {name: array.copy() for name, array in self.episodes.arrays().items()}
        return arrays | {"generators": np.stack([generator_words(rng) for rng in self._generators])}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of a batch with the same keywords and size was called."""
        self._generators = [generator_from_words(words) for words in state["generators"]]
        self.episodes.load_arrays(state)


def register_shared() -> None:
    """Register the id; doing so again changes nothing."""
    if SHARED_ID not in gym.registry:
        gym.register(id=SHARED_ID, vector_entry_point="lidarena.envs.corridor_shared:SharedCorridor")
