"""Caves: a cellular automaton's free space, rounded, kept in one piece and wide enough."""

from collections.abc import Mapping

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.random_plans.options import draw_size

OPTIONS = {"rock": (0.3, 0.55), "passage": (0.6, 3.0)}
"""Share of rock before it is smoothed; least width of a passage [m]."""
_ROCK, _PASSAGE = (0.4, 0.46), 0.8
_LESS_ROCK = 0.985
"""Where rock is drawn, what a further try has of it."""
_CELL = 0.2
"""Side of the automaton's cells [m]."""
_FINE = 3
"""Cells of the rounded cave to a cell of the automaton, along each side."""
_ROUNDS = 4
_BLUR = 0.14
"""Standard deviation that rounds the outlines [m]."""
_EXACT = 0.04
"""Outlines become polygons that lie at most so far from them [m]."""
_LEAST_FREE, _LEAST_SPAN = 0.35, 0.75
"""A cave has at least this share of its area free, and reaches over this share of its width and height."""
_TRIES = 60
_NEIGHBOURS = np.ones((3, 3), np.float32)


def random_cave(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a cave: cells become rock where most of their neighbours are (Johnson, Yannakakis & Togelius 2010).

    Raises:
        MapError: No cave comes out, as of too much rock or too wide passages in too small a plan.
    """
    width, height = draw_size(rng, options)
    shape = (max(int(height / _CELL), 3), max(int(width / _CELL), 3))
    passage, rock = options.get("passage", _PASSAGE), options.get("rock", float(rng.uniform(*_ROCK)))
    for _ in range(_TRIES):
        coarse = _largest(_smoothed(rng, shape, rock))
        if _is_large(coarse):
            places = _passable(_rounded(coarse), passage)
            free = _swept(places, passage)
            if _is_large(free):
                bounds = (0.0, 0.0, width, height)
                return Floorplan(name, _outlines(free), np.empty((0, 3)), bounds, _start(rng, places))
        rock *= 1.0 if "rock" in options else _LESS_ROCK
    raise MapError(
        f"no cave of {width:g} m x {height:g} m came out with rock {rock:g} and passages of {passage:g} m; "
        "less of both, or a larger plan, is needed"
    )


def _smoothed(rng: np.random.Generator, shape: tuple[int, int], rock: float) -> NDArray[np.uint8]:
    """Free cells (rows, columns) after some rounds of the automaton; the rim is rock."""
    solid = (rng.random(shape) < rock).astype(np.float32)
    missing = 9.0 - cv2.filter2D(np.ones(shape, np.float32), -1, _NEIGHBOURS, borderType=cv2.BORDER_CONSTANT)
    for _ in range(_ROUNDS):
        around = cv2.filter2D(solid, -1, _NEIGHBOURS, borderType=cv2.BORDER_CONSTANT)
        solid = (around + missing >= 5.0).astype(np.float32)
    solid[[0, -1]], solid[:, [0, -1]] = 1.0, 1.0
    return np.asarray(1.0 - solid, np.uint8)


def _rounded(free: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The free space in fine cells, without corners."""
    fine = np.repeat(np.repeat(free.astype(np.float32), _FINE, axis=0), _FINE, axis=1)
    return (cv2.GaussianBlur(fine, (0, 0), _BLUR / _CELL * _FINE) > 0.5).astype(np.uint8)


def _passable(free: NDArray[np.uint8], wide: float) -> NDArray[np.uint8]:
    """Where the middle of a disc of diameter ``wide`` [m] can be, the largest part of all."""
    return _largest((_distances(free) >= _disc(wide)).astype(np.uint8))


def _swept(places: NDArray[np.uint8], wide: float) -> NDArray[np.uint8]:
    """What the disc covers there."""
    return (_distances(1 - places) <= _disc(wide) - 0.5).astype(np.uint8)


def _disc(wide: float) -> float:
    """Radius of the disc [fine cells], a little more than asked for, as outlines are not exact."""
    return (0.5 * wide + _EXACT) / _CELL * _FINE


def _distances(cells: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Of each cell from the nearest that is 0, in cells."""
    return np.asarray(cv2.distanceTransform(cells, cv2.DIST_L2, cv2.DIST_MASK_PRECISE), np.float32)


def _largest(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The largest part that hangs together by sides of cells."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(cells, connectivity=4)
    if count < 2:
        return np.zeros_like(cells)
    largest: NDArray[np.uint8] = (labels == 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))).astype(np.uint8)
    return largest


def _is_large(free: NDArray[np.uint8]) -> bool:
    if free.mean() < _LEAST_FREE:
        return False
    spans = [float(np.ptp(np.flatnonzero(free.any(axis=axis)))) / free.shape[1 - axis] for axis in (0, 1)]
    return bool(min(spans) >= _LEAST_SPAN)


def _outlines(free: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Edges (n, 4) around the free space [m], solid on the left: its rim clockwise, rocks in it counter-clockwise."""
    contours, hierarchy = cv2.findContours(free, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    parts = []
    for contour, tree in zip(contours, hierarchy[0], strict=True):
        ring = cv2.approxPolyDP(contour, _EXACT / _CELL * _FINE, True).reshape(-1, 2).astype(np.float64)
        if len(ring) < 3:
            continue
        following = np.roll(ring, -1, axis=0)
        area = float(np.sum(ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]))
        if (area > 0.0) != (tree[3] >= 0):
            ring = ring[::-1]
        ring = (ring + 0.5) * (_CELL / _FINE)
        parts.append(np.hstack([ring, np.roll(ring, -1, axis=0)]))
    return np.vstack(parts)


def _start(rng: np.random.Generator, places: NDArray[np.uint8]) -> Pose:
    """One of the places with a random heading."""
    cell, cells = _CELL / _FINE, np.argwhere(places)
    row, column = cells[int(rng.integers(len(cells)))].tolist()
    return ((column + 0.5) * cell, (row + 0.5) * cell, float(rng.uniform(-np.pi, np.pi)))
