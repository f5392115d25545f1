"""The workshop for PettingZoo, in which human and robot both decide: ``parallel_env`` and ``env``.

from lidarena.envs import workshop_v0

team = workshop_v0.parallel_env(task="gearbox")
"""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, Unpack

import gymnasium as gym
import numpy as np
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import AECEnv, ParallelEnv
from pettingzoo.utils import parallel_to_aec, wrappers

from lidarena.base.errors import ActionError, ConfigError, suggest
from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.base.keyword_checks import check_names, check_step_limit, takes_keywords_of
from lidarena.envs.infos import Info, of_world
from lidarena.envs.workshop.actions import action_space, decisions_of
from lidarena.envs.workshop.episodes import WorkshopEpisodes
from lidarena.envs.workshop.options import WorkshopKeywords, WorkshopOptions
from lidarena.envs.workshop.task import WorkshopTask
from lidarena.envs.workshop.task_file import AGENTS

__all__ = ["WorkshopTeamEnv", "env", "parallel_env", "raw_env"]

_WITHOUT = ("max_episode_steps", "human", "observation")


class WorkshopTeamEnv(ParallelEnv[str, NDArray[np.float32], Any]):  # type: ignore[misc]  # PettingZoo is untyped
    """A human and a robot do a task together; the agents are ``human`` and ``robot``.

    The world, the spaces, the rewards and the infos are those of ``lidarena/Workshop-v0`` (``WorkshopEnv``), seen by
    either agent: in its observation ``robot`` stands for the agent itself, ``human`` for the other. A step lasts until
    somebody's next decision is due. Who is at something then goes on whatever its action says: its
    ``info["action_mask"]`` allows only to wait, the last action. The human may begin what is not allowed, and it counts
    as unplanned; where both begin the same action, the human does. Both get the same reward. The episode ends for both
    at once.

    Keywords are those of ``WorkshopOptions`` without ``human`` and ``observation``, and ``max_cycles`` for
    ``max_episode_steps``.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - as PettingZoo declares it
        "name": "workshop_v0",
        "render_modes": ["rgb_array"],
        "render_fps": 2,
        "is_parallelizable": True,
    }
    family = "workshop"

    @takes_keywords_of(WorkshopOptions, without=_WITHOUT)
    def __init__(self, max_cycles: int | None = None, **keywords: Unpack[WorkshopKeywords]) -> None:
        """Make one world.

        Args:
            max_cycles: Steps after which an episode is truncated; None is 400, -1 never.
            **keywords: Those of ``WorkshopOptions``.

        Raises:
            LidarenaError: A keyword or task that cannot be had.
        """
        if "max_episode_steps" in keywords:
            raise ConfigError("keyword 'max_episode_steps' is called 'max_cycles' here, as everywhere in PettingZoo")
        known = [field.name for field in fields(WorkshopOptions) if field.name not in _WITHOUT]
        check_names("workshop_v0", keywords, ["max_cycles", *known])
        if max_cycles is not None:
            check_step_limit(max_cycles, "max_cycles")
        options = WorkshopOptions.checked({**keywords, "max_episode_steps": max_cycles}, external=True)
        self.episodes = WorkshopEpisodes(1, options)
        self.max_cycles, self.render_mode = options.max_episode_steps, options.render_mode
        self.possible_agents = list(AGENTS)
        self.agents: list[str] = []
        one = self.episodes.single_observation_space
        assert isinstance(one, gym.spaces.Box)
        count = len(self.task.actions)
        self._observation_spaces = {name: gym.spaces.Box(one.low, one.high, dtype=np.float32) for name in AGENTS}
        self._action_spaces = {name: action_space(count) for name in AGENTS}
        self._generator: np.random.Generator | None = None

    def observation_space(self, agent: str) -> gym.Space[Any]:
        """Of an agent; always the same object."""
        return self._observation_spaces[agent]

    def action_space(self, agent: str) -> gym.Space[Any]:
        """Of an agent; always the same object."""
        return self._action_spaces[agent]

    @property
    def task(self) -> WorkshopTask:
        """What is to be done."""
        return self.episodes.core.task

    @property
    def options(self) -> WorkshopOptions:
        """The keywords."""
        return self.episodes.options

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, Info]]:
        """Begin an episode."""
        if seed is not None or self._generator is None:
            self._generator = seeding.np_random(seed)[0]
        self.episodes.reset([0], [self._generator])
        self.agents = list(AGENTS)
        return self._observations(), self._infos()

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Info]]:
        """Let both decide, and run until the next decision of either is due.

        Raises:
            ActionError: An action that is missing, of an unknown agent, or no whole number of an action.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        if not self.agents:
            raise ResetNeeded("step() needs a running episode; call reset() first, and again when no agents are left")
        human, robot = self._choices(actions)
        rewards, terminated, truncated = self.episodes.step_both(human, robot, robot)
        gains = {name: float(rewards[0]) for name in AGENTS}
        ended = {name: bool(terminated[0]) for name in AGENTS}
        cut_off = {name: bool(truncated[0]) for name in AGENTS}
        if ended["robot"] or cut_off["robot"]:
            self.agents = []
        return self._observations(), gains, ended, cut_off, self._infos()

    def _choices(self, actions: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        if not isinstance(actions, Mapping):
            raise ActionError(f"actions of type {type(actions).__name__} were given; a dictionary by agent is needed")
        for name in actions:
            if name not in AGENTS:
                raise ActionError(f"there is no agent {name!r}{suggest(str(name), AGENTS)}")
        for name in AGENTS:
            if name not in actions:
                raise ActionError(f"the action of agent {name!r} is missing; one is needed for every agent in agents")
        count = len(self.task.actions)
        return decisions_of([actions["human"]], 1, count), decisions_of([actions["robot"]], 1, count)

    def _observations(self) -> dict[str, NDArray[np.float32]]:
        return {name: self.episodes.seen_by(agent)[0] for agent, name in enumerate(AGENTS)}

    def _infos(self) -> dict[str, Info]:
        facts = of_world(self.episodes.infos(), 0)
        terms = facts.pop("reward_terms")  # one by one: libraries that stack infos of agents take no dictionaries
        facts |= {f"reward_{name}": term for name, term in terms.items()}
        own = {}
        for agent, name in enumerate(AGENTS):
            mine = Info(facts)
            mine["action_mask"] = self.episodes.masks(agent)[0].astype(np.int8)
            mine["pose"], mine["path_length"] = facts["pose"][agent], facts["path_length"][agent]
            mine["poses_of_both"] = facts["pose"]
            own[name] = mine
        return own

    def render(self) -> NDArray[np.uint8] | None:
        """Picture (height, width, 3); None without ``render_mode``.

        Raises:
            ResetNeeded: The environment was not reset.
        """
        if self.render_mode is None:
            gym.logger.warn("render() needs render_mode='rgb_array' when the environment is made")
            return None
        if self._generator is None:
            raise ResetNeeded("render() needs an episode; call reset() first")
        return self.episodes.picture(0)

    def close(self) -> None:
        """Nothing is held."""

    def state(self) -> NDArray[np.float32]:
        """What both see, (2, numbers)."""
        return np.stack([self.episodes.seen_by(agent)[0] for agent in range(2)])

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, as arrays; ``set_state`` continues from there to the bit."""
        assert self._generator is not None
        arrays = {name: array.copy() for name, array in self.episodes.arrays().items()}
        return arrays | {"generators": generator_words(self._generator)[None]}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue where ``get_state`` of an environment with the same keywords was called."""
        self._generator = generator_from_words(state["generators"][0])
        self.episodes.load_arrays(state)
        self.agents = [] if bool((self.episodes.core.workers.status == 2).all()) else list(AGENTS)


@takes_keywords_of(WorkshopOptions, without=_WITHOUT)
def parallel_env(max_cycles: int | None = None, **keywords: Unpack[WorkshopKeywords]) -> WorkshopTeamEnv:
    """Make the environment in PettingZoo's parallel form; see ``WorkshopTeamEnv``."""
    return WorkshopTeamEnv(max_cycles, **keywords)


@takes_keywords_of(WorkshopOptions, without=_WITHOUT)
def raw_env(
    max_cycles: int | None = None, **keywords: Unpack[WorkshopKeywords]
) -> AECEnv[str, NDArray[np.float32], Any]:
    """Make the environment in PettingZoo's agent-by-agent form, without wrappers."""
    return parallel_to_aec(parallel_env(max_cycles, **keywords))


@takes_keywords_of(WorkshopOptions, without=_WITHOUT)
def env(max_cycles: int | None = None, **keywords: Unpack[WorkshopKeywords]) -> AECEnv[str, NDArray[np.float32], Any]:
    """Make the environment in PettingZoo's agent-by-agent form (AEC), by PettingZoo's conversion."""
    return wrappers.OrderEnforcingWrapper(raw_env(max_cycles, **keywords))
