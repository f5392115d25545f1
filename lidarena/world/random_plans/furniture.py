"""Furnished rooms: pieces of furniture in the rooms of a plan, with a way around each."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lidarena.world.floorplan import Floorplan
from lidarena.world.random_plans import rooms as room_plans
from lidarena.world.random_plans.pieces import AT_WALLS, STANDING, Circle, Piece
from lidarena.world.random_plans.rooms import Room, RoomPlan, draw_rooms

OPTIONS = dict(room_plans.OPTIONS) | {"clutter": (0.0, 1.0)}
"""Those of rooms, and how much of what fits is put there."""
_CLUTTER = 0.6
_GAP = 0.5
"""Free way around every piece, to walls and other pieces [m]: so nothing is closed off."""
_SLIT = 0.2
"""What is narrower is closed for every robot [m]."""
_FRONT = 1.0
"""Free way between what stands at a wall and the wall opposite [m]."""
_DOORWAY = 0.4
"""No piece comes nearer to a door's opening [m]."""
_AT_WALL = 0.45
"""Share of the pieces that stand at walls."""
_TRIES, _TRIES_PER_AREA = 4.0, 1.0
"""Pieces that are tried in a room, and further ones for each m²."""
_PLACES = 4
"""Places where each of them is tried."""
_SIDES = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
"""Along the walls below, on the right, above and on the left, with the room on the left."""
_BEGINS = ((0, 1), (2, 1), (2, 3), (0, 3))
"""Which of x0, y0, x1, y1 are the corner where each of these walls begins."""


class _Furnishing:
    """The furniture of one room.

    Discs around the pieces keep their distance from each other and from doors; what is in other rooms is behind a wall.
    """

    def __init__(self, plan: RoomPlan, room: Room) -> None:
        half = 0.5 * plan.thickness
        self.room = Room(room.x0 + half, room.y0 + half, room.x1 - half, room.y1 - half)
        near = 0.5 * plan.thickness + 1e-6
        self._doors = [
            (x, y, 0.5 * width + _DOORWAY)
            for x, y, width in plan.doors.tolist()
            if room.x0 - near <= x <= room.x1 + near and room.y0 - near <= y <= room.y1 + near
        ]
        self._discs: list[Circle] = []
        self.circles: list[Circle] = []
        self.polygons: list[NDArray[np.float64]] = []

    def keep_free(self, x: float, y: float) -> None:
        """Let nothing stand near a point."""
        self._discs.append((x, y, 0.25))

    def fill(self, rng: np.random.Generator, clutter: float) -> None:
        """Try one piece after the other, each with the chance ``clutter``."""
        width, height = self.room.sides
        for _ in range(int(_TRIES + _TRIES_PER_AREA * width * height)):
            if rng.random() >= clutter:
                continue
            at_wall = rng.random() < _AT_WALL
            draw = AT_WALLS[int(rng.integers(len(AT_WALLS)))] if at_wall else STANDING[int(rng.integers(len(STANDING)))]
            (self._stand_at_wall if at_wall else self._stand_free)(draw(rng), rng.random((_PLACES, 3)).tolist())

    def _stand_free(self, piece: Piece, chances: list[list[float]]) -> None:
        """Put a piece at the first of some random places where it fits."""
        radius = piece.radius
        keep = radius + _GAP
        x0, y0, x1, y1 = self.room.x0 + keep, self.room.y0 + keep, self.room.x1 - keep, self.room.y1 - keep
        if x1 < x0 or y1 < y0:
            return
        for u, v, share in chances:
            x, y, turn = x0 + u * (x1 - x0), y0 + v * (y1 - y0), 2.0 * math.pi * share
            if self._is_clear(x, y, radius):
                self._put(piece, (x, y), (math.cos(turn), math.sin(turn)), (x, y, radius))
                return

    def _stand_at_wall(self, piece: Piece, chances: list[list[float]]) -> None:
        """Put a piece to the first of some random places along the walls where it fits."""
        left, _, right, deep = piece.extent
        width, height = self.room.sides
        middle, reach = 0.5 * deep, 0.5 * math.hypot(right - left, deep)
        for chance, share, _ in chances:
            side = int(4.0 * chance)
            (cos, sin), (begin_x, begin_y) = _SIDES[side], _BEGINS[side]
            long, across = (width, height) if side % 2 == 0 else (height, width)
            spare = long - (right - left)
            if spare < 0.0 or _SLIT < spare < _GAP or across < deep + _FRONT:
                continue
            along = _along_wall(share, spare) - left
            x, y = self.room[begin_x] + along * cos, self.room[begin_y] + along * sin
            disc = (x - middle * sin, y + middle * cos, reach)
            if self._is_clear(*disc):
                self._put(piece, (x, y), (cos, sin), disc)
                return

    def _is_clear(self, x: float, y: float, radius: float) -> bool:
        for ox, oy, other in self._discs:
            if math.hypot(x - ox, y - oy) < radius + other + _GAP:
                return False
        return all(math.hypot(x - ox, y - oy) >= radius + keep for ox, oy, keep in self._doors)

    def _put(self, piece: Piece, at: tuple[float, float], direction: tuple[float, float], disc: Circle) -> None:
        self._discs.append(disc)
        circles, polygons = piece.placed(*at, direction)
        self.circles += circles
        self.polygons += polygons


def _along_wall(share: float, spare: float) -> float:
    """From a wall's beginning to a piece that leaves ``spare`` of it free [m]: in a corner, or with a way beside it."""
    low, middle = share * spare, 0.5 * spare
    if min(low, spare - low) >= _GAP:
        return low
    return 0.0 if low < middle else spare


def random_furnished(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a plan of rooms and put furniture into it; what was free and wide enough for a robot stays connected.

    Every piece of furniture (a table with its chairs, a chest, a pillar) keeps half a metre of way around it or stands
    at a wall, and its legs let a robot through or are too close for one.

    Raises:
        MapError: No two rooms fit.
    """
    plan = draw_rooms(rng, options)
    start = room_plans.start_in(rng, plan.rooms)
    circles: list[Circle] = []
    polygons: list[NDArray[np.float64]] = []
    for room in plan.rooms:
        furnishing = _Furnishing(plan, room)
        furnishing.keep_free(*start[:2])
        furnishing.fill(rng, options.get("clutter", _CLUTTER))
        circles += furnishing.circles
        polygons += furnishing.polygons
    bounds = (0.0, 0.0, *plan.size)
    return Floorplan.from_shapes(name, bounds, plan.walls, polygons, circles, plan.thickness, start)
