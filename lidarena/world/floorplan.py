"""Floor plans: the solid parts of a world as oriented edges and circles."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import MapError
from lidarena.base.jit import leaf
from lidarena.world.default_start import find_start
from lidarena.world.raster import Raster, rasterize

Pose = tuple[float, float, float]
Bounds = tuple[float, float, float, float]

START_CLEARANCE = 0.12
"""Metres between a start and the nearest wall below which the start counts as standing in a wall."""


@dataclass(frozen=True)
class Floorplan:
    """The solid parts of a world.

    Attributes:
        name: What messages and pictures call it.
        edges: Boundary of the solid parts, ``(E, 4)`` as x1, y1, x2, y2 [m]; walking from 1 to 2 has solid on the left.
        circles: Round pillars, ``(C, 3)`` as x, y, radius [m].
        bounds: Extent of the drawing, x_min, y_min, x_max, y_max [m].
        start: Default start pose (x, y, theta) [m, m, rad].
        parts: Where the start was looked for: areas of the parts between which there is no way for a robot, the largest
            first [m²]; the start is in the first.
    """

    name: str
    edges: NDArray[np.float64]
    circles: NDArray[np.float64]
    bounds: Bounds
    start: Pose
    parts: tuple[float, ...] = field(default=(), repr=False, compare=False)
    _rasters: dict[float, Raster] = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def from_shapes(
        cls,
        name: str,
        bounds: Bounds,
        walls: ArrayLike = (),
        polygons: Sequence[ArrayLike] = (),
        circles: ArrayLike = (),
        thickness: float = 0.1,
        start: Pose | None = None,
    ) -> Self:
        """Draw a floor plan from walls, polygons and circles.

        Args:
            name: What messages and pictures call it.
            bounds: x_min, y_min, x_max, y_max [m].
            walls: Centre lines ``(n, 4)`` as x1, y1, x2, y2 [m], drawn with square ends.
            polygons: Simple polygons ``(n, 2)``, solid inside, in either direction.
            circles: ``(n, 3)`` as x, y, radius [m].
            thickness: Of the walls [m].
            start: Default start pose; None takes the place farthest from every wall in the largest
                connected part.

        Raises:
            MapError: A shape is not finite or degenerate, or the start stands in a wall, or nothing is free.
        """
        lines = np.asarray(walls, dtype=np.float64).reshape(-1, 4)
        if not np.isfinite(lines).all():
            raise MapError(f"map {name!r} has a wall whose coordinates are not finite")
        rings = [_ring_edges(np.asarray(ring, dtype=np.float64).reshape(-1, 2)) for ring in polygons]
        edges = np.vstack([_wall_edges(lines, thickness), *rings])
        rounds = np.asarray(circles, dtype=np.float64).reshape(-1, 3)
        return cls._checked(name, edges, rounds, bounds, start)

    @classmethod
    def from_grid(
        cls,
        name: str,
        occupied: NDArray[np.bool_],
        resolution: float,
        origin: Pose = (0.0, 0.0, 0.0),
        start: Pose | None = None,
    ) -> Self:
        """Take the solid cells of a grid; runs of cell sides become long edges, everything outside is solid.

        Args:
            name: What messages and pictures call it.
            occupied: ``[row, column]``, row 0 at the smallest y.
            resolution: Side of a cell [m].
            origin: Pose x, y, yaw [m, m, rad] of the lower-left corner of cell [0, 0].
            start: Default start pose; None takes the place farthest from every wall in the largest
                connected part.

        Raises:
            MapError: No cell is free, or the start stands in a wall.
        """
        sides = _grid_sides(np.asarray(occupied, dtype=np.bool_)) * resolution
        x, y, yaw = origin
        turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
        edges = (sides.reshape(-1, 2) @ turn + (x, y)).reshape(-1, 4)
        if not len(edges):
            raise MapError(f"map {name!r} has no free space; at least one cell must be free")
        points = edges.reshape(-1, 2)
        low, high = points.min(axis=0), points.max(axis=0)
        bounds = (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
        return cls._checked(name, edges, np.empty((0, 3)), bounds, start)

    @classmethod
    def _checked(
        cls,
        name: str,
        edges: NDArray[np.float64],
        circles: NDArray[np.float64],
        bounds: Bounds,
        start: Pose | None,
    ) -> Self:
        if not (np.isfinite(edges).all() and np.isfinite(circles).all() and np.isfinite(bounds).all()):
            raise MapError(f"map {name!r} has a coordinate that is not finite")
        if bounds[2] <= bounds[0] or bounds[3] <= bounds[1]:
            raise MapError(f"map {name!r} has empty bounds {bounds}; x_min < x_max and y_min < y_max are needed")
        plan = cls(name, edges, circles, bounds, start if start is not None else (0.0, 0.0, 0.0))
        if start is None:
            return plan._with_default_start()
        return plan.with_start(start)

    def with_start(self, start: Pose) -> Self:
        """Return the same plan with another start.

        Raises:
            MapError: The start is not finite, lies outside the bounds or stands in a wall.
        """
        if np.shape(start) != (3,):
            raise MapError(f"start {start} is no pose; x, y in metres and theta in radians are needed")
        x, y, theta = (float(value) for value in start)
        if not np.isfinite([x, y, theta]).all():
            raise MapError(f"start {start} is not finite; give x, y in metres and theta in radians")
        inside = self.bounds[0] <= x <= self.bounds[2] and self.bounds[1] <= y <= self.bounds[3]
        clearance = self.clearance(np.array([[x, y]]))[0] if inside else -np.inf
        if clearance < START_CLEARANCE:
            where = f"{max(clearance, 0.0):.2f} m from the nearest wall" if inside else "outside the map"
            bounds = ", ".join(f"{side:g}" for side in self.bounds)
            raise MapError(
                f"start ({x:g}, {y:g}) stands in a wall of map {self.name!r} or {where}; "
                f"at least {START_CLEARANCE} m of clearance inside ({bounds}) is needed"
            )
        return replace(self, start=(x, y, float(np.arctan2(np.sin(theta), np.cos(theta)))))

    def clearance(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Distance from points to the nearest surface [m], negative inside a solid part.

        Args:
            points: ``(n, 2)``.
        """
        signed = np.empty(len(points))
        _measure_clearance(points, self.edges, self.circles, self._winding_outside, signed)
        return signed

    def raster(self, resolution: float, margin: float = 0.5) -> Raster:
        """Solid cells and clearance on a grid aligned with multiples of ``resolution`` (kept for the next call).

        Args:
            resolution: Side of a cell [m].
            margin: How far the grid reaches beyond the bounds [m].
        """
        if resolution not in self._rasters:
            low = np.floor((np.array(self.bounds[:2]) - margin) / resolution)
            high = np.ceil((np.array(self.bounds[2:]) + margin) / resolution)
            columns, rows = (high - low).astype(int)
            origin = low * resolution
            self._rasters[resolution] = rasterize(
                self.edges, self.circles, origin, resolution, (int(rows), int(columns)), self._winding_outside
            )
        return self._rasters[resolution]

    @property
    def _winding_outside(self) -> int:
        """Winding number of free space: 0 for drawn plans; -1 for grids, whose outermost ring encloses what is free."""
        area = np.sum(self.edges[:, 0] * self.edges[:, 3] - self.edges[:, 1] * self.edges[:, 2]) / 2
        return -1 if area < 0 else 0

    def _with_default_start(self) -> Self:
        """The same plan with the place farthest from every wall in the largest connected part as its start.

        Raises:
            MapError: A robot fits nowhere.
        """
        raster = self.raster(0.05 if max(self.bounds[2:]) - min(self.bounds[:2]) < 200 else 0.2)
        rows, columns = raster.solid.shape
        x = raster.origin[0] + (np.arange(columns) + 0.5) * raster.resolution
        y = raster.origin[1] + (np.arange(rows) + 0.5) * raster.resolution
        inside_x = (x > self.bounds[0]) & (x < self.bounds[2])
        inside_y = (y > self.bounds[1]) & (y < self.bounds[3])
        found = find_start(raster, inside_y[:, None] & inside_x[None, :], START_CLEARANCE)
        if not found.parts:
            raise MapError(f"map {self.name!r} has no free space with {START_CLEARANCE} m of clearance for the robot")
        return replace(self, start=(float(found.place[0]), float(found.place[1]), 0.0), parts=found.parts)


