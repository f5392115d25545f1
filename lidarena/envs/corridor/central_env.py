"""The multi-robot world for one controller of the whole team, single and in batches."""

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.base_env import SingleWorld
from lidarena.envs.base_vector_env import BatchedWorlds, Outcome, whole_number_of_worlds
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.envs.corridor.window import draw_world
from lidarena.envs.infos import Info, of_world
from lidarena.world.floorplan import Floorplan


def team_spaces(episodes: CorridorEpisodes) -> tuple[gym.spaces.Box, gym.Space[Any]]:
    """Observation and action space of a whole team: those of a robot, one row a robot."""
    robots, one = episodes.options.robots, episodes.observation_space
    observations = gym.spaces.Box(-1.0, 1.0, (robots, *one.shape), np.float32)
    if isinstance(episodes.action_space, gym.spaces.Discrete):
        return observations, gym.spaces.MultiDiscrete([int(episodes.action_space.n)] * robots)
    return observations, gym.spaces.Box(-1.0, 1.0, (robots, 2), np.float32)


def team_infos(episodes: CorridorEpisodes) -> Info:
    """What every step tells, as arrays over worlds."""
    robots = episodes.robot_infos()
    own: Info = {
        "poses": robots["pose"],
        "goals": robots["goal"],
        "remaining": robots["remaining"],
        "arrived": robots["arrived"],
        "finished": episodes.finished.copy(),
        "collided": robots["collision"],
        "collision": robots["collision"].any(axis=1),
        "path_lengths": robots["path_length"],
        "reward_terms": {name: term.sum(axis=1) for name, term in robots["reward_terms"].items()},
        "measures": episodes.measures(),
    }
    return own | episodes.world_infos()


class CorridorCentralEnv(SingleWorld):
    """Bring a team of robots to their goals, without touching a wall or each other.

    ## Description

    The world of ``lidarena.envs.corridor_v0`` (Bennewitz & Burgard 2000) for one controller that sees what all robots
    see and drives them all. Robots, sensors, noise and floor plans are described there.

    ## Action space

    ``action="continuous"``: ``Box(-1, 1, (robots, 2), float32)``; ``action="discrete"``: ``MultiDiscrete([7] *
    robots)``. A row is one robot's action in ``corridor_v0``; those of finished robots are not looked at.

    ## Observation space

    ``Box(-1, 1, (robots, beams + 8), float32)``: a row is one robot's observation in ``corridor_v0``, zeros once it is
    finished.

    ## Rewards

    The sum of the robots' rewards; ``info["reward_terms"]`` holds the terms by name, summed over the robots.

    ## Starting state

    As in ``corridor_v0``.

    ## Episode end

    - Termination: every robot is finished: it has arrived, or (``collision_ends``) touched something.
    - Truncation: after ``max_episode_steps`` (1000) steps.

    ## Info

    By robot: ``poses`` (robots, 3) as localisation gives them, ``goals`` (robots, 2), ``remaining`` [m], ``arrived``,
    ``finished``, ``collided``, ``path_lengths`` [m]. Of the team: ``collision``, ``time`` [s], ``reward_terms``,
    ``map`` (rows, columns) int8 with 0 free, 100 occupied, ``resolution`` [m], ``origin`` (2,), the robots' ``radius``
    [m]; ``measures``, how the team has done: share ``arrival``, ``all_arrived``, share ``collided``, ``makespan``
    and ``mean_time`` [s]. With ``expose_truth=True`` also ``truth``: ``poses`` and ``path_length``.

    ## Arguments

    See ``CorridorOptions``.

    ## References

    Bennewitz & Burgard, A probabilistic method for planning collision-free trajectories of multiple mobile robots,
    2000.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "human"], "render_fps": 5}  # noqa: RUF012
    family = "corridor"

    def __init__(self, **keywords: Any) -> None:
        """Make one world; the keywords are those of ``CorridorOptions``.

        Raises:
            LidarenaError: A keyword, floor plan, start or goal that cannot be had.
        """
        options = CorridorOptions.checked(keywords)
        self.episodes = CorridorEpisodes(1, options)
        super().__init__(*team_spaces(self.episodes), options.render_mode)

    @property
    def floorplan(self) -> Floorplan:
        """The floor plan, for pictures."""
        return self.episodes.core.plan

    @property
    def options(self) -> CorridorOptions:
        """The keywords."""
        return self.episodes.options

    def _begin(self, seed: int | None) -> None:
        self.episodes.reset([0], [self.np_random])

    def _advance(self, action: Any) -> tuple[float, bool, bool]:
        rewards, _, _ = self.episodes.step([action])
        terminated, over = bool(self.episodes.finished.all()), bool(self.episodes.over[0])
        return float(rewards.sum(axis=1)[0]), terminated, over and not terminated

    def _observe(self) -> Any:
        return self.episodes.observe()[0]

    def _info(self) -> Info:
        info = of_world(team_infos(self.episodes), 0)
        info["map"] = info["map"].copy()
        return info

    def show(self, sketch: TeamSketch) -> None:
        """Let a planner's sketch be seen in the picture until the next one."""
        self.episodes.sketches[0] = sketch

    def _picture(self) -> NDArray[np.uint8] | None:
        return draw_world(self.episodes, 0)


class BatchedCorridor(BatchedWorlds):
    """``num_envs`` worlds of a team in one step; world ``i`` is ``CorridorCentralEnv`` with seed ``seed + i``.

    See ``BatchedWorlds``; spaces, rewards and keywords: ``CorridorCentralEnv``.

    Args:
        num_envs: Number of worlds.
        **keywords: See ``CorridorOptions``.
    """

    family = "corridor"

    def __init__(self, num_envs: int = 1, **keywords: Any) -> None:
        """Make the worlds; raises like ``CorridorCentralEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        options = CorridorOptions.checked(keywords)
        self.episodes = CorridorEpisodes(worlds, options)
        super().__init__(worlds, worlds, self.episodes, team_spaces(self.episodes), options.render_mode)

    def _begin(self, worlds: Iterable[int], seeds: Sequence[int | None] | None) -> None:
        self.episodes.reset(worlds, self._generators)

    def _advance(self, actions: Any) -> Outcome:
        rewards, _, _ = self.episodes.step(actions)
        terminated = np.asarray(self.episodes.finished.all(axis=1))
        return rewards.sum(axis=1), terminated, self.episodes.over & ~terminated

    def _observe(self) -> Any:
        return self.episodes.observe()

    def _infos(self) -> Info:
        return team_infos(self.episodes)

    def _picture(self, world: int) -> NDArray[np.uint8] | None:
        return draw_world(self.episodes, world)
