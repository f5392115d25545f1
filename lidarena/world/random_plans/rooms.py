"""Rooms, corridors and doors: a rectangle that is divided again and again, and doors along a spanning tree."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.random_plans.options import draw_size

OPTIONS = {
    "door": (0.6, 2.0),
    "loops": (0.0, 1.0),
    "room": (2.0, 10.0),
    "corridor": (0.8, 4.0),
    "thickness": (0.05, 0.3),
}
"""Least width of a door [m]; share of the further doors that are opened; side of the smallest room [m]; width of the
corridor [m]; thickness of the walls [m]."""
_DOOR, _ROOM, _CORRIDOR, _THICKNESS, _LOOPS = 0.8, 2.2, 1.3, 0.1, 0.2
_WIDER = 0.4
"""Doors and corridors are at most so much wider than the least width, as a share."""
_JAMB = 0.15
"""Wall that is left on both sides of a door [m]."""
_MAY_STAY = 0.35
"""Chance that a room which could be divided stays whole, once it is not large."""
_LARGE = 20.0
"""Rooms above this area are always divided, if they can be [m²]."""
_CORRIDOR_FROM = 35.0
"""Plans from this area on have a corridor in half of the cases [m²]."""


class Room(NamedTuple):
    """A rectangle between the centre lines of its walls [m]."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def sides(self) -> tuple[float, float]:
        """Along x and y [m]."""
        return self.x1 - self.x0, self.y1 - self.y0


class RoomPlan(NamedTuple):
    """What walls, doors and rooms there are.

    Attributes:
        size: Outer size along x and y [m].
        rooms: All rooms; corridors among them.
        walls: (n, 4) centre lines x1, y1, x2, y2 [m].
        doors: (n, 3) middle of each door [m] and its width [m].
        thickness: Of the walls [m].
    """

    size: tuple[float, float]
    rooms: list[Room]
    walls: NDArray[np.float64]
    doors: NDArray[np.float64]
    thickness: float


