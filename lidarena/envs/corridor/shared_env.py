"""The multi-robot world as a batch of single robots that share one policy: what parameter sharing learns from."""

from collections.abc import Iterable
from typing import Any, ClassVar, Unpack

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.options import CorridorKeywords, CorridorOptions
from lidarena.envs.episodes import Generators, Outcome, Seeds
from lidarena.envs.infos import Info


class SharedEpisodes:
    """Episodes of teams, each robot one environment; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: Number of teams.
        options: Checked keywords.

    Attributes:
        teams: The same episodes team by team.
    """

    def __init__(self, worlds: int, options: CorridorOptions) -> None:
        self.options, self.worlds, self.envs = options, worlds, worlds * options.robots
        self.teams = CorridorEpisodes(worlds, options)
        self.single_observation_space: gym.Space[Any] = self.teams.observation_space
        self.single_action_space: gym.Space[Any] = self.teams.action_space

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``."""
        self.teams.reset(worlds, generators)

    def step(self, actions: Any) -> Outcome:
        """Act in every world; a team's robots end together, terminated if finished and else truncated."""
        array = np.asarray(actions)
        if array.shape[:1] == (self.envs,):
            actions = array.reshape(self.teams.finished.shape + array.shape[1:])
        rewards, _, _ = self.teams.step(actions)
        over, finished = self.teams.over[:, None], self.teams.finished
        return rewards.ravel(), (finished & over).ravel(), (~finished & over).ravel()

    def observe(self) -> NDArray[np.float32]:
        """Fresh observations, a row a robot, zeros of those that are finished."""
        return self.teams.observe().reshape(self.envs, -1)

    def infos(self) -> Info:
        """Nothing: a learner does not look at them, and they take time."""
        return Info()

    def last_infos(self) -> Info:
        """How the episodes ended."""
        robots = self.teams.robot_infos()
        return Info({name: robots[name].ravel() for name in ("collision", "success")})

    def picture(self, world: int) -> None:
        """Nothing is drawn."""

    def close(self) -> None:
        """Nothing is held."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        return self.teams.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self.teams.load_arrays(saved)


class SharedCorridor(BatchedWorlds):
    """``num_envs`` robots in teams of ``robots``, each an environment of its own to whoever trains.

    Robot ``r`` of team ``w`` is environment ``w · robots + r``; team ``w`` is the world of ``corridor_v0`` with seed
    ``seed + w``. A team's robots begin and end their episodes together: one that has arrived or collided sees zeros and
    earns nothing until the last one is finished or time is up. Where that happens is a termination for those that are
    finished and a truncation for those cut off on their way; the next episode begins in the same step
    (``AutoresetMode.SAME_STEP``, by default).

    Spaces, rewards and keywords are those of ``corridor_v0``; ``max_episode_steps`` for its ``max_cycles``.

    Args:
        num_envs: Number of robots, a multiple of ``robots``.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: See ``CorridorOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = BatchedWorlds.metadata | {"render_modes": []}  # type: ignore[misc]
    family = "corridor"

    @takes_keywords_of(CorridorOptions)
    def __init__(
        self, num_envs: int = 4, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[CorridorKeywords]
    ) -> None:
        """Make the worlds.

        Raises:
            LidarenaError: As ``CorridorEnv``; or the number of robots does not divide into teams.
        """
        options, envs = CorridorOptions.checked(keywords), whole_number_of_worlds(num_envs)
        if envs % options.robots:
            raise ConfigError(f"num_envs = {num_envs!r} must be a multiple of the {options.robots} robots of a team")
        super().__init__(SharedEpisodes(envs // options.robots, options), autoreset_mode)
