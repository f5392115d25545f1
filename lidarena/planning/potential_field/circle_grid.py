"""Grid A* among circles: what the potential fields are compared with, and the global path that guides one of them."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.jit import leaf
from lidarena.planning.grid.grid_search import find_path
from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.field_kernels import wall_gap
from lidarena.planning.potential_field.field_scene import FieldScene, make_scene

_CELL = 0.5
"""Side of a cell in Yang et al.'s 100 m room (m); other rooms have theirs to scale."""
_SAFE = 0.7072
"""A segment to a neighbouring cell's centre is free if both have so many cells of clearance, wherever circles are."""
_REFINEMENTS = 3
_SEARCHED = 3


@leaf
def _gaps(
    gaps: NDArray[np.float64],
    frame: NDArray[np.float64],
    discs: NDArray[np.float64],
    walls: NDArray[np.float64],
    reach: float,
) -> None:
    """Write each cell centre's distance to the nearest surface, at most ``reach``, into ``gaps`` (rows, cols)."""
    rows, cols = gaps.shape
    for r in range(rows):
        for c in range(cols):
            least = reach
            for side in range(4):
                least = min(
                    least, wall_gap(frame[0] + (c + 0.5) * frame[2], frame[1] + (r + 0.5) * frame[2], walls, side)
                )
            gaps[r, c] = least
    for i in range(discs.shape[0]):
        far = discs[i, 2] + reach
        if far < 0.0:
            continue
        low, high = (discs[i, 1] - far - frame[1]) / frame[2], (discs[i, 1] + far - frame[1]) / frame[2]
        left, right = (discs[i, 0] - far - frame[0]) / frame[2], (discs[i, 0] + far - frame[0]) / frame[2]
        for r in range(int(max(low, 0.0)), int(min(high + 1.0, float(rows)))):
            dy = frame[1] + (r + 0.5) * frame[2] - discs[i, 1]
            for c in range(int(max(left, 0.0)), int(min(right + 1.0, float(cols)))):
                dx = frame[0] + (c + 0.5) * frame[2] - discs[i, 0]
                gaps[r, c] = min(gaps[r, c], math.sqrt(dx * dx + dy * dy) - discs[i, 2])


def _frame(scene: FieldScene, cell: float) -> tuple[NDArray[np.float64], tuple[int, int]]:
    """x, y of the grid's corner and the side of a cell (3,); rows and columns."""
    low, high = scene.walls[:2], scene.walls[2:]
    if not np.isfinite(scene.walls).all():
        away = scene.discs[:, 2:] + 10.0 * cell
        low = np.vstack([scene.discs[:, :2] - away, scene.start - 10.0 * cell, scene.goal - 10.0 * cell]).min(axis=0)
        high = np.vstack([scene.discs[:, :2] + away, scene.start + 10.0 * cell, scene.goal + 10.0 * cell]).max(axis=0)
    cols, rows = np.maximum(np.ceil((high - low) / cell), 1).astype(int)
    return np.array([low[0], low[1], cell]), (int(rows), int(cols))


def _entry(
    scene: FieldScene, point: NDArray[np.float64], gaps: NDArray[np.float64], frame: NDArray[np.float64]
) -> tuple[int, int] | None:
    """The nearest free cell whose centre is in sight of a point."""
    column, row = np.floor((point - frame[:2]) / frame[2]).astype(int)
    cells = [
        (r, c)
        for r in range(max(row - _SEARCHED, 0), min(row + _SEARCHED + 1, gaps.shape[0]))
        for c in range(max(column - _SEARCHED, 0), min(column + _SEARCHED + 1, gaps.shape[1]))
        if gaps[r, c] > _SAFE * frame[2]
    ]
    centres = {(r, c): frame[:2] + (np.array([c, r]) + 0.5) * frame[2] for r, c in cells}
    blocker = np.zeros(1, np.int64)
    for cell, centre in sorted(centres.items(), key=lambda item: float(np.hypot(*(item[1] - point)))):
        if segment_is_free(*point, *centre, scene.discs, scene.walls, blocker):
            return cell
    return None


def grid_path(scene: FieldScene, cell: float, clearance: float = 0.0, weight: float = 0.0) -> NDArray[np.float64]:
    """Return the shortest way over a grid whose every segment is free, or nothing.

    Args:
        scene: The circles, start and goal.
        cell: Side of a cell (m).
        clearance: Cells with less than this cost more (m).
        weight: How much more a cell without any clearance costs.

    Returns:
        (n, 2) x, y (m) from the start to the goal; (0, 2) if there is none on this grid.
    """
    frame, shape = _frame(scene, cell)
    reach = max(clearance, 2.0 * cell)
    gaps = np.empty(shape)
    _gaps(gaps, frame, scene.discs, scene.walls, reach)
    ends = [_entry(scene, point, gaps, frame) for point in (scene.start, scene.goal)]
    if ends[0] is None or ends[1] is None:
        return np.empty((0, 2))
    lack = np.clip(1.0 - gaps / max(clearance, cell), 0.0, 1.0)
    cost = np.where(gaps > _SAFE * cell, 1.0 + weight * lack, np.inf)
    cells = find_path(cost, ends[0], ends[1])
    if not len(cells):
        return np.empty((0, 2))
    return np.vstack([scene.start, frame[:2] + (cells[:, ::-1] + 0.5) * cell, scene.goal])


def shortest_grid_path(scene: FieldScene, clearance: float = 0.0, weight: float = 0.0) -> NDArray[np.float64]:
    """Return :func:`grid_path` on the coarsest of three grids, each of half the cells' side, that has one."""
    for refinement in range(_REFINEMENTS):
        path = grid_path(scene, _CELL * scene.scale / 2**refinement, clearance, weight)
        if len(path):
            break
    return path


def astar_path(
    circles: ArrayLike,
    start: ArrayLike,
    goal: ArrayLike,
    robot_radius: float = 0.0,
    bounds: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Return A*'s path among circles, for comparison: shortest on a grid of 0.5 m in a 100 m room, finer if it must be.

    Args:
        circles: (K, 3) x, y, radius (m).
        start: x, y (m).
        goal: x, y (m).
        robot_radius: Radius of the robot (m).
        bounds: x_min, y_min, x_max, y_max of the room (m); None: the grid ends a little beyond the circles.

    Returns:
        (n, 2) x, y (m), free of collisions all along; (0, 2) if no way was found.

    Raises:
        MapError: As :func:`lidarena.planning.potential_field.field_scene.make_scene`.
    """
    return shortest_grid_path(make_scene(circles, start, goal, robot_radius, bounds))
