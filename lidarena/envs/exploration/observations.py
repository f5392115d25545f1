"""What an exploration agent sees: DA-SLAM's seven numbers, ranges all around, or a picture of the map around it."""

import math
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.jit import leaf
from lidarena.envs.exploration.actions import turning_radius
from lidarena.envs.exploration.clear_ways import WAY_EXTRAS, clear_ways
from lidarena.envs.exploration.free_arcs import ARCS, free_arcs
from lidarena.envs.exploration.frontier_directions import frontier_histogram, mean_direction
from lidarena.envs.exploration.scan_sectors import FRONT_ANGLES, SECTORS, ScanSectors, front_beams
from lidarena.envs.exploration.state import RESOLUTION, ExplorationCore
from lidarena.slam.registry import estimator_name
from lidarena.world.lidar import LidarSpec

PICTURE = 64
"""Rows and columns of the egocentric picture."""
PICTURE_CELL = 0.1
"""Side of one of its pixels [m]."""
LEAST_DEVIATION, DECADES = 1e-3, 4.0
"""Standard deviations of poses are observed from 1 mm or 1 mrad on, over so many powers of ten."""


class BatchObserver(Protocol):
    """Makes the observations of a batch."""

    space: gym.Space[Any]

    def observe(self, core: ExplorationCore, previous: NDArray[np.float64]) -> Any:
        """Fresh observations of all worlds, given what they did last as numbers in [0, 1] ``(worlds, k)``."""


class DaSlamObserver:
    """DA-SLAM's state s_t = [O_t, a_(t-1), r_(t-1)] (eq. 4).

    Five beams over the maximum range, the previous action (number over 2; continuous: both parts mapped to [0, 1]), and
    the completeness, or, as DA-SLAM has it beside its uncertainty reward, the entropy over ln N; every entry in [0, 1].

    Args:
        action_parts: Numbers that the previous action takes up.
        entropy: Whether the last entry is the entropy.
        lidar: Whose beams they are.

    Raises:
        ConfigError: The lidar has no such beams.
    """

    looks = len(FRONT_ANGLES)

    def __init__(self, action_parts: int, lidar: LidarSpec, entropy: bool = False) -> None:
        self._entropy = entropy
        self._attend(lidar)
        self.space: gym.Space[Any] = gym.spaces.Box(0.0, 1.0, (self.looks + action_parts + 1,), np.float32)

    def observe(self, core: ExplorationCore, previous: NDArray[np.float64]) -> NDArray[np.float32]:
        """``(worlds, looks + 1 + k)`` float32."""
        last = scaled_entropy(core) if self._entropy else core.completeness
        return np.concatenate([self._look(core), previous, last[:, None]], axis=1, dtype=np.float32)

    def _attend(self, lidar: LidarSpec) -> None:
        """Find out which beams to look at."""
        self._beams = front_beams(lidar)

    def _look(self, core: ExplorationCore) -> NDArray[np.float32]:
        """What is seen, in [0, 1], (worlds, looks)."""
        seen: NDArray[np.float32] = core.sensors.scans[:, 0, self._beams]
        return seen / core.beam.max_range


class SectorObserver(DaSlamObserver):
    """DA-SLAM's state with the nearest hit in each of ``SECTORS`` sectors in place of five single beams.

    Nothing fits between the beams of a sector, where DA-SLAM's five leave 45 degrees unseen. Sectors out of the lidar's
    view are 1, as without a hit.
    """

    looks = SECTORS

    def _attend(self, lidar: LidarSpec) -> None:
        self._sectors = ScanSectors(lidar)

    def _look(self, core: ExplorationCore) -> NDArray[np.float32]:
        return self._sectors.nearest_hits(core.sensors.scans[:, 0]) / core.beam.max_range


