"""From an occupancy map to the cost of being somewhere: costmap_2d's inflation layer, in metres.

The robot is planned as a point: cells whose centre is nearer to an obstacle than ``lethal_radius`` are blocked, and
outside of that the cost decays from ``1 + weight`` to 1, so that a shortest path keeps off the walls where it can.
"""

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, suggest
from lidarena.base.jit import inlined, kernel, leaf

Decay = Literal["exponential", "linear"]

ESCAPE_BASE, ESCAPE_SLOPE = 2.0, 20.0  # in units of Inflation.weight: any detour inside is worth a way out


@dataclass(frozen=True)
class Inflation:
    """How far obstacles reach; lengths in metres.

    Attributes:
        lethal_radius: Cells with less clearance than this are blocked.
        radius: From this clearance on a cell costs 1.
        weight: Cost above 1 of a cell right at the lethal radius.
        decay: ``"exponential"`` as costmap_2d, ``1 + weight * exp(-rate * (clearance - lethal_radius))``, or
            ``"linear"`` from ``1 + weight`` at the lethal radius to 1 at ``radius``.
        rate: The exponential's rate (1/m); costmap_2d calls it ``cost_scaling_factor``, 10 by default.
        through_unknown: Whether unknown cells may be driven through. They never count as obstacles.
        occupied_from: Occupancy (0 .. 100) from which on a cell is an obstacle.
    """

    lethal_radius: float = 0.18
    radius: float = 0.55
    weight: float = 5.0
    decay: Decay = "exponential"
    rate: float = 10.0
    through_unknown: bool = False
    occupied_from: int = 50

    def __post_init__(self) -> None:
        """Refuse what has no meaning."""
        if not 0.0 <= self.lethal_radius <= self.radius < math.inf:
            raise ConfigError(
                f"inflation radii of {self.lethal_radius} (lethal) and {self.radius} m,"
                " allowed is 0 <= lethal_radius <= radius"
            )
        if not (0.0 <= self.weight < math.inf and 0.0 < self.rate < math.inf):
            raise ConfigError(
                f"inflation weight {self.weight} and rate {self.rate}, allowed are finite numbers >= 0 and > 0"
            )
        if self.decay not in get_args(Decay):
            raise ConfigError(f"unknown decay {self.decay!r}{suggest(str(self.decay), get_args(Decay))}")
        if not 1 <= self.occupied_from <= 100:
            raise ConfigError(f"occupied_from = {self.occupied_from}, allowed is 1 .. 100")


@leaf
def _pass_on(
    occupied: NDArray[np.int8], occupied_from: int, before: NDArray[np.int32], away: NDArray[np.int32]
) -> None:
    """Distances of a row's cells to what is occupied in it or, along the columns, in the rows ``before`` it."""
    for c in range(away.shape[0]):
        farther = np.int32(before[c] + np.int32(1))
        away[c] = np.int32(0) if occupied[c] >= occupied_from else min(away[c], farther)


@leaf
def _spread_along(padded: NDArray[np.int32], reach: int, squares: NDArray[np.int32]) -> None:
    """Squared distances of a row's cells (cols,), from those along the columns in the middle of ``padded``."""
    cols = squares.shape[0]
    for c in range(cols):
        padded[reach + c] = squares[c] = squares[c] * squares[c]
    for k in range(1, reach + 1):
        square, left, right = np.int32(k * k), padded[reach - k :], padded[reach + k :]
        for c in range(cols):
            squares[c] = min(squares[c], np.int32(min(left[c], right[c]) + square))


@leaf
def _measure(
    occupancy: NDArray[np.int8], occupied_from: int, reach: int, padded: NDArray[np.int32], squares: NDArray[np.int32]
) -> None:
    """Fill in the squares, whole rows at once, which processors do fastest."""
    rows = occupancy.shape[0]
    for r in range(rows):
        _pass_on(occupancy[r], occupied_from, squares[max(r - 1, 0)], squares[r])
    for r in range(rows - 2, -1, -1):
        _pass_on(occupancy[r], occupied_from, squares[r + 1], squares[r])
    for r in range(rows):
        _spread_along(padded, reach, squares[r])


@kernel
def squared_distances(occupancy: NDArray[np.int8], occupied_from: int, reach: int) -> NDArray[np.int32]:
    """Squared distance in cells of each cell of (rows, cols) to the nearest occupied one, at most (``reach`` + 1)².

    Exact: along the columns first, then over the rows the least sum of squares (whole numbers, so that the result is
    the same to the bit everywhere, which OpenCV's transform is not when its number of threads changes).
    """
    most = np.int32(reach + 1)
    squares = np.full(occupancy.shape, most, np.int32)
    padded = np.full(occupancy.shape[1] + 2 * reach, np.int32(most * most), np.int32)
    _measure(occupancy, occupied_from, reach, padded, squares)
    return squares


@kernel
def cell_distances(occupancy: NDArray[np.int8], occupied_from: int, reach: int) -> NDArray[np.float32]:
    """Distance in cells of each cell of (rows, cols) to the nearest occupied one, at most ``reach`` + 1."""
    return np.sqrt(squared_distances(occupancy, occupied_from, reach).astype(np.float32))


