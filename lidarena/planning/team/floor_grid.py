"""Grids for planners from floor plans in metres."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import TeamError
from lidarena.planning.team.grid_graph import GridGraph, grid_graph_of, near_blocked
from lidarena.world.extent import check_extent
from lidarena.world.floorplan import Floorplan

_ROUNDING = 1e-4  # clearances are single precision [m]
_BESIDE = 0.06  # a robot that is said to be in a wall is looked for so far around [m]


@dataclass(frozen=True)
class FloorGrid:
    """Blocked cells of a floor plan.

    Attributes:
        blocked: (rows, cols) bool, for ``plan_team``.
        origin: x, y of the lower-left corner of cell [0, 0] [m].
        resolution: Side of a cell [m].
        clearance: (rows, cols) distance from a cell's centre to the nearest wall [m], where robots are to be planned
            for by it; None: by the blocked cells, which may reach farther into a corridor than its walls.
        away: The same where they are planned for by the blocked cells: walls reach into cells that are not blocked, by
            up to half a side. None: not known.
    """

    blocked: NDArray[np.bool_]
    origin: tuple[float, float]
    resolution: float
    clearance: NDArray[np.float32] | None = None
    away: NDArray[np.float32] | None = None

    @classmethod
    def of(cls, plan: Floorplan, resolution: float = 0.2, exact: bool = False) -> "FloorGrid":
        """Lay a grid over a floor plan; a cell is blocked if its inner circle touches a wall or leaves the bounds.

        Args:
            plan: The floor plan.
            resolution: Side of a cell [m].
            exact: Whether robots are to be planned for by their clearance.

        Raises:
            TeamError: The resolution is not from 0.02 to 2 m.
            MapError: So fine a grid would have more cells than a map may have.
        """
        if not 0.02 <= resolution <= 2.0:
            raise TeamError(f"a resolution of {resolution} m is not possible; 0.02 to 2 m is")
        columns, rows = (math.ceil((plan.bounds[i + 2] - plan.bounds[i]) / resolution) for i in (0, 1))
        check_extent(f"the grid over map {plan.name!r}", rows, columns, resolution)
        raster = plan.raster(resolution)
        blocked = raster.solid | (raster.clearance < resolution / 2 - _ROUNDING)
        rows, cols = blocked.shape
        x = raster.origin[0] + (np.arange(cols) + 0.5) * resolution
        y = raster.origin[1] + (np.arange(rows) + 0.5) * resolution
        low_x, low_y, high_x, high_y = plan.bounds
        outside = ((y < low_y) | (y > high_y))[:, None] | ((x < low_x) | (x > high_x))[None, :]
        blocked |= outside
        clearance = np.where(raster.solid | outside, 0.0, raster.clearance).astype(np.float32)
        origin = float(raster.origin[0]), float(raster.origin[1])
        return cls(blocked, origin, resolution, *((clearance, None) if exact else (None, clearance)))

    def graph(
        self, radius: float, taken: NDArray[np.bool_] | None = None, closed: NDArray[np.bool_] | None = None
    ) -> GridGraph:
        """Where robots can stand and go, with 8 neighbours.

        Args:
            radius: Of every robot [m].
            taken: (rows, cols) cells that are blocked besides; None = none.
            closed: (rows, cols) cells on whose centres no robot is to be, whatever its radius; None = none.
        """
        if self.clearance is None:
            blocked = self.blocked if taken is None else self.blocked | taken
            if closed is None:
                return grid_graph_of(blocked, 8, self.in_cells(radius))
            near = near_blocked(blocked, self.in_cells(radius))
            return grid_graph_of(near | closed, 8, self.in_cells(radius), walls=0.0)
        closed = (self.clearance < radius - _ROUNDING) | (self.clearance <= 0.0)
        if taken is not None:
            closed |= near_blocked(taken, self.in_cells(radius))
        return grid_graph_of(closed, 8, self.in_cells(radius), walls=0.0)

    def standing(self, points: ArrayLike, graph: GridGraph) -> NDArray[np.int64]:
        """The cells (n, 2) of points, or the nearest ones within 6 cm of these in which a robot can stand.

        Localisation that is a few centimetres off puts a robot into the walls of a narrow corridor.
        """
        cells = self.cells(points)
        if self.clearance is None:
            return cells
        around_it = max(math.ceil(_BESIDE / self.resolution), 1)
        for i, point in enumerate(np.asarray(points, np.float64).reshape(-1, 2)):
            low = np.maximum(cells[i] - around_it, 0)
            high = np.minimum(cells[i] + around_it + 1, graph.index.shape)
            around = low + np.argwhere(graph.index[low[0] : high[0], low[1] : high[1]] >= 0)
            if graph.place(cells[i]) < 0 and len(around):
                cells[i] = around[np.argmin(np.hypot(*(self.points(around) - point).T))]
        return cells

    def cells(self, points: ArrayLike) -> NDArray[np.int64]:
        """The cells (n, 2) [row, column] of points (n, 2) x, y [m].

        Raises:
            TeamError: A point is outside of the grid.
        """
        xy = np.asarray(points, np.float64).reshape(-1, 2)
        found = np.floor((xy - self.origin) / self.resolution + 1e-9)[:, ::-1].astype(np.int64)
        for point, cell in zip(xy, found, strict=True):
            if not ((cell >= 0) & (cell < self.blocked.shape)).all():
                raise TeamError(f"the point ({point[0]:g}, {point[1]:g}) lies outside of the floor plan")
        return found

    def points(self, cells: ArrayLike) -> NDArray[np.float64]:
        """The centres (n, 2) x, y [m] of cells (n, 2) [row, column]."""
        centres: NDArray[np.float64] = np.asarray(cells, np.float64).reshape(-1, 2)[:, ::-1] + 0.5
        points: NDArray[np.float64] = centres * self.resolution + np.asarray(self.origin)
        return points

    def in_cells(self, metres: float) -> float:
        """A length in cells, such as a robot's radius for ``plan_team``."""
        return metres / self.resolution
