"""Floor plans for teams of robots, drawn after the figures of Bennewitz & Burgard, and where robots stand in them.

The authors print one size (19 m × 15 m) and their pictures are not ours to copy; these drawings keep what their text
says of them. All have their lower-left outer corner at (0, 0). Walls are 0.2 m thick and lie on multiples of 0.2 m, so
that a grid of Bennewitz & Burgard's 20 cm cells shows them exactly. The doors of
``office`` are open on a grid of 60 cm, too. Two robots of 0.1 m radius or more cannot pass each other in a passage of
0.8 m on that grid.
"""

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.world.floorplan import Floorplan

THICKNESS = 0.2
"""Thickness of every wall here [m]."""

Wall = tuple[float, float, float, float]
Door = tuple[float, float]
_HALF = THICKNESS / 2


class TeamPlaces(NamedTuple):
    """Where robots of a team start and where they go.

    Attributes:
        starts: (n, 2) x, y [m].
        goals: (n, 2) x, y [m]; robot i's goal is row i, unless the places are ``drawn``.
        drawn: Whether these are predefined positions from which starts and goals are drawn at random, as in Bennewitz &
            Burgard's experiments (section 3.3); the two arrays are then equal.
    """

    starts: NDArray[np.float64]
    goals: NDArray[np.float64]
    drawn: bool


def office() -> Floorplan:
    """19 m × 15 m: a corridor with five rooms to the north and four to the south (the authors' Fig. 3, 11 left).

    Every room has a door of 1.0 m to the corridor; two pairs of rooms are also connected, so that some conflicts in
    the corridor can be avoided through them.
    """
    width, height, low, high = 19.0, 15.0, 6.3, 8.7
    north, south = (3.9, 7.7, 11.3, 15.1), (4.7, 9.5, 14.3)
    walls = _outer_walls(width, height)
    walls += _horizontal(high, _HALF, width - _HALF, [(x, 1.0) for x in (2.1, 5.7, 9.3, 13.5, 17.1)])
    walls += _horizontal(low, _HALF, width - _HALF, [(x, 1.0) for x in (2.7, 6.9, 12.3, 16.5)])
    for x in north:
        walls += _vertical(x, high, height - _HALF, [(11.7, 1.0)] if x == 7.7 else [])
    for x in south:
        walls += _vertical(x, _HALF, low, [(2.7, 1.0)] if x == 9.5 else [])
    return _plan("office", width, height, walls, (1.0, 7.5, 0.0))


def unstructured() -> Floorplan:
    """14 m × 12 m: obstacles scattered through one hall, with many ways round them (the authors' Fig. 11 right)."""
    boxes = [
        (1.8, 1.6, 3.4, 3.0), (5.0, 1.2, 5.8, 3.6), (7.8, 1.8, 9.8, 2.6), (11.4, 1.4, 12.4, 3.4),
        (1.2, 5.0, 2.2, 6.8), (3.8, 5.2, 5.4, 6.0), (6.8, 4.4, 7.6, 6.8), (9.2, 4.6, 11.0, 5.4), (12.4, 5.6, 13.0, 7.0),
        (2.0, 8.8, 4.0, 9.6), (5.6, 8.0, 6.4, 10.4), (8.2, 8.4, 9.2, 9.8), (10.6, 7.4, 11.4, 9.0),
        (11.6, 10.2, 12.8, 10.8),
    ]  # fmt: skip
    rings = [[(x1, y1), (x2, y1), (x2, y2), (x1, y2)] for x1, y1, x2, y2 in boxes]
    rings += [[(3.8, 7.2), (4.6, 7.2), (4.2, 8.0)], [(9.0, 6.6), (9.8, 6.6), (9.4, 7.4)]]
    circles = [(7.0, 11.0, 0.3), (12.2, 4.4, 0.3)]
    return Floorplan.from_shapes(
        "unstructured",
        (0.0, 0.0, 14.0, 12.0),
        _outer_walls(14.0, 12.0),
        rings,
        circles,
        THICKNESS,
        (0.8, 0.8, 0.0),
    )


def passing() -> Floorplan:
    """10.4 m × 3.4 m: a corridor 0.8 m wide in which two robots meet, and one doorway to dodge into (Fig. 9)."""
    width, height = 10.4, 3.4
    walls = [*_outer_walls(width, height), *_horizontal(1.1, _HALF, width - _HALF, [(5.2, 0.8)])]
    walls += _vertical(3.9, 1.1, height - _HALF, []) + _vertical(6.5, 1.1, height - _HALF, [])
    rings = [[(0.0, 1.2), (3.8, 1.2), (3.8, 3.4), (0.0, 3.4)], [(6.6, 1.2), (10.4, 1.2), (10.4, 3.4), (6.6, 3.4)]]
    return Floorplan.from_shapes("passing", (0.0, 0.0, width, height), walls, rings, (), THICKNESS, (0.8, 0.6, 0.0))


