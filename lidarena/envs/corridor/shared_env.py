"""The multi-robot world as a batch of single robots that share one policy: what parameter sharing learns from."""

from typing import Any, ClassVar, Unpack

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.corridor.drawn_options import DrawnKeywords, DrawnOptions
from lidarena.envs.corridor.shared_episodes import SharedEpisodes


class SharedCorridor(BatchedWorlds):
    """``num_envs`` robots in teams of ``robots``, each an environment of its own to whoever trains.

    Robot ``r`` of team ``w`` is environment ``w · robots + r``; team ``w`` is the world of ``corridor_v0`` with seed
    ``seed + w``. A team's robots begin and end their episodes together: one that has arrived or collided sees zeros and
    earns nothing until the last one is finished or time is up. Where that happens is a termination for those that are
    finished and a truncation for those cut off on their way; the next episode begins in the same step
    (``AutoresetMode.SAME_STEP``, by default).

    Spaces, rewards and keywords are those of ``corridor_v0``; ``max_episode_steps`` for its ``max_cycles``. With
    ``plans`` in place of ``map`` every team is on plans of its own, drawn afresh.

    Args:
        num_envs: Number of robots, a multiple of ``robots``.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: See ``DrawnOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = BatchedWorlds.metadata | {"render_modes": []}  # type: ignore[misc]
    family = "corridor"

    @takes_keywords_of(DrawnOptions)
    def __init__(self, num_envs: int = 4, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[DrawnKeywords]) -> None:
        """Make the worlds.

        Raises:
            LidarenaError: As ``CorridorEnv``; or the number of robots does not divide into teams.
        """
        options, envs = DrawnOptions.checked(keywords), whole_number_of_worlds(num_envs)
        if envs % options.robots:
            raise ConfigError(f"num_envs = {num_envs!r} must be a multiple of the {options.robots} robots of a team")
        super().__init__(SharedEpisodes(envs // options.robots, options), autoreset_mode)
