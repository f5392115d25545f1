"""The multi-robot world for one controller of the whole team, single and in batches."""

from collections.abc import Iterable
from typing import Any, Unpack

import gymnasium as gym
import numpy as np
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_env import SingleWorld, entry_point
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.corridor.drawing import draw_world
from lidarena.envs.corridor.drawn_options import DrawnKeywords, DrawnOptions
from lidarena.envs.corridor.drawn_teams import DrawnTeam
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.envs.episodes import Generators, Outcome, Seeds
from lidarena.envs.infos import Info
from lidarena.world.floorplan import Floorplan


class CentralEpisodes:
    """Episodes of teams, each team one environment; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: Number of teams.
        options: Checked keywords.

    Raises:
        ConfigError: A batch whose teams meet plans of their own: maps of different shapes make no array.
    """

    def __init__(self, worlds: int, options: DrawnOptions) -> None:
        self.options, self.worlds, self.envs = options, worlds, worlds
        if options.plans is not None and worlds > 1:
            raise ConfigError(
                "plans is for a single team or for 'lidarena/CorridorShared-v0', since maps of different shapes are "
                f"no batch of {worlds} infos"
            )
        self._drawn = None if options.plans is None else DrawnTeam(options)
        self._together = CorridorEpisodes(worlds, options) if self._drawn is None else self._drawn.teams
        robots, one = options.robots, self.teams.observation_space
        self.single_observation_space: gym.Space[Any] = batch_space(one, robots)
        self.single_action_space: gym.Space[Any] = gym.spaces.Box(-1.0, 1.0, (robots, 2), np.float32)
        if isinstance(self.teams.action_space, gym.spaces.Discrete):
            self.single_action_space = gym.spaces.MultiDiscrete([int(self.teams.action_space.n)] * robots)

    @property
    def teams(self) -> CorridorEpisodes:
        """The same episodes robot by robot."""
        return self._together if self._drawn is None else self._drawn.teams

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``."""
        if self._drawn is None:
            self.teams.reset(worlds, generators)
        elif list(worlds):
            self._drawn.begin(generators[0], seeds is not None and seeds[0] is not None)

    def step(self, actions: Any) -> Outcome:
        """Act in every world; the rewards of its robots add up."""
        rewards, _, _ = self.teams.step(actions)
        terminated = np.asarray(self.teams.finished.all(axis=1))
        return rewards.sum(axis=1), terminated, self.teams.over & ~terminated

    def observe(self) -> NDArray[np.float32]:
        """Fresh observations (worlds, robots, …), zeros of robots that are finished."""
        return self.teams.observe()

    def infos(self) -> Info:
        """What every step tells, as arrays over worlds."""
        robots = self.teams.robot_infos()
        own = Info(
            {
                "pose": robots["pose"],
                "goal": robots["goal"],
                "remaining": robots["remaining"],
                "success": robots["success"],
                **({"goals_reached": robots["goals_reached"]} if "goals_reached" in robots else {}),
                "finished": self.teams.finished.copy(),
                "collision": robots["collision"],
                "path_length": robots["path_length"],
                "scan": robots["scan"],
                "reward_terms": {name: term.sum(axis=1) for name, term in robots["reward_terms"].items()},
                "measures": self.teams.measures(),
            }
        )
        return own | self.teams.world_infos()

    def last_infos(self) -> Info:
        """The same as ``infos``: the map never changes, all else are copies."""
        return self.infos()

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """A picture of one team; None where nothing is drawn, or a window shows it."""
        return draw_world(self.teams, world)

    def close(self) -> None:
        """Close the window, if there is one."""
        self.teams.window.close()

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        return (self._drawn or self.teams).arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        (self._drawn or self.teams).load_arrays(saved)


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

    The sum of the robots' rewards, each of which is as in ``corridor_v0``: by default ``progress`` along the way and
    ``arrival`` count for it, ``collision`` and ``time`` against it. ``info["reward_terms"]`` holds the terms by name,
    summed over the robots. ``reward`` chooses their weights, or is a function that is asked about each robot on its
    way.

    ## Starting state

    As in ``corridor_v0``.

    ## Episode end

    - Termination: every robot is finished: it has arrived, or (``collision_ends``) touched something.
    - Truncation: after ``max_episode_steps`` (1000) steps.

    ## Info

    By robot: ``pose`` (robots, 3) as localisation gives it, ``goal`` (robots, 2), ``remaining`` length of the way [m],
    ``success`` (it has arrived), ``finished``, ``collision``, ``path_length`` [m], ``scan`` (robots,
    beams) measured ranges [m]. Of the team: ``time`` [s],
    ``reward_terms``, ``map`` (rows, columns) int8 with 0 free, 100 occupied, ``clearance`` (rows, columns) from the
    cells' centres to the nearest wall [m], their ``resolution`` [m], ``origin`` (2,), the robots' ``radius`` [m];
    ``measures``, how the team has done: share ``arrival``, ``all_arrived``, share ``collided``,
    ``makespan`` and ``mean_time`` [s]. With ``expose_truth=True`` also ``truth``: ``pose`` (robots, 3) and
    ``path_length`` (robots,).

    ## Arguments

    Those of ``corridor_v0`` by the same names, such as ``map``, ``robots``, ``places``, ``action`` and ``lidar``; in
    full: ``DrawnOptions``. The limit of steps goes by Gymnasium's name, and plans may be drawn:

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `max_episode_steps` | int | `1000` | truncates; -1 never |
    | `plans` | plan, generator, list | `None` | in place of `map`: another one after a reset with a seed |
    | `episodes_per_plan` | int | `4` | and after so many episodes |

    ## References

    Bennewitz & Burgard, A probabilistic method for planning collision-free trajectories of multiple mobile robots,
    2000.

    ## Version History

    - v0: since Lidarena 0.1. Since 0.2 weights of the reward are given in ``reward``, and the info tells ``pose``,
      ``goal``, ``success``, ``collision`` and ``path_length`` of the robots by these names, as arrays.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "human"], "render_fps": 5}  # noqa: RUF012
    family = "corridor"

    @takes_keywords_of(DrawnOptions)
    def __init__(self, **keywords: Unpack[DrawnKeywords]) -> None:
        """Make one world; the keywords are those of ``DrawnOptions``.

        Raises:
            LidarenaError: A keyword, floor plan, start or goal that cannot be had.
        """
        super().__init__(CentralEpisodes(1, DrawnOptions.checked(keywords)))

    @property
    def floorplan(self) -> Floorplan:
        """The floor plan, for pictures."""
        plan: Floorplan = self.episodes.teams.core.plan
        return plan

    def show(self, sketch: TeamSketch) -> None:
        """Let a planner's sketch be seen in the picture until the next one."""
        self.episodes.teams.sketches[0] = sketch


class BatchedCorridor(BatchedWorlds):
    """``num_envs`` worlds of a team in one step; world ``i`` is ``CorridorCentralEnv`` with seed ``seed + i``.

    See ``BatchedWorlds``; spaces, rewards and keywords: ``CorridorCentralEnv``.

    Args:
        num_envs: Number of worlds.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: See ``DrawnOptions``; without ``plans``.
    """

    family = "corridor"

    @takes_keywords_of(DrawnOptions)
    def __init__(self, num_envs: int = 1, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[DrawnKeywords]) -> None:
        """Make the worlds; raises like ``CorridorCentralEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        super().__init__(CentralEpisodes(worlds, DrawnOptions.checked(keywords)), autoreset_mode)


make_single = entry_point(CorridorCentralEnv)