def blocked() -> Floorplan:
    """16.2 m × 6.4 m: a hall, and a dead end 0.8 m wide in which one robot stands that others want to pass (Fig. 17).

    In Bennewitz & Burgard's order, longest way first, robots 0 and 1 are on their way into the dead end before 2 can
    get out; so it is with the first three robots and with any more.
    """
    width, height = 16.2, 6.4
    rings = [[(6.2, 0.0), (width, 0.0), (width, 2.8), (6.2, 2.8)], [(6.2, 3.6), (width, 3.6), (width, 6.4), (6.2, 6.4)]]
    return Floorplan.from_shapes(
        "blocked", (0.0, 0.0, width, height), _outer_walls(width, height), rings, (), THICKNESS, (1.0, 3.2, 0.0)
    )


def team_places(name: str) -> TeamPlaces | None:
    """Where robots start and go in a built-in floor plan for teams; None for every other floor plan.

    Args:
        name: Of the floor plan.
    """
    if name in _DRAWN_FROM:
        points = np.array(_DRAWN_FROM[name], np.float64)
        return TeamPlaces(points, points.copy(), True)
    if name in _FIXED:
        starts, goals = _FIXED[name]
        return TeamPlaces(np.array(starts, np.float64), np.array(goals, np.float64), False)
    return None


_DRAWN_FROM: dict[str, list[tuple[float, float]]] = {
    # two in each room, and six in the corridor
    "office": [
        *itertools.product((1.1, 2.9, 4.9, 6.7, 8.7, 10.3, 12.3, 14.1, 16.1, 17.9), (13.3,)),
        *itertools.product((1.3, 3.5, 5.9, 8.3, 10.7, 13.1, 15.5, 17.7), (1.7,)),
        (0.9, 6.9), (0.9, 8.1), (6.3, 7.5), (12.7, 7.5), (18.1, 6.9), (18.1, 8.1),
    ],
    "unstructured": [
        (0.9, 0.9), (4.3, 0.9), (6.9, 0.9), (10.5, 0.9), (13.1, 0.9), (0.9, 3.9), (3.5, 4.1), (8.3, 3.5), (10.5, 3.7),
        (13.3, 4.9), (2.9, 7.7), (6.1, 7.3), (8.3, 7.5), (11.9, 6.5), (0.9, 8.1), (0.9, 11.1), (4.7, 10.9), (9.9, 10.7),
        (7.3, 9.3), (13.3, 9.1), (13.3, 11.3),
    ],
}  # fmt: skip
_FIXED: dict[str, tuple[list[tuple[float, float]], list[tuple[float, float]]]] = {
    "passing": ([(0.9, 0.7), (7.5, 0.7)], [(9.5, 0.7), (0.9, 0.7)]),
    "blocked": (
        [(4.5, 3.3), (3.5, 3.3), (12.1, 3.3), (0.9, 0.9), (0.9, 5.5), (3.1, 5.5)],
        [(15.1, 3.3), (14.3, 3.3), (5.1, 1.5), (2.1, 5.5), (2.5, 0.9), (4.7, 0.9)],
    ),
}


def _plan(name: str, width: float, height: float, walls: list[Wall], start: tuple[float, float, float]) -> Floorplan:
    return Floorplan.from_shapes(name, (0.0, 0.0, width, height), walls, thickness=THICKNESS, start=start)


def _outer_walls(width: float, height: float) -> list[Wall]:
    x1, y1, x2, y2 = _HALF, _HALF, width - _HALF, height - _HALF
    return [(x1, y1, x2, y1), (x2, y1, x2, y2), (x2, y2, x1, y2), (x1, y2, x1, y1)]


def _gaps(begin: float, end: float, doors: list[Door]) -> list[tuple[float, float]]:
    """The centre line from ``begin`` to ``end`` without doors (centre, clear width), which are in rising order."""
    edges = [begin, *itertools.chain(*((at - w / 2 - _HALF, at + w / 2 + _HALF) for at, w in doors)), end]
    return list(zip(edges[::2], edges[1::2], strict=True))


def _horizontal(y: float, x1: float, x2: float, doors: list[Door]) -> list[Wall]:
    return [(a, y, b, y) for a, b in _gaps(x1, x2, doors)]


def _vertical(x: float, y1: float, y2: float, doors: list[Door]) -> list[Wall]:
    return [(x, a, x, b) for a, b in _gaps(y1, y2, doors)]
