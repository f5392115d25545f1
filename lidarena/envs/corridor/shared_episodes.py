"""Episodes of teams, each robot one environment: on one floor plan together, or each team on plans of its own."""

from collections.abc import Iterable
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError, TeamError
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.shared_options import SharedOptions
from lidarena.envs.episodes import Generators, Outcome, Seeds
from lidarena.envs.infos import Info

_TRIES = 50
"""So many plans in a row may be too small for the team."""


class SharedEpisodes:
    """Episodes of teams, each robot one environment; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: Number of teams.
        options: Checked keywords.

    Attributes:
        groups: The same episodes team by team: all teams in one, or one a team where each has plans of its own.
    """

    def __init__(self, worlds: int, options: SharedOptions) -> None:
        self.options, self.worlds, self.envs = options, worlds, worlds * options.robots
        self._apart = options.plans is not None
        first = CorridorEpisodes(1, options.team_on(0)) if self._apart else CorridorEpisodes(worlds, options)
        self.groups = [first] * worlds if self._apart else [first]
        self._plan, self._left = np.full(worlds, -1), np.zeros(worlds, np.int64)
        self.single_observation_space: gym.Space[Any] = first.observation_space
        self.single_action_space: gym.Space[Any] = first.action_space

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``; with a seed, and after some episodes, on another plan.

        Raises:
            TeamError: No plan has room for the team.
        """
        if not self._apart:
            self.groups[0].reset(worlds, generators)
            return
        for world in worlds:
            if seeds is not None and seeds[world] is not None:
                self._left[world] = 0
            self._begin(world, generators[world])
            self._left[world] -= 1

    def _begin(self, world: int, rng: np.random.Generator) -> None:
        """Begin an episode, on another plan where it is time for one or the present one turns out to be too small."""
        for _ in range(_TRIES):
            try:
                if self._left[world] == 0:
                    self._lay_out(world, self.options.draw(rng))
                    self._left[world] = self.options.episodes_per_plan
                self.groups[world].reset([0], [rng])
                return
            except TeamError as error:
                self._left[world], refusal = 0, error
        raise TeamError(
            f"{_TRIES} plans in a row have no room for {self.options.robots} robots; of the last one: {refusal}"
        )

    def _lay_out(self, world: int, number: int) -> None:
        self.groups[world] = CorridorEpisodes(1, self.options.team_on(number))
        self._plan[world] = number

    def step(self, actions: Any) -> Outcome:
        """Act in every world; a team's robots end together, terminated if finished and else truncated.

        Raises:
            ActionError: Actions that are not one a robot, or see ``team_actions.commands_of``.
        """
        given = np.asarray(actions)
        if given.shape[:1] != (self.envs,):
            raise ActionError(f"actions of shape {given.shape} do not lead with the {self.envs} robots of the batch")
        array = given.reshape(len(self.groups), -1, self.options.robots, *given.shape[1:])
        outcomes = [self._step_group(group, array[k]) for k, group in enumerate(self.groups)]
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
        if not self._apart:
            return self.groups[0].arrays()
        parts = [group.arrays() for group in self.groups]
        stacked = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        return stacked | {"plan": self._plan, "left": self._left}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        if not self._apart:
            self.groups[0].load_arrays(saved)
            return
        self._left[:] = saved["left"]
        for world, number in enumerate(saved["plan"].tolist()):
            self._lay_out(world, number)
            self.groups[world].load_arrays({name: saved[name][world : world + 1] for name in self._teams_own(saved)})

    @staticmethod
    def _teams_own(saved: dict[str, NDArray[Any]]) -> list[str]:
        return [name for name in saved if name not in ("plan", "left")]