def clearance(
    occupancy: NDArray[np.int8], resolution: float, occupied_from: int = 50, reach: float = 1.0
) -> NDArray[np.float32]:
    """Return each cell's distance to the nearest obstacle, as far as it matters.

    Args:
        occupancy: (rows, cols), -1 unknown, 0 free .. 100 occupied.
        resolution: Side of a cell (m).
        occupied_from: Occupancy from which on a cell is an obstacle.
        reach: Distances up to this (m) are exact, larger ones are only known to be larger; the time grows with it.

    Returns:
        (rows, cols) metres from the centre of the cell to the border of the nearest occupied cell (Euclidean distance
        between the centres less half a cell); 0 inside obstacles.
    """
    cells = math.ceil(reach / resolution)
    distance = cell_distances(np.ascontiguousarray(occupancy, dtype=np.int8), occupied_from, cells)
    result: NDArray[np.float32] = np.maximum((distance - np.float32(0.5)) * np.float32(resolution), np.float32(0.0))
    return result


@inlined
def cost_at(distance: float, lethal_radius: float, radius: float, weight: float, rate: float) -> float:
    """Cost of a free cell with so much clearance [m]; ``rate`` <= 0 stands for the linear decay."""
    beyond = distance - lethal_radius
    if beyond < 0.0:
        return np.inf
    if distance >= radius:
        return 1.0
    if rate > 0.0:
        return 1.0 + weight * math.exp(-rate * beyond)
    return 1.0 + weight * max(1.0 - 1.0 / max(radius - lethal_radius, 1e-9) * beyond, 0.0)


@kernel
def cell_costs(
    occupancy: NDArray[np.int8],
    distance: NDArray[np.float32],
    lethal_radius: float,
    radius: float,
    weight: float,
    rate: float,
    through_unknown: bool,
    occupied_from: int,
) -> NDArray[np.float64]:
    """Costs of the cells (rows, cols); ``rate`` <= 0 stands for the linear decay."""
    cost = np.empty(occupancy.shape)
    for r in range(occupancy.shape[0]):
        for c in range(occupancy.shape[1]):
            unknown = occupancy[r, c] < 0 and not through_unknown
            closed = unknown or occupancy[r, c] >= occupied_from
            cost[r, c] = np.inf if closed else cost_at(distance[r, c], lethal_radius, radius, weight, rate)
    return cost


def inflate(
    occupancy: NDArray[np.int8],
    resolution: float,
    inflation: Inflation,
    distance: NDArray[np.float32] | None = None,
) -> NDArray[np.float64]:
    """Return the cost of each cell for :func:`lidarena.planning.grid.grid_search.find_path`.

    Args:
        occupancy: (rows, cols), -1 unknown, 0 free .. 100 occupied.
        resolution: Side of a cell (m).
        inflation: The parameters.
        distance: The map's :func:`clearance`, if it has been computed already.

    Returns:
        (rows, cols): inf where blocked, else between 1 and ``1 + inflation.weight``.
    """
    if distance is None:
        distance = clearance(occupancy, resolution, inflation.occupied_from, inflation.radius + resolution)
    cost: NDArray[np.float64] = cell_costs(
        np.ascontiguousarray(occupancy, dtype=np.int8),
        distance,
        inflation.lethal_radius,
        inflation.radius,
        inflation.weight,
        inflation.rate if inflation.decay == "exponential" else -1.0,
        inflation.through_unknown,
        inflation.occupied_from,
    )
    return cost


def open_start(
    cost: NDArray[np.float64],
    occupancy: NDArray[np.int8],
    distance: NDArray[np.float32],
    cell: tuple[int, int],
    reach: int,
    inflation: Inflation,
) -> None:
    """Let a robot out that stands in the lethal zone (an error of the pose, an obstacle seen late), in place.

    Nothing happens unless ``cell`` is blocked. Then the known cells around it that are merely too near to an obstacle
    become passable at a cost that falls steeply as clearance rises, so that the way out leads away from the wall.

    Args:
        cost: (rows, cols) from :func:`inflate`; changed.
        occupancy: (rows, cols) the map.
        distance: (rows, cols) its :func:`clearance` (m).
        cell: [row, column] of the robot.
        reach: Half the side of the square that is opened, in cells.
        inflation: The parameters ``cost`` was made with.
    """
    row, col = cell
    if math.isfinite(cost[row, col]):
        return
    window = (slice(max(row - reach, 0), row + reach + 1), slice(max(col - reach, 0), col + reach + 1))
    near, gap = cost[window], distance[window].astype(np.float64)
    opened = np.isinf(near) & (occupancy[window] >= 0) & (occupancy[window] < inflation.occupied_from)
    depth = np.maximum(inflation.lethal_radius - gap, 0.0) / max(inflation.lethal_radius, 1e-9)
    near[opened] = 1.0 + inflation.weight * (ESCAPE_BASE + ESCAPE_SLOPE * depth[opened])
