"""Exploration by choosing among the frontiers: a chooser picks one, the driver goes there."""

import math
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.exploration.driving import Terrain
from lidarena.baselines.exploration.frontier import FrontierPolicy
from lidarena.baselines.exploration.frontier_features import CANDIDATES, Candidate, Certainty, describe
from lidarena.planning.grid.frontiers import Frontier, find_frontiers, nearest_cell
from lidarena.planning.grid.grid_search import path_costs

Choose = Callable[[NDArray[np.float32]], int]
"""From the features (CANDIDATES, FEATURES) of the candidates to the number of one."""

_SMALLEST = 0.5  # frontiers below this are left (m), as by explore_lite: they cost more way than they show
_BACK = 2.0  # the start is a candidate when the way to it is longer than this (m)
_SCAN_STEPS = 5  # the uncertainty falls with every scan and grows in between: the least of so many steps is told
_PERIOD = 3.0  # a choice may be changed so often, and whenever what was chosen has vanished (s)
_FRUITLESS = 180.0  # after so long without anything new it ends; across a large building takes a minute (s)
_DITHERS = 30.0  # a robot that has seen nothing new for so long keeps to what it has chosen (s)


class GoalChoicePolicy(FrontierPolicy):
    """Explores like ``frontier``, except that ``choose`` says where to go next.

    The candidates are the frontiers of at least 0.5 m, the nearest ones by way, and the place where the robot started:
    going back there closes a loop. What is told of each is in ``frontier_features``. ``choose``
    is asked when the frontier that was driven to has vanished, and every 3 s; on the way to a frontier no more once
    nothing new has come for 30 s, where the time on the way back to the start does not count. When no frontier is left,
    or nothing new has come for 180 s, it is asked once more whether to end there or to drive back to the start first.

    Attributes:
        finished: Whether nothing is left to explore, and the robot is where it wants to end.
    """

    def __init__(self, env: Any, choose: Choose) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment.
            choose: Who chooses; a candidate that is not there stands for the nearest.
        """
        self._choose = choose
        super().__init__(env, min_frontier_size=_SMALLEST, last_frontier_size=_SMALLEST, last_pass_timeout=_FRUITLESS)
        self._choice_lasts = math.ceil(_PERIOD / self.driver.robot.period)
        self._dithers = math.ceil(_DITHERS / self.driver.robot.period)

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        super().reset(seed)
        self._chosen_at = -math.inf
        self._goes_back = False
        self._ends_at_start: bool | None = None  # None: not asked yet
        self._interrupted = False
        self._places: list[NDArray[np.float64]] = []
        self._uncertainties: deque[float] = deque(maxlen=_SCAN_STEPS)
        self._log_sum = 0.0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: The environment's; only its beams are used.
            info: The environment's; what ``frontier`` uses, and ``d_optimality``.
        """
        if not self._interrupted:
            self._uncertainties.append(float(info["d_optimality"]))
            self._log_sum += math.log(max(self._uncertainties[-1], 1e-12))
            self._places.append(np.array(info["pose"][:2], dtype=np.float64))
        self._interrupted = True  # ``choose`` may raise, to be answered in another call with the same arguments
        action = super().act(observation, info)
        self._interrupted = False
        return action

    def _set_out(self, terrain: Terrain) -> bool:
        found = find_frontiers(
            terrain.occupancy, terrain.cell, terrain.around.resolution, _SMALLEST, goals=terrain.reachable
        )
        self.frontiers = [frontier for frontier in found if self._is_open(frontier, terrain)]
        if self._goes_back:
            self._grown_at = self._step  # nothing new is expected there
        if not self.frontiers or self._is_exhausted(terrain):
            return (self.driver.is_cornered and bool(found)) or self._drives_home(terrain)
        self._ends_at_start = None
        if not self._goes_on(terrain):
            self._choose_anew(terrain)
        if self._goes_back:
            return True
        return self._pursue(self.frontiers, terrain) or self.driver.is_cornered

    def _drives_home(self, terrain: Terrain) -> bool:
        """Whether the robot, with nothing left to explore, is on its way back to the start."""
        if self._ends_at_start is None:
            lengths, stay = self._lengths(terrain), Candidate(terrain.cell, ends=True)
            places = [stay, *self._start_candidate(lengths, terrain)]
            self._ends_at_start = self._chosen(places, lengths, terrain, None) is not stay
        return self._ends_at_start and self._go_back(terrain)

    def _goes_on(self, terrain: Terrain) -> bool:
        """Whether what was chosen is still there and too new to be chosen again; the frontier is then the first."""
        if self._goes_back:
            return self._step - self._chosen_at < self._choice_lasts and self._go_back(terrain)
        lasts = math.inf if self._step - self._grown_at >= self._dithers else self._choice_lasts
        if self._step - self._chosen_at >= lasts:
            return False
        kept = self._pursued(self.frontiers, terrain)
        self.frontiers.sort(key=lambda frontier: frontier is not kept)
        return kept is not None

    def _choose_anew(self, terrain: Terrain) -> None:
        """Have the next place chosen, and put the frontiers in order: that one first, then the nearest by way."""
        lengths = self._lengths(terrain)
        self.frontiers.sort(key=lambda frontier: (lengths[frontier.goal], frontier.goal))
        candidates = self._candidates(lengths, terrain)
        chosen = self._chosen(candidates, lengths, terrain, self._current(candidates, terrain))
        self._chosen_at = self._step
        self.frontiers.sort(key=lambda frontier: frontier is not chosen.frontier)
        self._goes_back = chosen.frontier is None and self._go_back(terrain)

    def _is_open(self, frontier: Frontier, terrain: Terrain) -> bool:
        return any(not self._blacklist.is_given_up(goal) for goal in self._goals(frontier, terrain))

    def _go_back(self, terrain: Terrain) -> bool:
        """Set out for the start, or go on to it; whether there is anything to drive."""
        cell = self._start(terrain)
        if cell[0] < 0:
            return False
        x, y = terrain.around.points(np.array([cell]))[0]
        return self.driver.go((float(x), float(y)), terrain) and not self.driver.arrived

    @staticmethod
    def _lengths(terrain: Terrain) -> NDArray[np.float64]:
        """Length of the way to every cell [m]."""
        lengths: NDArray[np.float64] = path_costs(np.where(np.isfinite(terrain.cost), 1.0, np.inf), terrain.cell)
        return lengths * terrain.around.resolution

    def _start(self, terrain: Terrain) -> tuple[int, int]:
        """The reachable cell nearest to where the robot started."""
        row, column = terrain.around.cell(*self._places[0])
        return nearest_cell(terrain.reachable, row, column)

    def _candidates(self, lengths: NDArray[np.float64], terrain: Terrain) -> list[Candidate]:
        resolution = terrain.around.resolution
        places = [
            Candidate(frontier.goal, frontier.size * resolution, frontier)
            for frontier in self.frontiers[: CANDIDATES - 1]
        ]
        return places + self._start_candidate(lengths, terrain)

    def _start_candidate(self, lengths: NDArray[np.float64], terrain: Terrain) -> list[Candidate]:
        """The start, unless the robot is there or cannot get there."""
        start = self._start(terrain)
        return [Candidate(start)] if start[0] >= 0 and _BACK < lengths[start] < math.inf else []

    def _chosen(
        self, candidates: list[Candidate], lengths: NDArray[np.float64], terrain: Terrain, current: int | None
    ) -> Candidate:
        """Have one of some candidates chosen."""
        if len(candidates) == 1:
            return candidates[0]
        track = np.array(self._places[:: self._every])
        steps = len(self._places)
        certainty = Certainty(
            min(self._uncertainties), math.exp(self._log_sum / steps), steps * self.driver.robot.period
        )
        features = describe(candidates, lengths, terrain, self.driver.pose, current, certainty, track)
        choice = self._choose(features)
        return candidates[choice if 0 <= choice < len(candidates) else 0]

    def _current(self, candidates: list[Candidate], terrain: Terrain) -> int | None:
        """The number of the one that is driven to, if it is still there."""
        if self._goes_back:
            return len(candidates) - 1 if candidates[-1].frontier is None else None
        kept = self._pursued([place.frontier for place in candidates if place.frontier is not None], terrain)
        return next((i for i, place in enumerate(candidates) if kept is not None and place.frontier is kept), None)
