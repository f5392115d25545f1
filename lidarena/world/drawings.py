"""The four circuits of DA-SLAM (Alcalde et al. 2022), drawn once.

Alcalde et al. print outer sizes and one sentence on each; their pictures are not public. These drawings keep the sizes
and the sentences. All have their lower-left outer corner at (0, 0), walls 0.1 m thick whose
outer faces lie on the stated size, and at least 0.8 m of clear width everywhere.
"""

import math
from collections.abc import Iterable

import numpy as np

from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.lattice import parse_drawing

THICKNESS = 0.1
"""Thickness of every wall of the four circuits [m]."""

Wall = tuple[float, float, float, float]
Circle = tuple[float, float, float]
Ring = list[tuple[float, float]]

SIMPLE_MAZE = (
    "+---+---+---+---+---+",
    "|           |       |",
    "+   +---+   +   +   +",
    "|   |           |   |",
    "+   +   +---+---+   +",
    "|   |   |           |",
    "+   +   +   +---+   +",
    "|       |   |       |",
    "+---+   +   +   +---+",
    "|                   |",
    "+---+---+---+---+---+",
)
"""Env-2: three interlocking loops, and a pocket in either lower corner."""

TURNAROUNDS = (
    "+---+---+---+---+---+---+---+",
    "|                           |",
    "+   +---+---+   +---+---+   +",
    "|           |   |           |",
    "+---+---+   +   +   +---+---+",
    "|           |   |           |",
    "+   +---+---+   +---+---+   +",
    "|                           |",
    "+---+---+---+   +---+---+---+",
    "|                           |",
    "+   +   +   +   +   +   +   +",
    "|   |   |   |   |   |   |   |",
    "+   +   +   +   +   +   +   +",
    "|   |   |   |   |   |   |   |",
    "+   +   +   +   +   +   +   +",
    "|       |   |   |   |       |",
    "+---+---+---+---+---+---+---+",
)
"""Env-3: a serpentine on either side of the upper half, a comb of dead ends and two hairpins below."""


def env1() -> Floorplan:
    """Env-1, 5.0 m wide and 5.6 m high: a maze with several obstacles, symmetrical about both of its axes.

    An H of walls stands in the middle; a pier from the top and one from the bottom reach into its two bays, so that
    the way round is a serpentine. Posts cap the walls' ends, buttresses narrow the two long corridors.
    """
    width, height = 5.0, 5.6
    walls = [*_outer_walls(width, height), (1.25, 2.8, 3.75, 2.8)]
    walls += _mirrored_walls([(1.25, 1.4, 1.25, 4.2)], width=width)
    walls += _mirrored_walls([(2.5, 0.05, 2.5, 1.6)], height=height)
    posts = _mirrored_circles([(1.25, 1.4, 0.15), (2.5, 1.6, 0.15)], width=width, height=height)
    corner: Ring = [(0.1, 0.1), (0.6, 0.1), (0.1, 0.6)]
    buttress: Ring = [(0.1, 2.3), (0.35, 2.55), (0.35, 3.05), (0.1, 3.3)]
    polygons = _mirrored_rings([corner], width=width, height=height) + _mirrored_rings([buttress], width=width)
    return Floorplan.from_shapes(
        "env1", (0.0, 0.0, width, height), walls, polygons, posts, THICKNESS, (0.7, 1.2, math.pi / 2)
    )


def env2() -> Floorplan:
    """Env-2, 7.5 m × 7.5 m: a simple maze of 5 × 5 places."""
    return _from_drawing("env2", SIMPLE_MAZE, 7.5, 7.5, (3.75, 0.79, math.pi))


def env3() -> Floorplan:
    """Env-3, 8.9 m wide and 10.2 m high: turnarounds and dead ends in a row, symmetrical about its middle corridor."""
    return _from_drawing("env3", TURNAROUNDS, 8.9, 10.2, (4.45, 5.73, math.pi / 2))


def env4() -> Floorplan:
    """Env-4, 5.8 m wide and 8.8 m high: a corridor between two halls, three rooms on either side of it.

    Each corner room has a door to its hall and one to the corridor, so that crossing it closes a loop; the two
    middle rooms are dead ends.
    """
    width, height, middle = 5.8, 8.8, 4.4
    side, low, high = 2.25, 1.25, 3.35  # the corridor's wall; the corner room's walls to the hall and the middle room
    left = [
        (0.05, low, 0.35, low),
        (1.35, low, side, low),
        (0.05, high, side, high),
        (side, low, side, 1.75),
        (side, 2.75, side, high),
    ]
    walls = _mirrored_walls(left, width=width, height=height)
    walls += _mirrored_walls([(side, high, side, middle - 0.5)], width=width, height=height)
    return Floorplan.from_shapes(
        "env4",
        (0.0, 0.0, width, height),
        [*_outer_walls(width, height), *walls],
        thickness=THICKNESS,
        start=(width / 2, 0.7, math.pi / 2),
    )


def _from_drawing(name: str, drawing: tuple[str, ...], width: float, height: float, start: Pose) -> Floorplan:
    walls = parse_drawing(drawing)
    rows, columns = walls.vertical.shape[0], walls.horizontal.shape[1]
    xs = np.linspace(THICKNESS / 2, width - THICKNESS / 2, columns + 1)
    ys = np.linspace(THICKNESS / 2, height - THICKNESS / 2, rows + 1)
    segments = walls.segments(xs, ys)
    return Floorplan.from_shapes(name, (0.0, 0.0, width, height), segments, thickness=THICKNESS, start=start)


def _outer_walls(width: float, height: float) -> list[Wall]:
    x1, y1, x2, y2 = THICKNESS / 2, THICKNESS / 2, width - THICKNESS / 2, height - THICKNESS / 2
    return [(x1, y1, x2, y1), (x2, y1, x2, y2), (x2, y2, x1, y2), (x1, y2, x1, y1)]


def _mirrored_rings(rings: Iterable[Ring], width: float | None = None, height: float | None = None) -> list[Ring]:
    """The shapes and their mirror images: left to right where a width is given, and bottom to top where a height is."""
    every = [list(ring) for ring in rings]
    if width is not None:
        every += [[(width - x, y) for x, y in ring] for ring in every]
    if height is not None:
        every += [[(x, height - y) for x, y in ring] for ring in every]
    return every


def _mirrored_walls(walls: Iterable[Wall], width: float | None = None, height: float | None = None) -> list[Wall]:
    rings = _mirrored_rings([[(x1, y1), (x2, y2)] for x1, y1, x2, y2 in walls], width, height)
    return [(*a, *b) for a, b in rings]


def _mirrored_circles(circles: Iterable[Circle], width: float, height: float) -> list[Circle]:
    every = list(dict.fromkeys(circles))
    rings = [(_mirrored_rings([[(x, y)]], width, height), radius) for x, y, radius in every]
    return list(dict.fromkeys((ring[0][0], ring[0][1], radius) for images, radius in rings for ring in images))
