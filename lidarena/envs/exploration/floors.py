"""The floor plans of a batch of exploration worlds: fixed ones that worlds share, or a new one for every episode."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.envs.exploration.coverage import START_MARGIN, Coverage, check_start, measure_coverage
from lidarena.world.changing_lidar import ChangingLidar
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.load import MapSpec, generator_of, load_floorplan
from lidarena.world.plan_generators import PlanGenerator, draw_plan, generator_name, largest_size, size_of
from lidarena.world.robots import RobotSpec

_MARGIN = 0.5
"""How far the grid of a map reaches beyond its plan [m], see ``Floorplan.raster``."""
_DRAWN_START_MARGIN = 0.3
"""Random starts in drawn plans, which nobody has looked at, keep this far from every wall [m]."""


class Floors(Protocol):
    """Floor plans by index, and which of them a world has.

    Attributes:
        plans: By index.
        lidar: What sees them.
        wanted: (plans, rows, columns) uint8: 1 in K, what a robot can come to know of a plan.
        wanted_cells: (plans,) size of K.
        areas: (plans,) of the rectangles around them [m²].
    """

    plans: list[Floorplan]
    lidar: Lidar
    wanted: NDArray[np.uint8]
    wanted_cells: NDArray[np.int64]
    areas: NDArray[np.float64]

    def draw(self, world: int, rng: np.random.Generator) -> int:
        """Choose the plan of a world's next episode; returns its index."""

    def coverage(self, plan: int) -> Coverage:
        """What can be covered of a plan."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What says which plans there are, by name."""

    def restore(self) -> None:
        """Make the plans that the arrays say."""


def make_floors(
    worlds: int,
    specs: Sequence[MapSpec],
    start: Pose | None,
    lidar: LidarSpec,
    resolution: float,
    robot: RobotSpec,
    at_start: bool,
) -> Floors:
    """Make the floor plans of a batch.

    Args:
        worlds: Number of worlds.
        specs: Floor plans and generators of them, of which every episode draws one.
        start: Start pose instead of the plans' own.
        lidar: Of the robots.
        resolution: Side of a map cell [m].
        robot: The robots.
        at_start: Whether episodes begin at the plans' starts.

    Raises:
        ConfigError: A generator that there is not.
        MapError: A floor plan that cannot be used.
    """
    generators = [generator_of(spec) for spec in specs]
    fixed = [
        load_floorplan(spec, start=start) if generator is None else None
        for spec, generator in zip(specs, generators, strict=True)
    ]
    plans = [plan for plan in fixed if plan is not None]
    if len(plans) == len(specs):
        return FixedFloors(plans, lidar, resolution, robot, at_start)
    sources = [plan or generator for plan, generator in zip(fixed, generators, strict=True)]
    return DrawnFloors(worlds, sources, start, lidar, resolution, robot, at_start)


