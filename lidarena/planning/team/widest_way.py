"""How wide a robot may be on its way from one place to another, and where the way is narrowest."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from lidarena.planning.grid.grid_search import path_costs
from lidarena.world.floorplan import Floorplan

_HALVINGS = 12


def narrowest_place(
    plan: Floorplan, resolution: float, start: ArrayLike, goal: ArrayLike
) -> tuple[NDArray[np.float64], float] | None:
    """The narrowest place of the widest way between two points of a floor plan.

    Args:
        plan: The floor plan.
        resolution: Of the raster on which clearances are compared [m].
        start: x, y [m].
        goal: x, y [m].

    Returns:
        The place x, y [m] and twice its clearance, the width of the way there [m], to about the resolution; None where
        no way leads.
    """
    raster = plan.raster(resolution)
    room = np.where(raster.solid, 0.0, raster.clearance).astype(np.float64)
    ends = [_cell(raster.origin, resolution, point, room) for point in (start, goal)]
    low, high = 0.0, min(room[end] for end in ends)
    if not _connected(room > 0.0, ends):
        return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _connected(room >= middle, ends) else (low, middle)
    way = _way(path_costs(np.where(room >= low, 1.0, np.inf), ends[1]), ends[0])
    row, col = min(way, key=lambda cell: room[cell])
    place = np.asarray(raster.origin) + (np.array([col, row]) + 0.5) * resolution
    return place, 2.0 * float(room[row, col])


def _cell(origin: ArrayLike, resolution: float, point: ArrayLike, room: NDArray[np.float64]) -> tuple[int, int]:
    col, row = np.floor((np.asarray(point, np.float64) - np.asarray(origin)) / resolution).astype(int)
    return int(np.clip(row, 0, room.shape[0] - 1)), int(np.clip(col, 0, room.shape[1] - 1))


def _connected(free: NDArray[np.bool_], ends: list[tuple[int, int]]) -> bool:
    parts, _ = ndimage.label(free)
    return bool(parts[ends[0]] == parts[ends[1]] > 0)


def _way(lengths: NDArray[np.float64], cell: tuple[int, int]) -> list[tuple[int, int]]:
    """The cells from ``cell`` down to where ``lengths`` is 0."""
    way = [cell]
    while lengths[cell] > 0.0:
        row, col = cell
        around = [(r, c) for r in (row - 1, row, row + 1) for c in (col - 1, col, col + 1)]
        inside = [(r, c) for r, c in around if 0 <= r < lengths.shape[0] and 0 <= c < lengths.shape[1]]
        following = min(inside, key=lambda place: float(lengths[place]))
        if lengths[following] >= lengths[cell]:
            break
        cell = following
        way.append(cell)
    return way
