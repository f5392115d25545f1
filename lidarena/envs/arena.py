"""Goal reaching: a robot at constant speed among obstacles, which it sees with a lidar or knows beforehand."""

from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from lidarena.envs.arena_episodes import ArenaEpisodes, Info
from lidarena.envs.arena_options import ArenaOptions
from lidarena.envs.arena_picture import draw_arena
from lidarena.envs.exploration import masked
from lidarena.envs.exploration_episodes import of_world
from lidarena.envs.generator_state import generator_from_words, generator_words
from lidarena.world.floorplan import Floorplan
from lidarena.world.refusals import ConfigError


class ArenaEnv(gym.Env[Any, Any]):
    """Reach a goal among obstacles at constant speed.

    ## Description

    The world of Yang et al., "A New Method for Robot Path Planning Based Artificial Potential Field": a room of 100 m
    with circular obstacles, a start and a goal. The robot is a disc that moves at constant speed in a heading that it
    chooses anew in every decision period; rigid bodies are pymunk's. The BARN worlds and floor plans keep their own
    size: what is not given as a keyword is to scale, a power of ten.

    ## Action space

    The turn to the left before the next step, by which the robot then drives straight on for one decision period.

    - ``action="continuous"``, ``Box(-1, 1, (1,), float32)``: the turn over π.
    - ``action="discrete"``, ``Discrete(16)``: number k turns by k · 22.5 degrees.

    ## Observation space

    ``Box(float32, (beams + 3,))``, in the robot's frame:

    | Num | Observation | Min | Max |
    |-----|-------------|-----|-----|
    | 0 … beams - 1 | lidar, the first beam straight ahead, counter-clockwise; see below | 0 | 1 |
    | beams | distance to the goal over 150 m (to scale), at most 1 | 0 | 1 |
    | beams + 1, + 2 | cosine and sine of the goal's bearing | -1 | 1 |

    ``observation="ranges"`` gives beams over the longest range, ``"proximity"`` the robot's radius over the beam.

    ## Rewards

    The sum of ``info["reward_terms"]``, each weighted by the keyword ``<term>_weight``:

    | Term | Value | Default weight |
    |------|-------|------|
    | progress | approach to the goal over the length of a step | 1 |
    | success | 1 where the goal is reached | 10 |
    | collision | -1 where something is touched | 10 |
    | time | -1 | 0.1 |
    | clearance | from 0 at two steps' length from the nearest surface to -1 at contact | 0 |
    | turn | -1 for half a turn | 0 |

    ## Starting state

    The arena's own start, or ``start=(x, y)``, heading for the goal. Families (``"random"``, ``"u_trap"``,
    ``"barn"``) give another arena in every episode, see ``ArenaOptions.pick``.

    ## Episode end

    - Termination: the robot touches something (``collision``), or is within ``goal_radius`` of the goal (``success``).
    - Truncation: after ``max_episode_steps`` (500) steps.

    ## Info

    ``pose`` (3,), ``goal`` (2,), ``distance`` to it [m], ``scan`` (beams,) ranges [m], ``path_length`` [m],
    ``clearance`` [m], the least distance between the robot and anything on the last step, ``time`` [s], ``collision``,
    ``success``, ``robot_radius`` [m], ``reward_terms``. With ``knowledge="map"``, for planners that know the world:
    ``circles`` (K, 3) x, y, radius, which cover the edges of a floor plan, and ``bounds`` (4,) x_min, y_min, x_max,
    y_max [m]. With ``expose_truth=True`` ``truth``: ``circles``, ``bounds``, ``pose``, ``path_length`` and
    ``optimal_time`` (BARN's, [s]; infinite elsewhere), for evaluation.

    ## Arguments

    See ``ArenaOptions``.

    ## References

    Yang, Yang, Zhang, Chang, Chen, Zhang, A New Method for Robot Path Planning Based Artificial Potential Field, ICIEA
    2016. Perille, Truong, Xiao, Stone, Benchmarking Metric Ground Navigation, SSRR 2020.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012 - as gym.Env has it
    family = "arena"

    def __init__(self, **keywords: Any) -> None:
        """Make one world; the keywords are those of ``ArenaOptions``.

        Raises:
            ConfigError: A keyword that is unknown or out of range.
            MapError: An arena that cannot be used, or whose start or goal is in an obstacle.
        """
        options = ArenaOptions.checked(keywords)
        self._episodes = ArenaEpisodes(1, options)
        self.render_mode = options.render_mode
        self.observation_space = self._episodes.single_observation_space
        self.action_space = self._episodes.single_action_space
        self._running = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        """Begin an episode."""
        super().reset(seed=seed)
        self._episodes.reset([0], [self.np_random], [seed])
        self._running = True
        return self._episodes.observe()[0], self._info()

    def step(self, action: Any) -> tuple[Any, float, bool, bool, Info]:
        """Turn, and drive for one decision period.

        Raises:
            ActionError: An action that is NaN, out of range, or of the wrong shape or type.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        if not self._running:
            raise ResetNeeded(
                "step() needs a running episode; call reset() first, and again after an episode has ended"
            )
        rewards, terminated, truncated = self._episodes.step([action])
        self._running = not (terminated[0] or truncated[0])
        return self._episodes.observe()[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), self._info()

    def _info(self) -> Info:
        """The only world's info; its circles are copies, since Gymnasium asks that no two steps share memory."""
        info = of_world(self._episodes.infos(), 0)
        for part in (info, info.get("truth", {})):
            if "circles" in part:
                part["circles"] = part["circles"].copy()
        return info

    @property
    def floorplan(self) -> Floorplan:
        """The arena as it is drawn, for pictures."""
        course = self._episodes.core.courses[0]
        if course is None:
            raise ResetNeeded("there is no arena before reset()")
        return course.plan

    @property
    def step_length(self) -> float:
        """What the robot drives in a decision period [m]."""
        return self._episodes.core.step_length

    def show(self, plan: NDArray[np.float64], before: NDArray[np.float64] | None = None) -> None:
        """Let a policy's plan be seen in the picture until its next one, in place of the field's own.

        Args:
            plan: (S, 2) [m].
            before: (M, 2) the plan before it was smoothed, along which the picture shows forces [m].
        """
        if self._episodes.recorder is not None:
            self._episodes.recorder.show(0, plan, before)

    def render(self) -> NDArray[np.uint8] | None:
        """Picture (height, width, 3) of the potential, the plan and the way driven; None without ``render_mode``.

        Raises:
            ResetNeeded: The environment was not reset.
        """
        if self._episodes.recorder is None:
            gym.logger.warn("render() needs render_mode='rgb_array' when the environment is made")
            return None
        if not self._episodes.recorder.begun(0):
            raise ResetNeeded("render() needs an episode; call reset() first")
        return draw_arena(self._episodes.core, self._episodes.recorder, 0)