class FrontierHistogramObserver(SectorObserver):
    """DA-SLAM's state with walls as near as they are, and which way to drive, in place of five beams.

    First how near the nearest hit in each sector is, the range at which the robot's bumper touches over the range: a
    wall far off, which says little, hardly shows, whereas the range itself differs most there. Then how much of the
    map's edge each sector leads to, see ``frontier_histogram``, and their mean direction as
    (1 + cos) / 2 and (1 + sin) / 2.
    """

    looks = 2 * SECTORS + 2

    def _look(self, core: ExplorationCore) -> NDArray[np.float32]:
        nearest, touch = self._sectors.nearest_hits(core.sensors.scans[:, 0]), np.float32(core.robot.contact_distance)
        edge = frontier_histogram(core.maps.occupancy, core.maps.origin, core.estimate, nearest, RESOLUTION)
        near = touch / np.maximum(nearest, touch)
        return np.concatenate([near, edge, mean_direction(edge)], axis=1)


class FrontierArcsObserver(SectorObserver):
    """What a robot must know that can neither stop nor drive backwards: where it still has room to turn.

    How near the nearest hit in each sector is, as in ``FrontierHistogramObserver``; which way the map's edge lies on
    ways that keep clear of walls and furniture, see ``clear_ways``; and how far the robot could drive and turn before
    it touches what it sees, see ``free_arcs``.
    """

    looks = 2 * SECTORS + WAY_EXTRAS + ARCS

    def _look(self, core: ExplorationCore) -> NDArray[np.float32]:
        scans, touch = core.sensors.scans[:, 0], core.robot.contact_distance
        near = np.float32(touch) / np.maximum(self._sectors.nearest_hits(scans), np.float32(touch))
        radius = turning_radius(core.robot)
        ways = clear_ways(core.maps.occupancy, core.maps.origin, core.estimate, SECTORS, (touch, radius), RESOLUTION)
        arcs = free_arcs(scans, core.lidar.directions, core.beam.max_range, radius, touch)
        return np.concatenate([near, ways, arcs], axis=1)


class MapObserver:
    """A dictionary: ``map``, ``scan``, ``covariance``, ``state``.

    - ``map`` (3, 64, 64) uint8: 6.4 m × 6.4 m of the believed map around the believed pose, the robot in the middle,
      heading up; 255 where a pixel holds an occupied cell, a free cell, and no known cell at all (three channels).
    - ``scan`` (beams,) float32: all beams over the maximum range; see ``LidarSpec`` for where they point.
    - ``covariance`` (6,) float32, see ``scaled_covariance``: how uncertain the pose is.
    - ``state`` float32: previous action (as in DA-SLAM's observation), completeness, entropy over ln N.

    Args:
        action_parts: Numbers that the previous action takes up.
        beams: Of the lidar.
    """

    def __init__(self, action_parts: int, beams: int) -> None:
        self.space: gym.Space[Any] = gym.spaces.Dict(
            {
                "map": gym.spaces.Box(0, 255, (3, PICTURE, PICTURE), np.uint8),
                "scan": gym.spaces.Box(0.0, 1.0, (beams,), np.float32),
                "covariance": gym.spaces.Box(np.repeat(np.array([0.0, -1.0], np.float32), 3), np.ones(6, np.float32)),
                "state": gym.spaces.Box(0.0, 1.0, (action_parts + 2,), np.float32),
            }
        )

    def observe(self, core: ExplorationCore, previous: NDArray[np.float64]) -> dict[str, NDArray[Any]]:
        """Each entry with a leading axis of worlds."""
        picture = np.empty((core.worlds, 3, PICTURE, PICTURE), np.uint8)
        crop_maps(core.maps.occupancy, core.maps.origin, core.estimate, picture)
        last = np.stack([core.completeness, scaled_entropy(core)], axis=1)
        return {
            "map": picture,
            "scan": core.sensors.scans[:, 0] / np.float32(core.beam.max_range),
            "covariance": scaled_covariance(core.covariance),
            "state": np.concatenate([previous, last], axis=1).astype(np.float32),
        }


FLAT: dict[str, type[DaSlamObserver]] = {
    "da_slam": DaSlamObserver,
    "sectors": SectorObserver,
    "frontier_histogram": FrontierHistogramObserver,
    "frontier_arcs": FrontierArcsObserver,
}
ENTROPY = "_entropy"
"""End of the names of the same observations with the entropy in the last place."""


