"""The multi-robot world for one controller of the whole team, single and in batches."""

from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.envs.corridor_episodes import CorridorEpisodes, Info
from lidarena.envs.corridor_options import CorridorOptions
from lidarena.envs.corridor_picture import TeamSketch
from lidarena.envs.corridor_scene import draw_world
from lidarena.envs.exploration import masked
from lidarena.envs.exploration_episodes import of_world
from lidarena.envs.generator_state import generator_from_words, generator_words
from lidarena.world.floorplan import Floorplan
from lidarena.world.refusals import ConfigError


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


class CorridorCentralEnv(gym.Env[Any, Any]):
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
            Refusal: A keyword, floor plan, start or goal that cannot be had.
        """
        options = CorridorOptions.checked(keywords)
        self.episodes = CorridorEpisodes(1, options)
        self.render_mode = options.render_mode
        self.observation_space, self.action_space = team_spaces(self.episodes)
        self._running = False

    @property
    def floorplan(self) -> Floorplan:
        """The floor plan, for pictures."""
        return self.episodes.core.plan

    @property
    def options(self) -> CorridorOptions:
        """The keywords."""
        return self.episodes.options

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begin an episode."""
        super().reset(seed=seed)
        self.episodes.reset([0], [self.np_random])
        self._running = True
        return self.episodes.observe()[0], self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, Info]:
        """Act for one decision period.

        Raises:
            ActionError: An action that is NaN, out of range, or of the wrong shape or type.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        if not self._running:
            raise ResetNeeded(
                "step() needs a running episode; call reset() first, and again after an episode has ended"
            )
        rewards, _, _ = self.episodes.step([action])
        terminated, over = bool(self.episodes.finished.all()), bool(self.episodes.over[0])
        self._running = not over
        team = float(rewards.sum(axis=1)[0])
        return self.episodes.observe()[0], team, terminated, over and not terminated, self._info()

    def _info(self) -> Info:
        """The only world's info; its map is a copy, since Gymnasium asks that no two steps share memory."""
        info = of_world(team_infos(self.episodes), 0)
        info["map"] = info["map"].copy()
        return info

    def show(self, sketch: TeamSketch) -> None:
        """Let a planner's sketch be seen in the picture until the next one."""
        self.episodes.sketches[0] = sketch

    def render(self) -> NDArray[np.uint8] | None:
        """Picture (height, width, 3); None without ``render_mode``, or where a window shows it (``"human"``).

        Raises:
            ResetNeeded: The environment was not reset.
        """
        if self.render_mode is None:
            gym.logger.warn("render() needs render_mode='rgb_array' when the environment is made")
        return draw_world(self.episodes, 0)


class BatchedCorridor(VectorEnv[Any, Any, Any]):
    """``num_envs`` worlds of a team in one step; world ``i`` is ``CorridorCentralEnv`` with seed ``seed + i``.

    A world that ends begins its next episode in the same step (``AutoresetMode.SAME_STEP``): ``infos["final_obs"]`` and
    ``infos["final_info"]`` hold the last observation and info of the old one. Spaces, rewards and keywords:
    ``CorridorCentralEnv``.

    Args:
        num_envs: Number of worlds.
        **keywords: See ``CorridorOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 5,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }
    family = "corridor"

    def __init__(self, num_envs: int = 1, **keywords: Any) -> None:
        """Make the worlds; raises like ``CorridorCentralEnv``."""
        if not isinstance(num_envs, int) or num_envs < 1:
            raise ConfigError(f"num_envs = {num_envs!r} must be a whole number of at least 1")
        options = CorridorOptions.checked(keywords)
        self.num_envs = num_envs
        self.render_mode = options.render_mode
        self.episodes = CorridorEpisodes(num_envs, options)
        self.single_observation_space, self.single_action_space = team_spaces(self.episodes)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._generators: list[np.random.Generator] = []

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, Info]:
        """Begin an episode in every world; a single seed ``s`` gives world ``i`` the seed ``s + i``."""
        self._generators = seeded_generators(self._generators, seed, self.num_envs)
        self.episodes.reset(range(self.num_envs), self._generators)
        return self.episodes.observe(), masked(team_infos(self.episodes), np.ones(self.num_envs, np.bool_))

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Act in every world for one decision period; raises like ``CorridorCentralEnv.step``."""
        if not self._generators:
            raise ResetNeeded("step() needs running episodes; call reset() first")
        by_robot, _, _ = self.episodes.step(actions)
        rewards: NDArray[np.float64] = by_robot.sum(axis=1)
        terminated, over = np.asarray(self.episodes.finished.all(axis=1)), self.episodes.over
        observations, everyone = self.episodes.observe(), np.ones(self.num_envs, np.bool_)
        infos: Info = {}
        if over.any():
            infos = {"final_obs": np.full(self.num_envs, None, dtype=object), "_final_obs": over}
            infos |= {"final_info": masked(team_infos(self.episodes), over), "_final_info": over}
            for world in np.flatnonzero(over):
                infos["final_obs"][world] = observations[world].copy()
            self.episodes.reset(np.flatnonzero(over).tolist(), self._generators)
            observations[over] = self.episodes.observe()[over]
        infos = masked(team_infos(self.episodes), everyone) | infos
        return observations, rewards, terminated, over & ~terminated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """One picture a world; None without ``render_mode``."""
        if self.render_mode is None:
            return None
        pictures = [draw_world(self.episodes, world) for world in range(self.num_envs)]
        return tuple(picture for picture in pictures if picture is not None)

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit."""
        arrays = {name: array.copy() for name, array in self.episodes.arrays().items()}
        return arrays | {"generators": np.stack([generator_words(rng) for rng in self._generators])}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of a batch with the same keywords and size was called."""
        self._generators = [generator_from_words(words) for words in state["generators"]]
        self.episodes.load_arrays(state)


def seeded_generators(
    before: list[np.random.Generator], seed: int | list[int | None] | None, worlds: int
) -> list[np.random.Generator]:
    """The worlds' generators: fresh ones where a seed is given, or where there were none.

    Raises:
        ConfigError: The number of seeds is not that of the worlds.
    """
    seeds = [None if seed is None else seed + i for i in range(worlds)] if not isinstance(seed, list) else seed
    if len(seeds) != worlds:
        raise ConfigError(f"{len(seeds)} seeds were given for {worlds} worlds; one for each is needed")
    return [before[world] if before and one is None else seeding.np_random(one)[0] for world, one in enumerate(seeds)]