class BatchedArena(VectorEnv[Any, Any, Any]):
    """``num_envs`` arenas in one step; world ``i`` is ``ArenaEnv`` with seed ``seed + i`` to the bit.

    A world that ends begins its next episode in the same step (``AutoresetMode.SAME_STEP``): ``infos["final_obs"]`` and
    ``infos["final_info"]`` hold the last observation and info of the old one. Spaces, rewards and keywords:
    ``ArenaEnv``.

    Args:
        num_envs: Number of worlds.
        keywords: Those of ``ArenaOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }
    family = "arena"

    def __init__(self, num_envs: int = 1, **keywords: Any) -> None:
        """Make the worlds; raises like ``ArenaEnv``."""
        if not isinstance(num_envs, int) or num_envs < 1:
            raise ConfigError(f"num_envs = {num_envs!r} must be a whole number of at least 1")
        options = ArenaOptions.checked(keywords)
        self.num_envs = num_envs
        self.render_mode = options.render_mode
        self._episodes = ArenaEpisodes(num_envs, options)
        self.single_observation_space = self._episodes.single_observation_space
        self.single_action_space = self._episodes.single_action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._generators: list[np.random.Generator] = []
        self._everyone = np.ones(num_envs, np.bool_)

    @property
    def step_length(self) -> float:
        """What a robot drives in a decision period [m]."""
        return self._episodes.core.step_length

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, Info]:
        """Begin an episode in every world; a single seed ``s`` gives world ``i`` the seed ``s + i``."""
        seeds = (
            [None if seed is None else seed + i for i in range(self.num_envs)] if not isinstance(seed, list) else seed
        )
        if len(seeds) != self.num_envs:
            raise ConfigError(f"{len(seeds)} seeds were given for {self.num_envs} worlds; one for each is needed")
        if not self._generators:
            self._generators = [seeding.np_random(one)[0] for one in seeds]
        for world, one in enumerate(seeds):
            if one is not None:
                self._generators[world] = seeding.np_random(one)[0]
        self._episodes.reset(range(self.num_envs), self._generators, seeds)
        return self._episodes.observe(), masked(self._episodes.infos(), self._everyone.copy())

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], Info]:
        """Act in every world for one decision period; raises like ``ArenaEnv.step``."""
        if not self._generators:
            raise ResetNeeded("step() needs running episodes; call reset() first")
        rewards, terminated, truncated = self._episodes.step(actions)
        observations = self._episodes.observe()
        done = terminated | truncated
        if not done.any():
            return observations, rewards, terminated, truncated, masked(self._episodes.infos(), self._everyone.copy())
        last = self._episodes.infos()
        ended = np.flatnonzero(done).tolist()
        final_obs = np.full(self.num_envs, None, dtype=object)
        for world in ended:
            final_obs[world] = observations[world].copy()
        self._episodes.reset(ended, self._generators)
        observations[done] = self._episodes.observe()[done]
        infos = masked(self._episodes.infos(), self._everyone.copy())
        infos |= {"final_obs": final_obs, "_final_obs": done.copy()}
        infos |= {"final_info": masked(last, done), "_final_info": done.copy()}
        return observations, rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """One picture a world; None without ``render_mode``."""
        recorder = self._episodes.recorder
        if recorder is None:
            return None
        return tuple(draw_arena(self._episodes.core, recorder, world) for world in range(self.num_envs))

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit."""
        arrays = {name: array.copy() for name, array in self._episodes.arrays().items()}
        arrays["generators"] = np.stack([generator_words(rng) for rng in self._generators])
        return arrays

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of a batch with the same keywords and size was called."""
        self._generators = [generator_from_words(words) for words in state["generators"]]
        self._episodes.load_arrays(state)
