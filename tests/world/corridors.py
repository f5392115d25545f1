"""How wide a floor plan's free space is, measured on a fine raster by scipy (not by the package's own clearances)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from lidarena.world.floorplan import Floorplan

CELL = 0.02


class FreeSpace(NamedTuple):
    free: NDArray[np.bool_]  # inside the bounds
    distance: NDArray[np.float64]  # to the nearest solid cell's centre
    origin: NDArray[np.float64]

    def cell(self, x: float, y: float) -> tuple[int, int]:
        column, row = np.floor((np.array([x, y]) - self.origin) / CELL).astype(int)
        return int(row), int(column)


def free_space(plan: Floorplan) -> FreeSpace:
    raster = plan.raster(CELL)
    rows, columns = raster.solid.shape
    x = raster.origin[0] + (np.arange(columns) + 0.5) * CELL
    y = raster.origin[1] + (np.arange(rows) + 0.5) * CELL
    x1, y1, x2, y2 = plan.bounds
    free = ~raster.solid & ((y > y1) & (y < y2))[:, None] & ((x > x1) & (x < x2))[None, :]
    return FreeSpace(free, ndimage.distance_transform_edt(free) * CELL, raster.origin)


def count_parts(mask: NDArray[np.bool_]) -> int:
    return int(ndimage.label(mask)[1])


def share_swept_by_disc(space: FreeSpace, radius: float) -> float:
    """Which share of the free space a disc of this radius touches somewhere: all of it but the walls' corners."""
    centres = space.distance >= radius - CELL / 2
    swept = ndimage.distance_transform_edt(~centres) * CELL <= radius
    return float((swept & space.free).sum() / space.free.sum())
