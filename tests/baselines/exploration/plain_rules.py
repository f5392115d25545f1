"""The rules of ``lidarena.baselines.exploration.rules`` in plain Python, on the readable driver: the tests' oracles."""

import math
from abc import abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.exploration.driving import Terrain
from lidarena.baselines.exploration.frontier import FrontierPolicy
from lidarena.baselines.exploration.rules import visible_unknown
from lidarena.envs.exploration.goal_choice.options import GoalChoiceOptions
from lidarena.planning.grid.frontiers import Frontier, find_frontiers
from lidarena.planning.grid.way_lengths import LEG, first_leg, way_lengths

_BEYOND = 1e3  # the way to a goal that cannot be reached counts as so long (m)
_ADVANTAGE_CELL = 0.2  # ways for the distance advantage are found on a grid of such cells (m)


class PlainRule(FrontierPolicy):
    """``frontier`` with its one pass, ranked by a rule of the default options."""

    kept_by = 0.5

    def __init__(self, env: Any) -> None:
        options = {"persistence": self.kept_by, "planner_period": GoalChoiceOptions.choice_period}
        super().__init__(env, min_frontier_size=0.2, last_frontier_size=0.2, **options)

    def _search(self, terrain: Terrain, size: float) -> list[Frontier]:
        side = terrain.around.resolution
        found = find_frontiers(terrain.occupancy, terrain.cell, side, size, goals=terrain.reachable)
        if not found:
            return []
        lengths = way_lengths(np.isfinite(terrain.cost), *terrain.cell) * side
        kept = self._pursued(found, terrain)
        costs = np.array([self._cost(one, lengths, terrain) for one in found])
        costs -= [self._persistence if one is kept else 0.0 for one in found]
        return [found[k] for k in np.argsort(costs, kind="stable").tolist()]

    @abstractmethod
    def _cost(self, frontier: Frontier, lengths: NDArray[np.float64], terrain: Terrain) -> float:
        """What a frontier costs [m]."""


class PlainNearestFrontier(PlainRule):
    """``nearest_frontier``."""

    kept_by = 1.0

    def _cost(self, frontier: Frontier, lengths: NDArray[np.float64], terrain: Terrain) -> float:
        pose = self.driver.pose
        leg = terrain.around.points(np.array([first_leg(lengths, *frontier.goal, LEG)]))[0] - pose[:2]
        turn = abs(math.remainder(math.atan2(leg[1], leg[0]) - pose[2], 2.0 * math.pi))
        size = min(frontier.size * terrain.around.resolution, 2.0)
        return min(float(lengths[frontier.goal]), _BEYOND) + turn / math.pi - 0.5 * size


class PlainInformationGain(PlainRule):
    """``information_gain``."""

    def _cost(self, frontier: Frontier, lengths: NDArray[np.float64], terrain: Terrain) -> float:
        side = terrain.around.resolution
        cells = visible_unknown(terrain.occupancy, frontier.goal, 3.0 / side)
        return min(float(lengths[frontier.goal]), _BEYOND) - 3.0 * math.log1p(cells * (side / 0.25) ** 2)


class PlainDistanceAdvantage(PlainRule):
    """``distance_advantage``."""

    def _cost(self, frontier: Frontier, lengths: NDArray[np.float64], terrain: Terrain) -> float:
        every = max(1, round(_ADVANTAGE_CELL / terrain.around.resolution))
        coarse = _coarsened(np.isfinite(terrain.cost) & terrain.reachable, every)
        side, robot = every * terrain.around.resolution, _coarse_cell(coarse, terrain.cell, every)
        away = np.hypot(*(np.indices(coarse.shape) - np.array(robot)[:, None, None])) * side
        ways = way_lengths(coarse, *_coarse_cell(coarse, frontier.goal, every)) * side
        reached = ways[coarse & (away <= 15.0) & np.isfinite(ways)]
        return float(ways[robot]) - float(reached.mean())


def _coarsened(cells: NDArray[np.bool_], every: int) -> NDArray[np.bool_]:
    """Blocks of ``every`` × ``every`` cells, True where any of theirs is; a partial block at the end counts."""
    rows, columns = (-(-size // every) for size in cells.shape)
    whole = np.zeros((rows * every, columns * every), np.bool_)
    whole[: cells.shape[0], : cells.shape[1]] = cells
    return np.asarray(whole.reshape(rows, every, columns, every).any(axis=(1, 3)))


def _coarse_cell(coarse: NDArray[np.bool_], cell: tuple[int, int], every: int) -> tuple[int, int]:
    return min(cell[0] // every, coarse.shape[0] - 1), min(cell[1] // every, coarse.shape[1] - 1)
