"""How right the final map is, against the floor plan."""

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration.coverage import measure_coverage
from lidarena.world.floorplan import Floorplan
from lidarena.world.physics import RobotSpec

_WITHIN_ONE = np.ones((3, 3), np.uint8)


def map_iou(plan: Floorplan, occupancy: NDArray[np.int8], origin: NDArray[np.float64], resolution: float) -> float:
    """Return the intersection over union of the occupied cells, where one cell off still counts as met.

    Wanted are the wall cells that border what the robot can reach (``measure_coverage``): no robot can map the others.
    A wanted cell is met if an occupied cell lies within one cell of it, an occupied cell if any wall does.

    Args:
        plan: The truth.
        occupancy: (rows, columns), -1 / 0 / 100, in the plan's frame.
        origin: (2,) lower-left corner of cell [0, 0] [m].
        resolution: Side of a cell [m].

    Returns:
        Wanted cells that were met, over these, the wanted ones that were missed and the occupied ones that no wall is
        near to. NaN if nothing is wanted.
    """
    coverage, solid = measure_coverage(plan, resolution, RobotSpec().radius), plan.raster(resolution).solid
    believed = _on_grid(occupancy >= 50, origin, coverage.origin, solid.shape, resolution)
    wanted = coverage.wanted & solid
    met = int((wanted & _widened(believed)).sum())
    invented = int((believed & ~_widened(solid)).sum())
    union = int(wanted.sum()) + invented
    return met / union if union else float("nan")


def _widened(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """``cells`` and their eight neighbours."""
    widened: NDArray[np.bool_] = cv2.dilate(cells.astype(np.uint8), _WITHIN_ONE).astype(bool)
    return widened


def _on_grid(
    cells: NDArray[np.bool_],
    origin: NDArray[np.float64],
    target: NDArray[np.float64],
    shape: tuple[int, ...],
    resolution: float,
) -> NDArray[np.bool_]:
    """``cells`` moved to the grid of ``shape`` whose corner is ``target``; what lies outside is lost."""
    moved = np.zeros(shape, np.bool_)
    rows, columns = np.nonzero(cells)
    column_shift, row_shift = np.rint((np.asarray(origin) - target) / resolution).astype(int)
    rows, columns = rows + row_shift, columns + column_shift
    inside = (rows >= 0) & (rows < shape[0]) & (columns >= 0) & (columns < shape[1])
    moved[rows[inside], columns[inside]] = True
    return moved