def _wall_edges(lines: NDArray[np.float64], thickness: float) -> NDArray[np.float64]:
    """Edges (4 n, 4) of the rectangles around centre lines (n, 4), counter-clockwise."""
    a, b = lines[:, :2], lines[:, 2:]
    length = np.hypot(b[:, 0] - a[:, 0], b[:, 1] - a[:, 1])[:, None]
    along = np.divide(b - a, length, out=np.tile([1.0, 0.0], (len(lines), 1)), where=length > 0.0) * (thickness / 2)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    a, b = a - along, b + along
    corners = np.stack([a - across, b - across, b + across, a + across], axis=1)
    return np.concatenate([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 4)


def _ring_edges(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """Edges (n, 4) of a polygon (n, 2), counter-clockwise."""
    following = np.concatenate([ring[1:], ring[:1]])
    if np.sum(ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]) <= 0:
        ring = ring[::-1]
        following = np.concatenate([ring[1:], ring[:1]])
    return np.hstack([ring, following])


@leaf
def _measure_clearance(
    points: NDArray[np.float64],
    edges: NDArray[np.float64],
    circles: NDArray[np.float64],
    winding_outside: int,
    signed: NDArray[np.float64],
) -> None:
    """Fill ``signed`` (n,) with the clearance of points (n, 2), see ``Floorplan.clearance``."""
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        away, winding = np.inf, 0
        for k in range(edges.shape[0]):
            x1, y1, x2, y2 = edges[k]
            ex, ey = x2 - x1, y2 - y1
            length = max(ex * ex + ey * ey, 1e-300)
            along = min(max(((x - x1) * ex + (y - y1) * ey) / length, 0.0), 1.0)
            away = min(away, math.hypot(x - x1 - along * ex, y - y1 - along * ey))
            side = ex * (y - y1) - ey * (x - x1)
            if y1 <= y < y2 and side > 0.0:
                winding += 1
            elif y2 <= y < y1 and side < 0.0:
                winding -= 1
        nearest = away if winding == winding_outside else -away
        for k in range(circles.shape[0]):
            gap = math.hypot(x - circles[k, 0], y - circles[k, 1]) - circles[k, 2]
            nearest = gap if abs(gap) < abs(nearest) else nearest
        signed[i] = nearest


def _grid_sides(occupied: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Sides between solid and free cells as merged runs ``(E, 4)`` in cells, solid on the left."""
    padded = np.pad(occupied, 1, constant_values=True)
    vertical = _runs(padded[1:-1].T)  # the boundary between columns c-1 and c, walked along the rows
    horizontal = _runs(padded[:, 1:-1])
    # solid before the boundary: walk up for vertical sides, but left (backwards) for horizontal ones
    rows = [(line, a, line, b) if before else (line, b, line, a) for line, a, b, before in vertical]
    rows += [(b, line, a, line) if before else (a, line, b, line) for line, a, b, before in horizontal]
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def _runs(layers: NDArray[np.bool_]) -> list[tuple[int, int, int, bool]]:
    """Runs (boundary index, first, last + 1, solid before?) of sides between neighbouring layers of cells."""
    change = layers[:-1].astype(np.int8) - layers[1:].astype(np.int8)  # +1: solid before, -1: solid after
    runs = []
    for sign in (1, -1):
        mask = np.pad(change == sign, ((0, 0), (1, 1))).astype(np.int8)
        step = np.diff(mask, axis=1)
        lines, firsts = np.nonzero(step == 1)
        _, lasts = np.nonzero(step == -1)
        runs += [(int(n), int(a), int(b), sign == 1) for n, a, b in zip(lines, firsts, lasts, strict=True)]
    return runs