class FixedFloors:
    """Floor plans that never change, shared by all worlds; see ``Floors`` and ``make_floors``.

    Args:
        plans: The floor plans.
        lidar: Of the robots.
        resolution: Side of a cell [m].
        robot: Which has to get to what counts as reachable.
        at_start: Whether it begins at a plan's own start.
    """

    def __init__(
        self, plans: list[Floorplan], lidar: LidarSpec, resolution: float, robot: RobotSpec, at_start: bool
    ) -> None:
        self.plans, self.lidar = plans, Lidar(plans, lidar)
        self._coverage = [_measured(plan, resolution, robot, at_start) for plan in plans]
        self.wanted_cells = np.array([coverage.wanted.sum() for coverage in self._coverage])
        self.areas = np.array([_area(plan) for plan in plans])
        rows, columns = np.max([coverage.wanted.shape for coverage in self._coverage], axis=0)
        self.wanted = np.zeros((len(plans), rows, columns), np.uint8)
        for plan, coverage in enumerate(self._coverage):
            _write(self.wanted[plan], coverage)

    def draw(self, world: int, rng: np.random.Generator) -> int:
        """Choose the plan of a world's next episode; returns its index."""
        return int(rng.integers(len(self.plans))) if len(self.plans) > 1 else 0

    def coverage(self, plan: int) -> Coverage:
        """What can be covered of a plan."""
        return self._coverage[plan]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Nothing: the keywords say which plans there are."""
        return {}

    def restore(self) -> None:
        """Nothing changes."""


class DrawnFloors:
    """A floor plan for each world, another in every episode; see ``Floors`` and ``make_floors``.

    An episode draws a number from its world's generator; the plan is what the ``PlanGenerator`` makes of that number.
    So the number is all that there is to save, and how much chance a plan takes changes nothing else of the episode.
    All maps have room for the largest plan, whichever plans there are meanwhile.

    Args:
        worlds: How many.
        sources: What each world's plans come from; None where a world has none yet.
        start: Pose at the beginning, in place of a plan's own; None for that.
        lidar: See `FixedFloors`.
        resolution: See `FixedFloors`.
        robot: See `FixedFloors`.
        at_start: See `FixedFloors`.
    """

    def __init__(
        self,
        worlds: int,
        sources: Sequence[Floorplan | PlanGenerator | None],
        start: Pose | None,
        lidar: LidarSpec,
        resolution: float,
        robot: RobotSpec,
        at_start: bool,
    ) -> None:
        self._sources, self._start, self._resolution = sources, start, resolution
        self._robot, self._at_start = robot, at_start
        sizes = [size_of(one) if isinstance(one, Floorplan) else largest_size(one) for one in sources if one]
        self.size = max(width for width, _ in sizes), max(height for _, height in sizes)
        columns, rows = (int(np.ceil((side + 2 * _MARGIN) / resolution)) + 1 for side in self.size)
        self._changing = ChangingLidar(worlds, lidar)
        self.lidar: Lidar = self._changing
        self.plans: list[Floorplan] = []
        self._coverages: dict[int, Coverage] = {}
        self._drawn = np.full((worlds, 2), -1, np.int64)
        self.wanted = np.zeros((worlds, rows, columns), np.uint8)
        self.wanted_cells, self.areas = np.ones(worlds, np.int64), np.ones(worlds)

    def draw(self, world: int, rng: np.random.Generator) -> int:
        """Choose the plan of a world's next episode; returns its index, which is the world's."""
        source = int(rng.integers(len(self._sources))) if len(self._sources) > 1 else 0
        fixed = isinstance(self._sources[source], Floorplan)
        self._drawn[world] = source, 0 if fixed else rng.integers(2**63 - 1)
        self._lay(world)
        return world

    def _lay(self, world: int) -> None:
        source, number = self._drawn[world].tolist()
        maker: Any = self._sources[source]
        plan = maker if isinstance(maker, Floorplan) else self._drawn_plan(maker, number)
        while len(self.plans) <= world:
            self.plans.append(plan)
        coverage = _measured(plan, self._resolution, self._robot, self._at_start, _DRAWN_START_MARGIN)
        self.plans[world], self._coverages[world] = plan, coverage
        self.wanted[world] = 0
        _write(self.wanted[world], coverage)
        self.wanted_cells[world], self.areas[world] = coverage.wanted.sum(), _area(plan)
        self._changing.exchange(world, plan)

    def _drawn_plan(self, generator: PlanGenerator, number: int) -> Floorplan:
        plan = draw_plan(generator, number)
        (width, height), (most_width, most_height) = size_of(plan), self.size
        if width > most_width + 1e-6 or height > most_height + 1e-6:
            raise MapError(
                f"map generator {generator_name(generator)!r} drew a plan of {width:g} × {height:g} m; the largest "
                f"that it says is {most_width:g} × {most_height:g} m, see its attribute size"
            )
        return plan if self._start is None else plan.with_start(self._start)

    def coverage(self, plan: int) -> Coverage:
        """What can be covered of a plan."""
        return self._coverages[plan]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Which source each world's plan is of, and its number."""
        return {"drawn": self._drawn}

    def restore(self) -> None:
        """Make the plans that the arrays say."""
        for world, (source, _) in enumerate(self._drawn.tolist()):
            if source >= 0:
                self._lay(world)


def _measured(
    plan: Floorplan, resolution: float, robot: RobotSpec, at_start: bool, start_margin: float = START_MARGIN
) -> Coverage:
    if at_start:
        check_start(plan, robot)
    return measure_coverage(plan, resolution, robot, start_margin)


def _write(wanted: NDArray[np.uint8], coverage: Coverage) -> None:
    rows, columns = coverage.wanted.shape
    wanted[:rows, :columns] = coverage.wanted


def _area(plan: Floorplan) -> float:
    width, height = size_of(plan)
    return width * height
