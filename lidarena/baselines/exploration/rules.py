"""Rules that choose among the frontiers by the way to them: the nearest, the one with most to see, and by advantage."""

import math
from abc import abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.jit import kernel
from lidarena.baselines.exploration.choosing_explorer import ChoosingExplorer
from lidarena.baselines.registry import register
from lidarena.planning.driving.candidates import FRONTIER
from lidarena.planning.driving.explorer import Explorers

_CANDIDATES = 64
_VIEW_CELL = 0.25  # unknown area is counted in such cells (m), as Ericson et al. do


class RuledExplorer(ChoosingExplorer):
    """Explores like ``frontier``, driven by the same driver, except that a rule ranks the frontiers.

    The blacklist is ``frontier``'s. The frontier that is driven to is kept as long as no other one is better by
    ``persistence``.

    Args:
        env: The environment, or what wraps it.
        persistence: By how much a frontier must be better than the one that is driven to [m].
        min_frontier_size: Shorter ones are left out [m].
        **settings: Of the rule.

    Raises:
        ConfigError: A length is out of range.
    """

    def __init__(self, env: Any, *, persistence: float, min_frontier_size: float, **settings: float) -> None:
        check_lengths(persistence=persistence, min_frontier_size=min_frontier_size)
        self._persistence = persistence
        super().__init__(
            env, None, candidates=_CANDIDATES, places=0, least_frontier=max(min_frontier_size, 1e-9), **settings
        )

    def _chosen(self, explorers: Explorers, log_d: float) -> int:
        candidates, count = explorers.candidates, int(explorers.candidates.number[0])
        costs = self._costs(explorers, count)
        costs[candidates.kind[0, :count] != FRONTIER] = np.inf
        if candidates.pursued[0] >= 0:
            costs[candidates.pursued[0]] -= self._persistence
        return int(np.argmin(costs))

    @abstractmethod
    def _costs(self, explorers: Explorers, count: int) -> NDArray[np.float64]:
        """What each of the candidates costs, (count,) [m]; the least is driven to."""


def check_lengths(**options: float) -> None:
    """Refuse options that are negative or not finite.

    Raises:
        ConfigError: It names one.
    """
    for name, value in options.items():
        if not 0.0 <= value < math.inf:
            raise ConfigError(f"{name} = {value}, allowed are finite numbers >= 0")


@register("nearest_frontier", family="exploration")
class NearestFrontierPolicy(RuledExplorer):
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
        check_lengths(turn_cost=turn_cost, size_gain=size_gain)
        self._turn_cost, self._size_gain = turn_cost, size_gain
        super().__init__(env, persistence=persistence, min_frontier_size=min_frontier_size)

    def _costs(self, explorers: Explorers, count: int) -> NDArray[np.float64]:
        candidates = explorers.candidates
        turns, sizes = candidates.turn[0, :count] / math.pi, np.minimum(candidates.size[0, :count], 2.0)
        return np.asarray(candidates.way[0, :count] + self._turn_cost * turns - self._size_gain * sizes)


@register("information_gain", family="exploration")
class InformationGainPolicy(RuledExplorer):
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
        check_lengths(gain=gain, sight=sight)
        self._gain, self._sight = gain, sight
        super().__init__(env, persistence=persistence, min_frontier_size=min_frontier_size)

    def _costs(self, explorers: Explorers, count: int) -> NDArray[np.float64]:
        candidates, ground = explorers.candidates, explorers.drive.ground
        rows, columns = ground.extent[0, 2:].tolist()
        side = float(ground.frame[0, 2])
        occupancy = ground.occupancy[0, : rows * columns].reshape(rows, columns)
        cells = [visible_unknown(occupancy, (r, c), self._sight / side) for r, c in candidates.cell[0, :count].tolist()]
        gains = [self._gain * math.log1p(number * (side / _VIEW_CELL) ** 2) for number in cells]
        return np.asarray(candidates.way[0, :count] - np.array(gains))


@register("distance_advantage", family="exploration")
class DistanceAdvantagePolicy(RuledExplorer):
    """Drives to what is near to it and far from the rest (Ericson, Pedro, Jensfelt 2025, "distance advantage").

    The score of a frontier v is the mean over the free cells u within ``radius`` of d(u, v) - d(robot, v), all by
    shortest ways in the known map, on cells of 0.2 m; the greatest is driven to: a frontier that it would be dear to
    come back to.
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
        check_lengths(radius=radius)
        super().__init__(env, persistence=persistence, min_frontier_size=min_frontier_size)
        self._settings = self._settings._replace(radius=float(radius))

    def _costs(self, explorers: Explorers, count: int) -> NDArray[np.float64]:
        costs: NDArray[np.float64] = -np.diagonal(explorers.candidates.between[0])[:count]
        return costs


@kernel
def _mark_ray(
    occupancy: NDArray[np.int8], row: int, column: int, angle: float, reach: float, seen: NDArray[np.bool_]
) -> None:
    """Mark the unknown cells along a ray from the middle of a cell, up to an occupied one or the map's end."""
    step_r, step_c = math.sin(angle), math.cos(angle)
    for k in range(1, int(reach) + 1):
        r, c = math.floor(row + 0.5 + k * step_r), math.floor(column + 0.5 + k * step_c)
        if r < 0 or c < 0 or r >= occupancy.shape[0] or c >= occupancy.shape[1] or occupancy[r, c] >= 50:
            return
        if occupancy[r, c] < 0:
            seen[r, c] = True


@kernel
def _visible(occupancy: NDArray[np.int8], row: int, column: int, reach: float) -> int:
    seen = np.zeros(occupancy.shape, np.bool_)
    rays = int(2.0 * math.pi * reach) + 8
    for k in range(rays):
        _mark_ray(occupancy, row, column, 2.0 * math.pi * k / rays, reach, seen)
    return int(seen.sum())


def visible_unknown(occupancy: NDArray[np.int8], cell: tuple[int, int], reach: float) -> int:
    """Count the unknown cells that no known wall hides from a cell.

    Args:
        occupancy: (rows, cols), -1 unknown, 0 free .. 100 occupied.
        cell: [row, column] of the view.
        reach: How far it sees, in cells.
    """
    count: int = _visible(np.ascontiguousarray(occupancy), cell[0], cell[1], reach)
    return count
