"""How long the ways between obstacles are for a given clearance, without walking any: from the gaps of neighbours.

Neighbours are those of the Delaunay triangulation of the obstacles. A way crosses its edges where the gap between the
two discs is wide enough, and lies in its triangles in between. It is measured, not checked: a disc much larger than its
neighbours may stand in a triangle's way, which a planner notices.
"""

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import Delaunay

from lidarena.planning.potential_field.field_scene import FieldScene
from lidarena.planning.potential_field.regression_search import path_length

_WALL_POINTS = 9
"""Points that stand for each wall, its ends among them, beside those opposite to discs nearby."""
_NEARBY = 0.1
"""Discs nearer to a wall than this share of the room's side have a point of it opposite to them."""
_RING = 12
"""Points around all that there is where there is no room; they are no obstacles."""
_TINY = 1e-12
"""Added to lengths, since a sparse graph may take an edge of length 0 for none (m)."""
_PAIRS = ((0, 1), (1, 2), (2, 0))


class _Corners(NamedTuple):
    """What is triangulated.

    Attributes:
        points: (P, 2) the discs' centres first (m).
        walls: (P,) bits of the walls that a point lies on, 0 for discs and the ring.
        solid: (P,) False on the ring.
    """

    points: NDArray[np.float64]
    walls: NDArray[np.int64]
    solid: NDArray[np.bool_]


