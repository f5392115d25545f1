"""Caves: a cellular automaton's free space, kept in one piece and wide enough, with slanted outlines."""

from collections.abc import Mapping

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.random_plans.options import draw_size

OPTIONS = {"rock": (0.3, 0.55), "passage": (0.6, 3.0)}
"""Share of rock before it is smoothed; least width of a passage [m]."""
_ROCK, _PASSAGE = 0.44, 0.8
_CELL = 0.2
_ROUNDS = 4
_LEAST_FREE = 0.3
"""A cave has at least this share of its area free."""
_TRIES = 40
_NEIGHBOURS = np.ones((3, 3), np.float32)


def random_cave(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a cave: cells become rock where most of their neighbours are (Johnson, Yannakakis & Togelius 2010).

    Raises:
        MapError: No cave comes out, as of too much rock or too wide passages in too small a plan.
    """
    width, height = draw_size(rng, options)
    shape = (max(int(height / _CELL), 3), max(int(width / _CELL), 3))
    wide = int(np.ceil(options.get("passage", _PASSAGE) / _CELL)) + 1  # outlines run through the cells' centres
    wide += 1 - wide % 2  # a square with a middle cell
    for _ in range(_TRIES):
        free = _passable(_smoothed(rng, shape, options.get("rock", _ROCK)), wide)
        if free.mean() >= _LEAST_FREE:
            edges = _outlines(free)
            return _plan(name, edges, (width, height), _start(rng, free, wide))
    raise MapError(
        f"no cave of {width:g} m x {height:g} m came out with rock {options.get('rock', _ROCK):g} and passages of "
        f"{options.get('passage', _PASSAGE):g} m; less of both, or a larger plan, is needed"
    )


def _smoothed(rng: np.random.Generator, shape: tuple[int, int], rock: float) -> NDArray[np.uint8]:
    """Free cells (rows, columns) after some rounds of the automaton; the rim is rock."""
    solid = (rng.random(shape) < rock).astype(np.float32)
    for _ in range(_ROUNDS):
        around = cv2.filter2D(solid, -1, _NEIGHBOURS, borderType=cv2.BORDER_CONSTANT)
        missing = cv2.filter2D(np.ones(shape, np.float32), -1, _NEIGHBOURS, borderType=cv2.BORDER_CONSTANT)
        solid = (around + (9.0 - missing) >= 5.0).astype(np.float32)
    solid[[0, -1]], solid[:, [0, -1]] = 1.0, 1.0
    return (1.0 - solid).astype(np.uint8)


def _passable(free: NDArray[np.uint8], wide: int) -> NDArray[np.uint8]:
    """What a square of ``wide`` cells can sweep without leaving the free space, from the largest part of its places."""
    closed = cv2.morphologyEx(free, cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))  # no specks of rock
    closed[[0, -1]], closed[:, [0, -1]] = 0, 0
    square = np.ones((wide, wide), np.uint8)
    places = _largest(np.asarray(cv2.erode(closed, square, borderValue=0), np.uint8))
    return np.asarray(cv2.dilate(places, square), np.uint8)


def _largest(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The largest part that hangs together by sides of cells."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(cells, connectivity=4)
    if count < 2:
        return np.zeros_like(cells)
    largest: NDArray[np.uint8] = (labels == 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))).astype(np.uint8)
    return largest


def _outlines(free: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Edges (n, 4) around the free space [m], solid on the left: its rim clockwise, rocks in it counter-clockwise."""
    contours, hierarchy = cv2.findContours(free, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    parts = []
    for contour, tree in zip(contours, hierarchy[0], strict=True):
        ring = cv2.approxPolyDP(contour, 0.6, True).reshape(-1, 2).astype(np.float64)
        if len(ring) < 3:
            continue
        following = np.roll(ring, -1, axis=0)
        area = float(np.sum(ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]))
        if (area > 0.0) != (tree[3] >= 0):
            ring = ring[::-1]
        ring = (ring + 0.5) * _CELL
        parts.append(np.hstack([ring, np.roll(ring, -1, axis=0)]))
    return np.vstack(parts)


def _start(rng: np.random.Generator, free: NDArray[np.uint8], wide: int) -> Pose:
    """A random roomy place with a random heading."""
    away = cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    cells = np.argwhere(away >= min(0.5 * wide, float(away.max())))
    row, column = cells[int(rng.integers(len(cells)))].tolist()
    return ((column + 0.5) * _CELL, (row + 0.5) * _CELL, float(rng.uniform(-np.pi, np.pi)))


def _plan(name: str, edges: NDArray[np.float64], size: tuple[float, float], start: Pose) -> Floorplan:
    points = edges.reshape(-1, 2)
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return Floorplan(name, edges, np.empty((0, 3)), (x0, y0, x1, y1), start).with_start(start)
