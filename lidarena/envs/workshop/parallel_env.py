"""The workshop for PettingZoo, in which human and robot both decide: ``parallel_env`` and ``env``.

from lidarena.envs import workshop_v0

team = workshop_v0.parallel_env(task="gearbox")
"""

from dataclasses import fields
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray
from pettingzoo import AECEnv
from pettingzoo.utils import parallel_to_aec, wrappers

from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_parallel_env import Observations, Outcomes, ParallelWorld, check_cycles
from lidarena.envs.infos import Info, of_world
from lidarena.envs.workshop.actions import decisions_of
from lidarena.envs.workshop.episodes import WorkshopEpisodes
from lidarena.envs.workshop.options import WorkshopKeywords, WorkshopOptions
from lidarena.envs.workshop.task import WorkshopTask
from lidarena.envs.workshop.task_file import AGENTS

__all__ = ["WorkshopTeamEnv", "env", "parallel_env", "raw_env"]

_WITHOUT = ("max_episode_steps", "human", "observation")


class WorkshopTeamEnv(ParallelWorld):
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
        known = [field.name for field in fields(WorkshopOptions) if field.name not in _WITHOUT]
        check_cycles("workshop_v0", max_cycles, keywords, known)
        options = WorkshopOptions.checked({**keywords, "max_episode_steps": max_cycles}, external=True)
        episodes = WorkshopEpisodes(1, options)
        both = list(AGENTS)
        super().__init__(episodes, both, episodes.single_observation_space, episodes.single_action_space)

    @property
    def task(self) -> WorkshopTask:
        """What is to be done."""
        task: WorkshopTask = self.episodes.core.task
        return task

    def step(self, actions: dict[str, Any]) -> Outcomes:
        """Let both decide, and run until the next decision of either is due.

        Raises:
            ActionError: An action that is missing, of an unknown agent, or no whole number of an action.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        self._check_agents(actions)
        human, robot = self._choices(actions)
        rewards, terminated, truncated = self.episodes.step_both(human, robot, robot)
        gains = {name: float(rewards[0]) for name in AGENTS}
        ended = {name: bool(terminated[0]) for name in AGENTS}
        cut_off = {name: bool(truncated[0]) for name in AGENTS}
        if ended["robot"] or cut_off["robot"]:
            self.agents = []
        both = list(AGENTS)
        return self._observations(both), gains, ended, cut_off, self._infos(both)

    def _choices(self, actions: dict[str, Any]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        count = len(self.task.actions)
        return decisions_of([actions["human"]], 1, count), decisions_of([actions["robot"]], 1, count)

    def _observations(self, agents: list[str]) -> Observations:
        return {name: self.episodes.seen_by(self._numbers[name])[0] for name in agents}

    def _infos(self, agents: list[str]) -> dict[str, Info]:
        facts = of_world(self.episodes.infos(), 0)
        terms = facts.pop("reward_terms")  # one by one: libraries that stack infos of agents take no dictionaries
        facts |= {f"reward_{name}": term for name, term in terms.items()}
        own = {}
        for name in agents:
            agent = self._numbers[name]
            mine = Info(facts)
            mine["action_mask"] = self.episodes.masks(agent)[0].astype(np.int8)
            mine["pose"], mine["path_length"] = facts["pose"][agent], facts["path_length"][agent]
            mine["poses_of_both"] = facts["pose"]
            own[name] = mine
        return own

    def state(self) -> NDArray[np.float32]:
        """What both see, (2, numbers)."""
        return np.stack([self.episodes.seen_by(agent)[0] for agent in range(2)])

    def _remaining(self) -> list[str]:
        return [] if self.episodes.over[0] else list(AGENTS)


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
