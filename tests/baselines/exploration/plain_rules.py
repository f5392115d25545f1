"""The rules of ``lidarena.baselines.exploration.rules`` in plain Python, on the readable driver: the tests' oracles."""

import math
from abc import abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.baselines.exploration.driving import Terrain
from lidarena.baselines.exploration.frontier import FrontierPolicy
from lidarena.baselines.exploration.rules import visible_unknown
from lidarena.planning.grid.frontiers import Frontier, find_frontiers
from lidarena.planning.grid.way_lengths import LEG, first_leg
from lidarena.planning.grid.way_lengths import way_lengths as lengths_in_cells

_BEYOND = 1e3  # the way to a goal that cannot be reached counts as so long (m)
_ADVANTAGE_CELL = 0.2  # ways for the distance advantage are found on a grid of such cells (m)


class PlainRule(FrontierPolicy):
    """Explores like ``frontier``, driven by the same driver, except that a rule ranks the frontiers.

    The driver, the two passes and the blacklist are ``frontier``'s. The frontier that is driven to is kept as long as
    no other one is better by ``persistence``.
    """

    def __init__(self, env: Any, *, persistence: float, **options: float) -> None:
        super().__init__(env, persistence=persistence, **options)

    def _search(self, terrain: Terrain, size: float) -> list[Frontier]:
        found = find_frontiers(
            terrain.occupancy, terrain.cell, terrain.around.resolution, size, goals=terrain.reachable
        )
        if not found:
            return []
        costs = self._costs(found, terrain)
        kept = self._pursued(found, terrain)
        costs = [cost - (self._persistence if one is kept else 0.0) for cost, one in zip(costs, found, strict=True)]
        return [found[k] for k in np.argsort(costs, kind="stable").tolist()]

    @abstractmethod
    def _costs(self, found: list[Frontier], terrain: Terrain) -> list[float]:
        """What each frontier costs [m]; the least is driven to."""


def way_lengths(terrain: Terrain) -> NDArray[np.float64]:
    """Length of the way from the robot to every cell (rows, cols) [m], inf where there is none."""
    return lengths_in_cells(np.isfinite(terrain.cost), *terrain.cell) * terrain.around.resolution


def _check(**options: float) -> None:
    for name, value in options.items():
        if not 0.0 <= value < math.inf:
            raise ConfigError(f"{name} = {value}, allowed are finite numbers >= 0")


