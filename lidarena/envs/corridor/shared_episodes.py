"""Episodes of teams, each robot one environment: on one floor plan together, or each team on plans of its own."""

from collections.abc import Iterable
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.corridor.drawn_options import DrawnOptions
from lidarena.envs.corridor.drawn_teams import DrawnTeam
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.episodes import Generators, Outcome, Seeds
from lidarena.envs.infos import Info


class SharedEpisodes:
    """Episodes of teams, each robot one environment; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: Number of teams.
        options: Checked keywords.
    """

    def __init__(self, worlds: int, options: DrawnOptions) -> None:
        self.options, self.worlds, self.envs = options, worlds, worlds * options.robots
        apart = options.plans is not None
        self._drawn = [DrawnTeam(options) for _ in range(worlds)] if apart else []
        self._together = None if apart else CorridorEpisodes(worlds, options)
        self.single_observation_space: gym.Space[Any] = self.groups[0].observation_space
        self.single_action_space: gym.Space[Any] = self.groups[0].action_space

    @property
    def groups(self) -> list[CorridorEpisodes]:
        """The same episodes team by team: all teams in one, or one a team where each has plans of its own."""
        return [drawn.teams for drawn in self._drawn] if self._together is None else [self._together]

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``; with a seed, and after some episodes, on another plan.

        Raises:
            TeamError: No plan has room for the team.
        """
        if self._together is not None:
            self._together.reset(worlds, generators)
            return
        for world in worlds:
            self._drawn[world].begin(generators[world], seeds is not None and seeds[world] is not None)

    def step(self, actions: Any) -> Outcome:
        """Act in every world; a team's robots end together, terminated if finished and else truncated.

        Raises:
            ActionError: Actions that are not one a robot, or see ``team_actions.commands_of``.
        """
        given = np.asarray(actions)
        if given.shape[:1] != (self.envs,):
            raise ActionError(f"actions of shape {given.shape} do not lead with the {self.envs} robots of the batch")
        groups = self.groups
        array = given.reshape(len(groups), -1, self.options.robots, *given.shape[1:])
        outcomes = [self._step_group(group, array[k]) for k, group in enumerate(groups)]
        rewards, terminated, truncated = (np.concatenate(part) for part in zip(*outcomes, strict=True))
        return rewards, terminated, truncated

    @staticmethod
    def _step_group(group: CorridorEpisodes, actions: Any) -> Outcome:
        rewards, _, _ = group.step(actions)
        over, finished = group.over[:, None], group.finished
        return rewards.ravel(), (finished & over).ravel(), (~finished & over).ravel()

    def observe(self) -> NDArray[np.float32]:
        """Fresh observations, a row a robot, zeros of those that are finished."""
        seen = [group.observe().reshape(-1, *self.single_observation_space.shape or ()) for group in self.groups]
        return np.concatenate(seen)

    def infos(self) -> Info:
        """Nothing: a learner does not look at them, and they take time."""
        return Info()

    def last_infos(self) -> Info:
        """How the episodes ended."""
        told = [group.robot_infos() for group in self.groups]
        return Info({name: np.concatenate([one[name].ravel() for one in told]) for name in ("collision", "success")})

    def picture(self, world: int) -> None:
        """Nothing is drawn."""

    def close(self) -> None:
        """Nothing is held."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        if self._together is not None:
            return self._together.arrays()
        parts = [drawn.arrays() for drawn in self._drawn]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        if self._together is not None:
            self._together.load_arrays(saved)
        for world, drawn in enumerate(self._drawn):
            drawn.load_arrays({name: array[world : world + 1] for name, array in saved.items()})