class GapGraph:
    """The gaps of a scene.

    Args:
        scene: Its obstacles have grown by the robot's radius.
    """

    def __init__(self, scene: FieldScene) -> None:
        self._scene = scene
        self._corners = _in_room(scene) if np.isfinite(scene.walls).all() else _in_the_open(scene)

    @cached_property
    def _mesh(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Edges (E, 2) by points, triangles (T, 3) by edges, and the triangles (2,) of start and goal."""
        mesh = Delaunay(self._corners.points)
        sides = np.sort(np.concatenate([mesh.simplices[:, pair] for pair in _PAIRS]).astype(np.int64), axis=1)
        edges, triangles = np.unique(sides, axis=0, return_inverse=True)
        corners = self._corners.points[mesh.simplices]
        ends = np.array([_around(point, corners) for point in (self._scene.start, self._scene.goal)])
        return edges, triangles.reshape(3, -1).T, ends

    def way(self, clearance: float, in_the_middle: bool = False) -> NDArray[np.float64]:
        """Return the shortest way from start to goal that keeps a clearance.

        Args:
            clearance: From every obstacle, as :meth:`FieldScene.keeping` takes it (m).
            in_the_middle: Cross gaps in their middles only, which is longer but seldom touches an obstacle in between.

        Returns:
            (n, 2) its corners (m); (0, 2) if there is none.
        """
        if not len(self._scene.discs):
            return np.vstack([self._scene.start, self._scene.goal])
        _, triangles, ends = self._mesh
        if (ends < 0).any():
            return np.empty((0, 2))
        places, wide = self._crossings(clearance)
        if in_the_middle:
            places[:] = 0.5 * (places[:, :1] + places[:, 2:])
        count = 3 * len(wide)
        links = [_linked(triangles, wide)]
        for k, end in enumerate(ends):
            beside = 3 * triangles[end][wide[triangles[end]]][:, None] + np.arange(3)
            links.append((np.full(beside.size, count + k), beside.ravel()))
        if ends[0] == ends[1]:
            links.append((np.array([count]), np.array([count + 1])))
        rows, columns = (np.concatenate([link[k] for link in links]) for k in (0, 1))
        nodes = np.vstack([places.reshape(-1, 2), self._scene.start, self._scene.goal])
        lengths = np.hypot(*(nodes[rows] - nodes[columns]).T) + _TINY
        graph = coo_array((lengths, (rows, columns)), shape=(count + 2, count + 2)).tocsr()
        _, befores = dijkstra(graph, directed=False, indices=[count], return_predecessors=True)
        before, chain = befores[0], [count + 1]
        while before[chain[-1]] >= 0:
            chain.append(before[chain[-1]])
        return nodes[chain[::-1]] if chain[-1] == count else np.empty((0, 2))

    def way_length(self, clearance: float) -> float:
        """Return how long :meth:`way` is (m); inf if there is none."""
        found = self.way(clearance)
        return path_length(found) if len(found) else math.inf

    def _crossings(self, clearance: float) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Where each edge may be crossed (E, 3, 2): beside either end, and nearest to the straight line; if at all."""
        edges, scene, corners = self._mesh[0], self._scene, self._corners
        kept = scene.keeping(clearance)
        margins = np.zeros(len(corners.points))
        margins[: len(kept.discs)] = kept.discs[:, 2]
        drawn_in = np.abs(kept.walls - scene.walls) if np.isfinite(scene.walls).all() else np.zeros(4)
        for side in range(4):
            on = corners.walls & (1 << side) > 0
            margins[on] = np.maximum(margins[on], drawn_in[side])
        first, second = corners.points[edges[:, 0]], corners.points[edges[:, 1]]
        lengths = np.maximum(np.hypot(*(second - first).T), _TINY)
        low, high = margins[edges[:, 0]] / lengths, 1.0 - margins[edges[:, 1]] / lengths
        along_wall = corners.walls[edges[:, 0]] & corners.walls[edges[:, 1]] > 0
        wide = (high >= low) & ~along_wall & corners.solid[edges].any(axis=1)
        shares = np.stack([low, np.clip(_straight(scene, first, second), low, np.maximum(low, high)), high], axis=1)
        return first[:, None] + shares[..., None] * (second - first)[:, None], wide


def _around(point: NDArray[np.float64], triangles: NDArray[np.float64]) -> int:
    """Which of the triangles (T, 3, 2), given in either direction, a point is deepest in; -1: none."""
    x, y = (triangles - point).transpose(2, 0, 1)
    turns = np.stack([x[:, i] * y[:, j] - x[:, j] * y[:, i] for i, j in _PAIRS])
    inside = np.maximum(turns.min(axis=0), -turns.max(axis=0))
    deepest = int(np.argmax(inside))
    return deepest if inside[deepest] >= 0.0 else -1


def _straight(scene: FieldScene, first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """At which share (E,) of each edge it meets the line through start and goal; ½ where it is parallel to it."""
    along = scene.goal - scene.start
    before, behind = (
        along[0] * (ends[:, 1] - scene.start[1]) - along[1] * (ends[:, 0] - scene.start[0]) for ends in (first, second)
    )
    spread = before - behind
    parallel = np.abs(spread) < _TINY
    return np.where(parallel, 0.5, before / np.where(parallel, 1.0, spread))


def _linked(triangles: NDArray[np.int64], wide: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which crossings see each other: all of two edges of a triangle that are wide enough."""
    rows, columns = [], []
    for one, other in _PAIRS:
        open_ = triangles[wide[triangles[:, one]] & wide[triangles[:, other]]]
        for i in range(3):
            for j in range(3):
                rows.append(3 * open_[:, one] + i)
                columns.append(3 * open_[:, other] + j)
    return np.concatenate(rows), np.concatenate(columns)


def _in_room(scene: FieldScene) -> _Corners:
    """The discs, and points on the four walls."""
    low, high = scene.walls[:2], scene.walls[2:]
    reach = _NEARBY * float((high - low).max())
    inside = scene.discs[((scene.discs[:, :2] > low) & (scene.discs[:, :2] < high)).all(axis=1), :2]
    points, walls = [scene.discs[:, :2]], [np.zeros(len(scene.discs), np.int64)]
    on_walls = []
    for side in range(4):
        axis = side % 2
        near = inside[np.abs(inside[:, axis] - scene.walls[side]) < reach, 1 - axis]
        along = np.concatenate([np.linspace(low[1 - axis], high[1 - axis], _WALL_POINTS), near])
        places = np.empty((len(along), 2))
        places[:, axis], places[:, 1 - axis] = scene.walls[side], along
        on_walls.append(places)
    places = np.unique(np.vstack(on_walls), axis=0)
    bits = np.zeros(len(places), np.int64)
    for side in range(4):
        bits |= (places[:, side % 2] == scene.walls[side]).astype(np.int64) << side
    points.append(places)
    walls.append(bits)
    joined = np.vstack(points)
    return _Corners(joined, np.concatenate(walls), np.ones(len(joined), np.bool_))


def _in_the_open(scene: FieldScene) -> _Corners:
    """The discs, and a ring around them, start and goal."""
    everything = np.vstack([scene.discs[:, :2], scene.start, scene.goal])
    low, high = everything.min(axis=0), everything.max(axis=0)
    widest = float(scene.discs[:, 2].max()) if len(scene.discs) else 0.0
    radius = float(np.hypot(*(high - low))) + 2.0 * widest
    angles = np.arange(_RING) * (2.0 * math.pi / _RING) + 0.1
    ring = 0.5 * (low + high) + max(radius, _TINY) * np.column_stack([np.cos(angles), np.sin(angles)])
    points = np.vstack([scene.discs[:, :2], ring])
    return _Corners(points, np.zeros(len(points), np.int64), np.arange(len(points)) < len(scene.discs))