class PlainNearestFrontier(PlainRule):
    """Drives to the frontier with the shortest way (Yamauchi 1997), a little for turning, size and keeping on."""

    def __init__(
        self,
        env: Any,
        *,
        turn_cost: float = 1.0,
        size_gain: float = 0.5,
        persistence: float = 1.0,
        min_frontier_size: float = 0.2,
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment.
            turn_cost: What turning right round before the way is worth [m].
            size_gain: What a metre of frontier is worth, up to two metres [m].
            persistence: How much better another frontier must be for the robot to turn away from the one it is driving
                to [m]; 0 for none.
            min_frontier_size: Smallest frontier [m].

        Raises:
            ConfigError: An option that is negative or not finite.
        """
        _check(turn_cost=turn_cost, size_gain=size_gain)
        self._turn_cost, self._size_gain = turn_cost, size_gain
        super().__init__(
            env, persistence=persistence, min_frontier_size=min_frontier_size, last_frontier_size=min_frontier_size
        )

    def _costs(self, found: list[Frontier], terrain: Terrain) -> list[float]:
        lengths, pose = way_lengths(terrain), self.driver.pose
        costs = []
        for frontier in found:
            leg = terrain.around.points(np.array([first_leg(lengths, *frontier.goal, LEG)]))[0] - pose[:2]
            turn = abs(math.remainder(math.atan2(leg[1], leg[0]) - pose[2], 2.0 * math.pi))
            size = min(frontier.size * terrain.around.resolution, 2.0)
            way = min(float(lengths[frontier.goal]), _BEYOND)
            costs.append(way + self._turn_cost * turn / math.pi - self._size_gain * size)
        return costs


class PlainInformationGain(PlainRule):
    """Drives where most is to be seen for the way: the greatest 3 ln(1 + g) - d (as in Ericson et al. 2025).

    g counts the unknown cells of 0.25 m that a scan from the frontier could reach at most: those within the lidar's
    range, or ``sight``, that no known wall hides. d is the length of the way [m]. It is the next best view among the
    frontiers (González-Baños & Latombe 2002).
    """

    def __init__(
        self,
        env: Any,
        *,
        gain: float = 3.0,
        sight: float = 3.0,
        persistence: float = 0.5,
        min_frontier_size: float = 0.2,
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment.
            gain: Weight of the logarithm [m].
            sight: How far a scan is expected to see [m].
            persistence: As in ``nearest_frontier`` [m].
            min_frontier_size: Smallest frontier [m].

        Raises:
            ConfigError: An option that is negative or not finite.
        """
        _check(gain=gain, sight=sight)
        self._gain, self._sight = gain, sight
        super().__init__(
            env, persistence=persistence, min_frontier_size=min_frontier_size, last_frontier_size=min_frontier_size
        )

    def _costs(self, found: list[Frontier], terrain: Terrain) -> list[float]:
        lengths, resolution = way_lengths(terrain), terrain.around.resolution
        costs = []
        for frontier in found:
            cells = visible_unknown(terrain.occupancy, frontier.goal, self._sight / resolution)
            gain = self._gain * math.log1p(cells * (resolution / 0.25) ** 2)
            costs.append(min(float(lengths[frontier.goal]), _BEYOND) - gain)
        return costs


class PlainDistanceAdvantage(PlainRule):
    """Drives to what is near to it and far from the rest (Ericson, Pedro, Jensfelt 2025, "distance advantage").

    The score of a frontier v is the mean over the free cells u within ``radius`` of d(u, v) - d(robot, v), all by
    shortest ways in the known map; the greatest is driven to: a frontier that it would be dear to come back to.
    """

    def __init__(
        self, env: Any, *, radius: float = 15.0, persistence: float = 0.5, min_frontier_size: float = 0.2
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment.
            radius: Free cells so near to the robot count, in straight distance [m].
            persistence: As in ``nearest_frontier`` [m].
            min_frontier_size: Smallest frontier [m].

        Raises:
            ConfigError: An option that is negative or not finite.
        """
        _check(radius=radius)
        self._radius = radius
        super().__init__(
            env, persistence=persistence, min_frontier_size=min_frontier_size, last_frontier_size=min_frontier_size
        )

    def _costs(self, found: list[Frontier], terrain: Terrain) -> list[float]:
        every = max(1, round(_ADVANTAGE_CELL / terrain.around.resolution))
        coarse = _coarsened(np.isfinite(terrain.cost) & terrain.reachable, every)
        side = every * terrain.around.resolution
        robot = _coarse_cell(coarse, terrain.cell, every)
        away = np.hypot(*(np.indices(coarse.shape) - np.array(robot)[:, None, None])) * side
        counted = coarse & (away <= self._radius)
        costs = []
        for frontier in found:
            lengths = lengths_in_cells(coarse, *_coarse_cell(coarse, frontier.goal, every)) * side
            near = lengths[counted]
            own = float(lengths[robot])
            reached = near[np.isfinite(near)]
            costs.append(own - float(reached.mean()) if len(reached) and math.isfinite(own) else _BEYOND)
        return costs


def _coarsened(cells: NDArray[np.bool_], every: int) -> NDArray[np.bool_]:
    """Blocks of ``every`` × ``every`` cells, True where any of theirs is; a partial block at the end counts."""
    rows, columns = (-(-size // every) for size in cells.shape)
    whole = np.zeros((rows * every, columns * every), np.bool_)
    whole[: cells.shape[0], : cells.shape[1]] = cells
    return np.asarray(whole.reshape(rows, every, columns, every).any(axis=(1, 3)))


def _coarse_cell(coarse: NDArray[np.bool_], cell: tuple[int, int], every: int) -> tuple[int, int]:
    return min(cell[0] // every, coarse.shape[0] - 1), min(cell[1] // every, coarse.shape[1] - 1)
