"""Exploration by choosing among candidates: a chooser picks one, the compiled driver goes there."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.keyword_checks import check_range
from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.envs.exploration.goal_choice.explorers import driver_settings, explorer_settings
from lidarena.envs.exploration.goal_choice.features import FEATURES, Circumstances, describe
from lidarena.envs.exploration.goal_choice.options import GoalChoiceOptions
from lidarena.envs.exploration.options import ExplorationOptions
from lidarena.planning.driving.explorer import (
    CHOOSES,
    ENDINGS,
    Explorers,
    advance,
    begin,
    command,
    empty_explorers,
    set_out,
)
from lidarena.planning.driving.state import Perceptions

Choose = Callable[[NDArray[np.float32]], int]
"""From what is told of the candidates (K, FEATURES + K), ``features.NAMES``, to the number of one."""


class ChoosingExplorer:
    """Explores like ``lidarena/GoalChoice-v0``: drives as ``frontier`` does to whatever ``choose`` picks.

    It reads the map, pose, scan and D-optimality in ``info``, and nothing else.

    Attributes:
        finished: Whether nothing is left to explore; the robot then keeps turning.
        preference: How much certainty is worth, from 0 to 1; told to ``choose``.
    """

    def __init__(
        self,
        env: Any,
        choose: Choose | None = None,
        *,
        preference: float = 0.5,
        candidates: int = 24,
        places: int = 6,
        least_frontier: float = GoalChoiceOptions.least_frontier,
        choice_period: float = GoalChoiceOptions.choice_period,
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment; any observation, reward or action.
            choose: Who chooses; one that is not there stands for the nearest frontier, which None always chooses.
            preference: See above.
            candidates: Most candidates that ``choose`` is told of.
            places: Known places among them, at most.
            least_frontier: Smallest frontier that is a candidate [m].
            choice_period: A choice may be changed so often [s].

        Raises:
            ConfigError: A number out of range, or actions that are neither ``Discrete(3)`` nor a box of two numbers.
        """
        check_range("preference", preference, 0.0, 1.0)
        self._choose, self.preference, self._most = choose, float(preference), candidates
        self._robot = Robot(env)
        self._settings = explorer_settings(self._robot.period, choice_period, least_frontier, places)
        self._explorers: Explorers | None = None
        self.finished = False

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self._explorers, self.finished = None, False

    def act(self, observation: Any, info: Mapping[str, Any]) -> Any:
        """Return the next action of the environment."""
        # copies, since kernels are compiled once for arrays that may be written to, as those of the batch are
        senses = Perceptions(
            np.array(info["map"], np.int8)[None],
            np.array(info["origin"], np.float64)[None],
            np.array(info["pose"], np.float64)[None],
            np.array(info["scan"], np.float32)[None],
        )
        explorers = self._hired(senses, float(info["resolution"]))
        log_d = math.log(max(float(info["d_optimality"]), 1e-9))
        status = advance(0, log_d, senses, self._driver, self._settings, explorers)
        if status == CHOOSES:
            set_out(0, self._chosen(explorers, log_d), senses, self._driver, explorers)
        self.finished = bool(explorers.finished[0])
        return self._robot.action(command(0, senses, self._driver, explorers))

    def _hired(self, senses: Perceptions, resolution: float) -> Explorers:
        if self._explorers is None:
            self._driver = driver_settings(self._robot.options, self._robot.commands, resolution)
            rows, columns = senses.maps.shape[1:]
            self._explorers = empty_explorers(1, rows, columns, self._most, self._driver)
            begin(self._explorers, 0)
        return self._explorers

    def _chosen(self, explorers: Explorers, log_d: float) -> int:
        if explorers.candidates.number[0] == 1:
            return 0
        around = Circumstances(np.array([log_d]), np.array([self.preference]), self._robot.period)
        rows = np.zeros((self._most, FEATURES + self._most), np.float32)
        describe(0, around, explorers, rows)
        return self._choose(rows) if self._choose is not None else -1

    @property
    def ending(self) -> str:
        """Why the exploration has ended, one of ``ENDINGS``; empty before it has."""
        return "" if self._explorers is None or not self.finished else ENDINGS[int(self._explorers.ending[0])]

    @property
    def path(self) -> NDArray[np.float64]:
        """The path that is followed, (n, 2) x, y [m]."""
        if self._explorers is None:
            return np.empty((0, 2))
        drive = self._explorers.drive
        return np.array(drive.path[0, : drive.path_points[0]])

    @property
    def options(self) -> ExplorationOptions:
        """Those of the environment."""
        return self._robot.options
