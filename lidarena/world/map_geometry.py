"""Floor plans laid out for the lidar: all edges and circles in a row, and by tile which of them can matter there."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel
from lidarena.world.floorplan import Floorplan

TILE = 1.0
"""Side of the tiles by which edges are looked up [m]."""


class MapGeometry(NamedTuple):
    """Floor plans laid out for the kernel; ``P`` plans, ``T`` tiles.

    Attributes:
        edges: (E, 4) x1, y1, x2, y2.
        circles: (C, 3) x, y, radius.
        first_tile: (P,) index of each plan's first tile.
        tile_origin: (P, 2) lower-left corner of each plan's tiles [m].
        tile_shape: (P, 2) rows, columns.
        tile_start: (T + 1,) where each tile's items begin in ``items``.
        items: Index of an edge, or E + index of a circle.
    """

    edges: NDArray[np.float64]
    circles: NDArray[np.float64]
    first_tile: NDArray[np.int64]
    tile_origin: NDArray[np.float64]
    tile_shape: NDArray[np.int64]
    tile_start: NDArray[np.int64]
    items: NDArray[np.int32]


def lay_out(plans: Sequence[Floorplan], max_range: float) -> MapGeometry:
    """Lay floor plans out for the kernel, for beams of up to ``max_range`` [m]."""
    edges = np.vstack([np.empty((0, 4)), *(plan.edges for plan in plans)])
    circles = np.vstack([np.empty((0, 3)), *(plan.circles for plan in plans)])
    starts, items, first_tile, origins, shapes = [np.zeros(1, np.int64)], [], [], [], []
    tiles = edge_offset = circle_offset = 0
    for plan in plans:
        # beyond a rim as wide as the range no edge matters: a robot that left the drawing still sees its walls
        low = np.floor((np.array(plan.bounds[:2]) - max_range) / TILE) * TILE
        columns, rows = (np.ceil((np.array(plan.bounds[2:]) + max_range - low) / TILE)).astype(int)
        found_edges = _tile_edges(plan.edges, low[0], low[1], int(rows), int(columns), max_range)
        found_circles = _tile_circles(plan.circles, low[0], low[1], int(rows), int(columns), max_range)
        tile = np.concatenate([found_edges[:, 0], found_circles[:, 0]])
        item = np.concatenate([found_edges[:, 1] + edge_offset, found_circles[:, 1] + circle_offset + len(edges)])
        order = np.argsort(tile, kind="stable")
        items.append(item[order].astype(np.int32))
        starts.append(np.cumsum(np.bincount(tile, minlength=int(rows * columns))) + starts[-1][-1])
        first_tile.append(tiles)
        origins.append(low)
        shapes.append((int(rows), int(columns)))
        tiles += int(rows * columns)
        edge_offset += len(plan.edges)
        circle_offset += len(plan.circles)
    return MapGeometry(
        edges,
        circles,
        np.array(first_tile, np.int64),
        np.array(origins, np.float64).reshape(-1, 2),
        np.array(shapes, np.int64).reshape(-1, 2),
        np.concatenate(starts).astype(np.int64),
        np.concatenate([np.empty(0, np.int32), *items]),
    )


@kernel
def _tile_edges(
    edges: NDArray[np.float64], x0: float, y0: float, rows: int, columns: int, max_range: float
) -> NDArray[np.int64]:
    """Pairs (tile, edge) ``(n, 2)`` where some point of the tile faces the edge's front within range."""
    pairs = [(0, 0) for _ in range(0)]
    half = TILE / 2
    reach = max_range + half * math.sqrt(2.0)
    for k in range(edges.shape[0]):
        x1, y1, x2, y2 = edges[k]
        ex, ey = x2 - x1, y2 - y1
        squared = max(ex * ex + ey * ey, 1e-300)
        first_row, last_row = _tiles_near(min(y1, y2) - reach, max(y1, y2) + reach, y0, rows)
        first_column, last_column = _tiles_near(min(x1, x2) - reach, max(x1, x2) + reach, x0, columns)
        for row in range(first_row, last_row + 1):
            cy = y0 + row * TILE + half
            for column in range(first_column, last_column + 1):
                cx = x0 + column * TILE + half
                t = min(max(((cx - x1) * ex + (cy - y1) * ey) / squared, 0.0), 1.0)
                if math.hypot(cx - x1 - t * ex, cy - y1 - t * ey) > reach:
                    continue
                side = ex * (cy - y1) - ey * (cx - x1)  # the front is where this is negative
                if side - half * (abs(ex) + abs(ey)) < 0.0:
                    pairs.append((row * columns + column, k))
    return _as_array(pairs)


@kernel
def _tile_circles(
    circles: NDArray[np.float64], x0: float, y0: float, rows: int, columns: int, max_range: float
) -> NDArray[np.int64]:
    """Pairs (tile, circle) ``(n, 2)`` where some point of the tile may be within range of the circle."""
    pairs = [(0, 0) for _ in range(0)]
    for k in range(circles.shape[0]):
        cx, cy, radius = circles[k]
        reach = max_range + radius + TILE * math.sqrt(0.5)
        first_row, last_row = _tiles_near(cy - reach, cy + reach, y0, rows)
        first_column, last_column = _tiles_near(cx - reach, cx + reach, x0, columns)
        for row in range(first_row, last_row + 1):
            for column in range(first_column, last_column + 1):
                if math.hypot(x0 + (column + 0.5) * TILE - cx, y0 + (row + 0.5) * TILE - cy) <= reach:
                    pairs.append((row * columns + column, k))
    return _as_array(pairs)


@inlined
def _tiles_near(low: float, high: float, origin: float, count: int) -> tuple[int, int]:
    """First and last of ``count`` tiles along an axis whose middles may lie from ``low`` to ``high``."""
    first, last = math.floor((low - origin) / TILE) - 1, math.floor((high - origin) / TILE) + 1
    return max(first, 0), min(last, count - 1)


@kernel
def _as_array(pairs: list[tuple[int, int]]) -> NDArray[np.int64]:
    found = np.empty((len(pairs), 2), dtype=np.int64)
    for i in range(len(pairs)):
        found[i, 0], found[i, 1] = pairs[i]
    return found