def random_rooms(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a plan of rooms, and in larger ones often a corridor.

    Raises:
        MapError: No two rooms fit.
    """
    plan = draw_rooms(rng, options)
    width, height = plan.size
    start = start_in(rng, plan.rooms)
    bounds = (0.0, 0.0, width, height)
    return Floorplan.from_shapes(name, bounds, plan.walls, thickness=plan.thickness, start=start)


def draw_rooms(rng: np.random.Generator, options: Mapping[str, float]) -> RoomPlan:
    """Draw the walls, doors and rooms.

    Raises:
        MapError: No two rooms fit.
    """
    width, height = draw_size(rng, options)
    thickness = options.get("thickness", _THICKNESS)
    inner = max(width, height) - thickness
    least = options.get("room", min(_ROOM, 0.5 * inner))
    if inner < 2.0 * least:
        raise MapError(
            f"a plan of {width:g} m x {height:g} m has no room for two rooms of {least:g} m; "
            "a smaller room= or a larger plan is needed"
        )
    half = 0.5 * thickness
    whole = Room(half, half, width - half, height - half)
    parts, corridors = _corridor(rng, whole, options, least)
    rooms = corridors + [room for part in parts for room in _divide(rng, part, least)]
    door = options.get("door", _DOOR)
    shared = _shared_walls(rooms, door + 2.0 * _JAMB + thickness)
    chosen = _spanning_doors(rng, len(rooms), shared, len(corridors), options.get("loops", _LOOPS))
    walls, doors = _cut_doors(rng, whole, shared, chosen, door)
    return RoomPlan((width, height), rooms, walls, doors, thickness)


def start_in(rng: np.random.Generator, rooms: list[Room]) -> Pose:
    """A pose in the middle of a random room, with a random heading."""
    room = rooms[int(rng.integers(len(rooms)))]
    return (0.5 * (room.x0 + room.x1), 0.5 * (room.y0 + room.y1), float(rng.uniform(-np.pi, np.pi)))


def _corridor(
    rng: np.random.Generator, whole: Room, options: Mapping[str, float], least: float
) -> tuple[list[Room], list[Room]]:
    """What is beside the corridor, and the corridor itself, if there is one: across the plan along its longer side."""
    width, height = whole.sides
    wide = options.get("corridor", _CORRIDOR) * float(rng.uniform(1.0, 1.0 + _WIDER))
    across = min(width, height)
    wanted = "corridor" in options or (width * height >= _CORRIDOR_FROM and rng.random() < 0.5)
    if not wanted or across < wide + least:
        return [whole], []
    both = across >= wide + 2.0 * least
    first = float(rng.uniform(least, across - wide - least)) if both else across - wide
    if width >= height:
        low, high = whole.y0 + first, whole.y0 + first + wide
        parts = [Room(whole.x0, whole.y0, whole.x1, low), Room(whole.x0, high, whole.x1, whole.y1)]
        return parts[: 1 + both], [Room(whole.x0, low, whole.x1, high)]
    low, high = whole.x0 + first, whole.x0 + first + wide
    parts = [Room(whole.x0, whole.y0, low, whole.y1), Room(high, whole.y0, whole.x1, whole.y1)]
    return parts[: 1 + both], [Room(low, whole.y0, high, whole.y1)]


def _divide(rng: np.random.Generator, room: Room, least: float) -> list[Room]:
    """Divide a room across its longer side until the parts are small, or stay by chance."""
    width, height = room.sides
    along_x = width >= height * float(rng.uniform(0.8, 1.25))
    side = width if along_x else height
    if side < 2.0 * least or (width * height < _LARGE and rng.random() < _MAY_STAY):
        return [room]
    cut = float(rng.uniform(max(least, 0.3 * side), min(side - least, 0.7 * side)))
    if along_x:
        x = room.x0 + cut
        parts = (Room(room.x0, room.y0, x, room.y1), Room(x, room.y0, room.x1, room.y1))
    else:
        y = room.y0 + cut
        parts = (Room(room.x0, room.y0, room.x1, y), Room(room.x0, y, room.x1, room.y1))
    return [leaf for part in parts for leaf in _divide(rng, part, least)]


class _Shared(NamedTuple):
    """A wall between two rooms: along x at y = ``at`` if ``level``, else along y at x = ``at``."""

    first: int
    second: int
    level: bool
    at: float
    low: float
    high: float
    roomy: bool


def _shared_walls(rooms: list[Room], needed: float) -> list[_Shared]:
    """Every piece of wall between two rooms; ``roomy`` where a door fits."""
    found = []
    for i, one in enumerate(rooms):
        for j in range(i):
            other = rooms[j]
            for level, ends in (
                (True, (one.x0, one.x1, other.x0, other.x1)),
                (False, (one.y0, one.y1, other.y0, other.y1)),
            ):
                low, high = max(ends[0], ends[2]), min(ends[1], ends[3])
                near = ((one.y0, other.y1), (one.y1, other.y0)) if level else ((one.x0, other.x1), (one.x1, other.x0))
                for mine, theirs in near:
                    if high - low > 1e-6 and abs(mine - theirs) < 1e-6:
                        found.append(_Shared(i, j, level, mine, low, high, high - low >= needed))
    return found


def _spanning_doors(
    rng: np.random.Generator, rooms: int, shared: list[_Shared], corridors: int, loops: float
) -> set[int]:
    """The walls that get a door: of a random spanning tree, to corridors first, and a share of the others."""
    parent = list(range(rooms))

    def root(room: int) -> int:
        while parent[room] != room:
            room = parent[room]
        return room

    order = rng.permutation(len(shared)).tolist()
    order.sort(key=lambda k: min(shared[k].first, shared[k].second) >= corridors)
    chosen, left = set(), []
    for k in order:
        wall = shared[k]
        if not wall.roomy:
            continue
        one, other = root(wall.first), root(wall.second)
        if one != other:
            parent[one] = other
            chosen.add(k)
        else:
            left.append(k)
    return chosen | {k for k in left if rng.random() < loops}


def _cut_doors(
    rng: np.random.Generator, whole: Room, shared: list[_Shared], chosen: set[int], door: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centre lines of all walls with gaps for the doors, and the doors."""
    x0, y0, x1, y1 = whole
    lines = [(x0, y0, x1, y0), (x0, y1, x1, y1), (x0, y0, x0, y1), (x1, y0, x1, y1)]
    doors = []
    for k, wall in enumerate(shared):
        pieces = [(wall.low, wall.high)]
        if k in chosen:
            room = wall.high - wall.low - 2.0 * _JAMB
            wide = min(door * float(rng.uniform(1.0, 1.0 + _WIDER)), room)
            middle = wall.low + _JAMB + 0.5 * wide + (room - wide) * float(rng.random())
            doors.append((middle, wall.at, wide) if wall.level else (wall.at, middle, wide))
            # drawn walls reach half their thickness beyond their ends
            pieces = [(wall.low, middle - 0.5 * wide), (middle + 0.5 * wide, wall.high)]
        lines += [(a, wall.at, b, wall.at) if wall.level else (wall.at, a, wall.at, b) for a, b in pieces]
    return np.array(lines), np.array(doors).reshape(-1, 3)
