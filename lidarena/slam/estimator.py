"""What a SLAM estimator is: the seam at which ``slam=`` replaces one by another.

There are two ways to write one. Plain NumPy, one world at a time: ``WorldEstimator``. Compiled, all worlds at once, as
the estimators of this package: ``BatchEstimator``.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import entry_point
from lidarena.slam.occupancy import OccupancyMaps, clear_map, empty_maps
from lidarena.slam.readings import ScanGeometry, Share
from lidarena.world.lidar import LidarSpec
from lidarena.world.odometry import OdometryNoise
from lidarena.world.sensors import Sensing

Floats = NDArray[np.float64]
Pass = Callable[..., None]


class ScanSpec(NamedTuple):
    """What the scans are that an estimator is given.

    Attributes:
        angles: (beams,) direction of each beam from straight ahead, counter-clockwise [rad].
        max_range: A range from here on is no return [m].
        noise: Standard deviation of a range [m].
        min_range: Beams that would measure less report 0 [m].
    """

    angles: NDArray[np.float64]
    max_range: float
    noise: float
    min_range: float = 0.0


class MapGrid(NamedTuple):
    """The grid of the map that an estimator makes, ``[row, column]``, row 0 at the smallest y.

    Attributes:
        origin: (2,) its lower-left corner [m].
        resolution: Side of a cell [m].
        shape: Rows and columns.
    """

    origin: NDArray[np.float64]
    resolution: float
    shape: tuple[int, int]


class WorldEstimator(Protocol):
    """An estimator of one's own, in plain NumPy, for one world at a time.

    ``slam=`` takes what makes one when it is called with a ``ScanSpec`` (and options, see ``lidarena.slam.registry``):
    mostly its class. One is made for each world of a batch, and none is ever called on two threads at once.

    Nothing random but from ``rng``: a ``reset`` that has a third parameter of this name is given a
    ``numpy.random.Generator`` of the episode's own; same seed, same bits.

    If it can be saved, so that training can be resumed exactly, it has two methods more: ``get_state() -> dict`` of
    arrays by name, and ``set_state(dict)``, which is called after ``reset`` and continues from them. Without these,
    ``get_state`` of the environment is refused.

    Attributes:
        pose: (3,) x, y [m] and heading [rad], in the frame of the pose given to ``reset``.
        covariance: (3, 3) of it [m², m rad, rad²]. What everybody reads is this plus ``COVARIANCE_FLOOR`` on the
            diagonal, as for the package's own, so that no pose is perfectly certain.
        map: (rows, columns) integers: -1 unknown, 0 free, 100 occupied.
    """

    pose: NDArray[np.float64]
    covariance: NDArray[np.float64]
    map: NDArray[np.int8]

    def reset(self, pose: NDArray[np.float64], grid: MapGrid) -> None:
        """Begin an episode at ``pose`` (3,) with an unknown map on ``grid``; the first ``update`` follows at once."""

    def update(self, odometry: NDArray[np.float64], scan: NDArray[np.float32], time: float) -> None:
        """Take in what was measured in one decision period.

        Args:
            odometry: (3,) measured motion dx, dy [m], dtheta [rad] since the last update, in the robot's frame then;
                zero in the first update of an episode.
            scan: (beams,) ranges measured after it [m]. A range of 0 says nothing: between two scans of a lidar that is
                slower than the decisions all are 0.
            time: Since the episode began [s]; 0 in its first update.
        """


class EstimatorSettings(NamedTuple):
    """What a batch of estimators is made for.

    Attributes:
        worlds: How many.
        wanted: (plans, rows, columns) uint8: 1 where a known cell counts as covered; its shape is that of every map.
        directions: (2, beams) cos and sin of the beams' angles.
        lidar: The lidar.
        resolution: Side of a cell [m].
        noise: gmapping's motion noise, as far as an estimator should believe it.
    """

    worlds: int
    wanted: NDArray[np.uint8]
    directions: NDArray[np.float64]
    lidar: LidarSpec
    resolution: float
    noise: OdometryNoise


class BatchEstimator(ABC):
    """A batch of estimators, one a world; ``slam=`` takes a class that is made of it, too.

    Sensing and estimating are one pass: every thread calls ``sense_and_estimate``, in which a kernel takes world after
    world from a shared counter (``lidarena.base.jit.take_next``), reads its sensors (``sense``) and estimates while the
    scan is in the cache. The arrays are allocated once and written to in place.

    Args:
        settings: What it is made for. A subclass's options are keyword-only.

    Attributes:
        settings: As given.
        maps: The believed maps and how much they cover.
        estimate: (worlds, 3) believed poses.
        covariance: (worlds, 3, 3) of them.
        d_optimality: (worlds,) of the covariances.
        particles: (worlds, N, 3) poses, to be drawn; None where there are none.
        restorable: Whether it can be saved by ``arrays``.
    """

    restorable: bool = True
    particles: NDArray[np.float64] | None = None
    _sensing: Sensing | None = None
    _pass: Pass

    def __init__(self, settings: EstimatorSettings) -> None:
        self.settings = settings
        self.maps: OccupancyMaps = empty_maps(settings.worlds, settings.wanted)
        self.estimate = np.zeros((settings.worlds, 3))
        self.covariance = np.zeros((settings.worlds, 3, 3))
        self.d_optimality: NDArray[np.float64] = np.zeros(settings.worlds)

    def start(self, world: int, plan: int, origin: Floats, pose: Floats, rng: np.random.Generator) -> None:
        """Begin an episode in one world; the next pass brings its first scan.

        Args:
            world: Which one.
            plan: Which of ``settings.wanted`` it covers.
            origin: (2,) lower-left corner of its map [m].
            pose: (3,) where the robot stands, in the frame of everything that follows.
            rng: The world's own generator.
        """
        clear_map(self.maps, world, plan, origin)
        self.estimate[world] = pose

    @cached_property
    def geometry(self) -> ScanGeometry:
        """How its scans and grids are laid out."""
        settings = self.settings
        return ScanGeometry(settings.directions, settings.lidar.max_range, settings.resolution)

    @abstractmethod
    def sense_and_estimate(self, sensing: Sensing, share: Share) -> None:
        """Sense and estimate in the worlds of a thread's share; runs on every thread at once."""

    def _pass_of(self, function: Pass, arguments: tuple[Any, ...]) -> Pass:
        """Return what calls a kernel with such arguments, faster than the kernel itself from the second time on.

        Args:
            function: The same one on every call.
            arguments: Its arguments: what is sensed, the share, and arrays of the estimator's own, whose types never
                change.
        """
        if self._sensing is not arguments[0]:
            self._pass = entry_point(function, *arguments)
            self._sensing = arguments[0]  # last: other threads look at it first
        return self._pass

    def finish(self, sensing: Sensing, first: int, last: int, active: NDArray[np.bool_]) -> None:  # noqa: B027
        """Do in the ``active`` of worlds ``first`` … ``last`` - 1 what must not run on threads; here nothing."""

    def scaled_entropy(self) -> NDArray[np.float64] | None:
        """Entropy of the belief over the largest it could have, (worlds,) in [0, 1]; None where there is none."""
        return None

    def infos(self) -> dict[str, NDArray[Any]]:
        """What this estimator alone can tell, (worlds, …) by name, for ``info``; here nothing."""
        return {}

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name.

        Raises:
            EstimatorError: It cannot be saved.
        """
        belief = {"estimate": self.estimate, "covariance": self.covariance, "d_optimality": self.d_optimality}
        return map_arrays(self.maps) | belief

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another batch that was made for the same."""
        for name, array in self.arrays().items():
            array[...] = saved[name]


def map_arrays(maps: OccupancyMaps) -> dict[str, NDArray[Any]]:
    """What later steps depend on of the maps, by name."""
    return {f"maps.{name}": array for name, array in maps._asdict().items() if name != "wanted"}
