"""The multi-robot world as a batch of single robots that share one policy: what parameter sharing learns from."""

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.base_vector_env import BatchedWorlds, Outcome
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.envs.infos import Info

SHARED_ID = "lidarena/CorridorShared-v0"


class SharedCorridor(BatchedWorlds):
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

    metadata: ClassVar[dict[str, Any]] = BatchedWorlds.metadata | {"render_modes": []}  # type: ignore[misc]
    family = "corridor"

    def __init__(self, num_envs: int = 4, **keywords: Any) -> None:
        """Make the worlds.

        Raises:
            LidarenaError: As ``CorridorEnv``; or the number of robots does not divide into teams.
        """
        options = CorridorOptions.checked(keywords)
        if not isinstance(num_envs, int) or num_envs < 1 or num_envs % options.robots:
            raise ConfigError(f"num_envs = {num_envs!r} must be a multiple of the {options.robots} robots of a team")
        teams = num_envs // options.robots
        self.episodes = CorridorEpisodes(teams, options)
        spaces = self.episodes.observation_space, self.episodes.action_space
        super().__init__(teams, num_envs, self.episodes, spaces, None)

    def _begin(self, worlds: Iterable[int], seeds: Sequence[int | None] | None) -> None:
        self.episodes.reset(worlds, self._generators)

    def _advance(self, actions: Any) -> Outcome:
        array = np.asarray(actions)
        if array.shape[:1] == (self.num_envs,):
            actions = array.reshape(self.episodes.finished.shape + array.shape[1:])
        rewards, _, _ = self.episodes.step(actions)
        over, finished = self.episodes.over[:, None], self.episodes.finished
        return rewards.ravel(), (finished & over).ravel(), (~finished & over).ravel()

    def _observe(self) -> NDArray[np.float32]:
        return self.episodes.observe().reshape(self.num_envs, -1)

    def _infos(self) -> Info:
        return {}

    def _last_infos(self) -> Info:
        robots = self.episodes.robot_infos()
        return {"collision": robots["collision"].ravel(), "arrived": robots["arrived"].ravel()}

    def _picture(self, world: int) -> None:
        return None


def register_shared() -> None:
    """Register the id; doing so again changes nothing."""
    if SHARED_ID not in gym.registry:
        gym.register(id=SHARED_ID, vector_entry_point="lidarena.envs.corridor.shared_env:SharedCorridor")
