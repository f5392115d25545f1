"""Grids for planners from floor plans in metres."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import TeamError
from lidarena.world.floorplan import Floorplan


@dataclass(frozen=True)
class FloorGrid:
    """Blocked cells of a floor plan.

    Attributes:
        blocked: (rows, cols) bool, for ``plan_team``.
        origin: x, y of the lower-left corner of cell [0, 0] [m].
        resolution: Side of a cell [m].
    """

    blocked: NDArray[np.bool_]
    origin: tuple[float, float]
    resolution: float

    @classmethod
    def of(cls, plan: Floorplan, resolution: float = 0.2) -> "FloorGrid":
        """Lay a grid over a floor plan; a cell is blocked if its inner circle touches a wall or leaves the bounds.

        Args:
            plan: The floor plan.
            resolution: Side of a cell [m].

        Raises:
            TeamError: The resolution is not from 0.02 to 2 m.
        """
        if not 0.02 <= resolution <= 2.0:
            raise TeamError(f"a resolution of {resolution} m is not possible; 0.02 to 2 m is")
        raster = plan.raster(resolution)
        slack = 1e-4  # clearances are single precision
        blocked = raster.solid | (raster.clearance < resolution / 2 - slack)
        rows, cols = blocked.shape
        x = raster.origin[0] + (np.arange(cols) + 0.5) * resolution
        y = raster.origin[1] + (np.arange(rows) + 0.5) * resolution
        low_x, low_y, high_x, high_y = plan.bounds
        blocked |= ((y < low_y) | (y > high_y))[:, None] | ((x < low_x) | (x > high_x))[None, :]
        return cls(blocked, (float(raster.origin[0]), float(raster.origin[1])), resolution)

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
