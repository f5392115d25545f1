"""What can be said of a frontier before choosing one: numbers of the order of 1."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.baselines.exploration.driving import Terrain
from lidarena.planning.grid.frontiers import Frontier

CANDIDATES = 10
"""Places that are described: the nearest frontiers by way, and the start."""
NAMES = (
    "there",  # 1, or 0 where there is no such candidate and all the rest is 0
    "way",  # length of the way to it / 3 m
    "nearest",  # 1 for the nearest
    "size",  # / 3 m
    "turn",  # angle from the heading to the beginning of the way / pi
    "unknown",  # share of unknown cells within 1.5 m of it
    "pursued",  # 1 for the one that is driven to
    "apart",  # straight distance to the nearest other candidate / 3 m
    "remote",  # mean straight distance to the others / 3 m
    "age",  # how long ago the robot came within 2 m of it for the first time / 100 s, 0 if never
    "home",  # straight distance from where the robot started / 3 m
    "revisit",  # 1 for the start itself, which is known already: going there closes a loop
    "end",  # 1 for staying where it is, offered when no frontier is left: the exploration ends
    # the same for all:
    "uncertainty",  # log10 of D-optimality / 1e-4
    "mean",  # log10 of its geometric mean so far / 1e-4
    "elapsed",  # time / 100 s
)
"""The features, in their order."""
FEATURES = len(NAMES)
RULE = {"size": 6.0, "way": -0.7, "pursued": 1.5, "revisit": -2.0, "end": -2.5}
"""Weights of a sound rule to begin learning from: the largest, as ``frontier``, but rather near."""

_SIGHT, _BEEN, _LEG = 1.5, 2.0, 0.6  # (m)


@dataclass(frozen=True)
class Candidate:
    """A place to go to.

    Attributes:
        cell: [row, column] of the map.
        size: Of the frontier there [m]; 0 for the start.
        frontier: None for the start, and for staying.
        ends: Whether to stay here, and end.
    """

    cell: tuple[int, int]
    size: float = 0.0
    frontier: Frontier | None = None
    ends: bool = False


@dataclass(frozen=True)
class Certainty:
    """How certain the pose is.

    Attributes:
        now: D-optimality.
        mean: Its geometric mean since the start.
        elapsed: Time since the start [s].
    """

    now: float
    mean: float
    elapsed: float

    def features(self) -> tuple[float, float, float]:
        """The last three of ``NAMES``."""
        return math.log10(max(self.now, 1e-9) / 1e-4), math.log10(max(self.mean, 1e-9) / 1e-4), self.elapsed / 100.0


def describe(
    candidates: Sequence[Candidate],
    lengths: NDArray[np.float64],
    terrain: Terrain,
    pose: NDArray[np.float64],
    pursued: int | None,
    certainty: Certainty,
    track: NDArray[np.float64],
) -> NDArray[np.float32]:
    """Describe the candidates.

    Args:
        candidates: At most ``CANDIDATES``, at least one; the nearest first.
        lengths: (rows, columns) of the way to every cell of ``terrain`` [m].
        terrain: The map.
        pose: (3,) of the robot.
        pursued: Which one is driven to.
        certainty: Of the pose.
        track: (n, 2) where the robot has been, once a second, the start first.

    Returns:
        (CANDIDATES, FEATURES), see ``NAMES``.
    """
    goals = terrain.around.points(np.array([candidate.cell for candidate in candidates]))
    apart = np.hypot(*(goals[:, None] - goals[None]).transpose(2, 0, 1))
    features = np.zeros((CANDIDATES, FEATURES), np.float32)
    for i, candidate in enumerate(candidates):
        others = np.delete(apart[i], i)
        leg = beginning_of_way(lengths, candidate.cell, terrain) - pose[:2]
        turn = abs(math.remainder(math.atan2(leg[1], leg[0]) - pose[2], 2.0 * math.pi))
        been = np.flatnonzero(np.hypot(*(track - goals[i]).T) < _BEEN)
        features[i] = (
            1.0, min(lengths[candidate.cell], 60.0) / 3.0, float(i == 0), candidate.size / 3.0,
            turn / math.pi, _unknown_share(terrain, candidate.cell), float(i == pursued),
            min(others.min(initial=9.0), 9.0) / 3.0, (others.mean() if len(others) else 0.0) / 3,
            (len(track) - been[0]) / 100.0 if len(been) else 0.0, math.dist(goals[i], track[0]) / 3.0,
            float(candidate.frontier is None and not candidate.ends), float(candidate.ends),
            *certainty.features(),
        )  # fmt: skip
    return features


def beginning_of_way(lengths: NDArray[np.float64], cell: tuple[int, int], terrain: Terrain) -> NDArray[np.float64]:
    """Return the point (2,) x, y [m] that lies 0.6 m on the robot's way to a cell.

    Args:
        lengths: (rows, cols) of the way to every cell of ``terrain`` [m].
        cell: [row, column].
        terrain: The map.
    """
    point: NDArray[np.float64] = terrain.around.points(np.array([_first_leg(lengths, *cell, _LEG)]))[0]
    return point


def _unknown_share(terrain: Terrain, cell: tuple[int, int]) -> float:
    """Share of the disc of ``_SIGHT`` around a cell that is unknown; what lies beyond the map is."""
    reach = int(_SIGHT / terrain.around.resolution)
    rows, columns = np.ogrid[-reach : reach + 1, -reach : reach + 1]
    disc = rows**2 + columns**2 <= reach**2
    window = np.full(disc.shape, -1, np.int8)
    row, column = cell[0] - reach, cell[1] - reach
    low_r, low_c = max(row, 0), max(column, 0)
    part = terrain.occupancy[low_r : row + len(window), low_c : column + len(window)]
    window[low_r - row : low_r - row + part.shape[0], low_c - column : low_c - column + part.shape[1]] = part
    return float((window[disc] < 0).mean())


@kernel
def _first_leg(lengths: NDArray[np.float64], row: int, column: int, length: float) -> tuple[int, int]:
    """The cell that lies ``length`` on the way to a cell, found by going back along falling ``lengths``."""
    while lengths[row, column] > length:
        best_r, best_c = row, column
        for r in range(max(row - 1, 0), min(row + 2, lengths.shape[0])):
            for c in range(max(column - 1, 0), min(column + 2, lengths.shape[1])):
                if lengths[r, c] < lengths[best_r, best_c]:
                    best_r, best_c = r, c
        if best_r == row and best_c == column:
            break  # nothing leads there
        row, column = best_r, best_c
    return row, column