def make_observer(kind: str, action_parts: int, lidar: LidarSpec) -> BatchObserver:
    """Make what the keyword ``observation`` names, one of ``options.OBSERVATIONS``.

    Raises:
        ConfigError: The lidar does not see what it shows.
    """
    if kind == "map":
        return MapObserver(action_parts, lidar.beams)
    return FLAT[kind.removesuffix(ENTROPY)](action_parts, lidar, kind.endswith(ENTROPY))


def scaled_covariance(covariance: NDArray[np.float64]) -> NDArray[np.float32]:
    """Covariances of poses as numbers that a network can read, (worlds, 6).

    The standard deviations of x, y and θ as (log10 σ + 3) / 4, so that 1 mm or 1 mrad is 0, 10 m or 10 rad is 1, and
    each power of ten a quarter; then the correlations of x and y, x and θ, y and θ, from -1 to 1.

    Args:
        covariance: (worlds, 3, 3) [m, m, rad].
    """
    scaled = np.empty((len(covariance), 6), np.float32)
    scale_covariances(covariance, scaled)
    return scaled


@leaf
def scale_covariances(covariances: NDArray[np.float64], out: NDArray[np.float32]) -> None:
    """Write what ``scaled_covariance`` says.

    Args:
        covariances: (worlds, 3, 3) [m, m, rad].
        out: (worlds, 6) output.
    """
    for w in range(covariances.shape[0]):
        k = 3
        for i in range(3):
            deviation = math.sqrt(max(covariances[w, i, i], 0.0))
            out[w, i] = min(math.log10(max(deviation, LEAST_DEVIATION) / LEAST_DEVIATION) / DECADES, 1.0)
            for j in range(i + 1, 3):
                product = deviation * math.sqrt(max(covariances[w, j, j], 0.0))
                correlation = covariances[w, i, j] / product if product > 0.0 else 0.0
                out[w, k] = max(-1.0, min(correlation, 1.0))
                k += 1


def scaled_entropy(core: ExplorationCore) -> NDArray[np.float64]:
    """Entropy of what the estimator believes over its maximum, (worlds,) in [0, 1]; 0 where it has none."""
    entropy = core.estimator.scaled_entropy()
    return np.zeros(core.worlds) if entropy is None else entropy


def check_entropy(core: ExplorationCore) -> None:
    """Refuse an observation of the entropy where the estimator has none.

    Raises:
        ConfigError: It names the estimator.
    """
    if core.estimator.scaled_entropy() is None:
        raise ConfigError(
            f"slam = {estimator_name(core.options.slam)!r} has no entropy, which this observation holds; "
            "take one without '_entropy' in its name"
        )


@leaf
def crop_maps(
    occupancy: NDArray[np.int8], origins: NDArray[np.float64], poses: NDArray[np.float64], out: NDArray[np.uint8]
) -> None:
    """Draw the maps around the poses, heading up.

    Args:
        occupancy: (worlds, rows, columns) -1, 0, 100.
        origins: (worlds, 2) [m].
        poses: (worlds, 3).
        out: (worlds, 3, size, size) output, see ``MapObserver``.
    """
    size, half_cell = out.shape[2], 0.5 * RESOLUTION
    rows, columns = occupancy.shape[1:]
    for w in range(out.shape[0]):
        cos, sin = math.cos(poses[w, 2]), math.sin(poses[w, 2])
        for i in range(size):
            ahead = (0.5 * size - 0.5 - i) * PICTURE_CELL
            for j in range(size):
                left = (0.5 * size - 0.5 - j) * PICTURE_CELL
                x = poses[w, 0] + cos * ahead - sin * left - origins[w, 0]
                y = poses[w, 1] + sin * ahead + cos * left - origins[w, 1]
                wall = free = False
                for k in range(4):  # the four cells that a pixel of twice their size holds
                    c = math.floor((x + (half_cell if k & 1 else -half_cell)) / RESOLUTION)
                    r = math.floor((y + (half_cell if k & 2 else -half_cell)) / RESOLUTION)
                    if 0 <= r < rows and 0 <= c < columns:
                        wall = wall or occupancy[w, r, c] == 100
                        free = free or occupancy[w, r, c] == 0
                out[w, 0, i, j] = 255 if wall else 0
                out[w, 1, i, j] = 255 if free and not wall else 0
                out[w, 2, i, j] = 0 if wall or free else 255
