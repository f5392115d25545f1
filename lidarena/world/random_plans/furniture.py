"""Furnished rooms: tables and chairs on thin legs, round and slanted things, cupboards along walls."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.world.floorplan import Floorplan
from lidarena.world.random_plans import rooms as room_plans
from lidarena.world.random_plans.rooms import Room, RoomPlan, draw_rooms

OPTIONS = dict(room_plans.OPTIONS) | {"clutter": (0.0, 1.0)}
"""Those of rooms, and how much of what fits is put there."""
_CLUTTER = 0.6
_GAP = 0.5
"""Free way around every group of furniture, to walls and other groups [m]: so nothing is closed off."""
_LEG = (0.015, 0.03)
"""Radius of a leg [m]: 3 to 6 cm thick."""
_TRIES = 14
_DOORWAY = 0.9
"""No group comes nearer to a door [m]."""


@dataclass
class Furniture:
    """What has been put into a plan.

    Attributes:
        circles: x, y, radius [m].
        polygons: (n, 2) corners [m].
        groups: x, y, radius [m] of discs that hold a group each.
    """

    circles: list[tuple[float, float, float]] = field(default_factory=list)
    polygons: list[NDArray[np.float64]] = field(default_factory=list)
    groups: list[tuple[float, float, float]] = field(default_factory=list)


def random_furnished(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a plan of rooms and put furniture into it; what was free and wide enough for a robot stays connected.

    Every group of furniture (a table with its chairs, a shelf, a pillar) keeps half a metre of way around it, or stands
    flush with a wall, and its legs let a robot through or are too close for one.

    Raises:
        MapError: No two rooms fit.
    """
    plan = draw_rooms(rng, options)
    start = room_plans.start_in(rng, plan.rooms)
    things = Furniture(groups=[(start[0], start[1], 0.25)])  # the start stays free
    clutter = options.get("clutter", _CLUTTER)
    for room in plan.rooms:
        furnish(rng, things, room, plan, clutter)
    width, height = plan.size
    return Floorplan.from_shapes(
        name,
        (0.0, 0.0, width, height),
        plan.walls,
        things.polygons,
        things.circles,
        plan.thickness,
        start,
    )


def furnish(rng: np.random.Generator, things: Furniture, room: Room, plan: RoomPlan, clutter: float) -> None:
    """Put furniture into a room until nothing more fits, each thing with the chance ``clutter``."""
    inside = _inside(room, plan.thickness)
    for _ in range(_TRIES):
        if rng.random() >= clutter:
            continue
        kind = int(rng.integers(6))
        if kind == 0:
            _cupboard(rng, things, inside, plan)
            continue
        draw = (_table, _table, _pillar, _crate, _chair)[kind - 1]
        radius = draw(rng, things, (math.nan, math.nan), measure=True)
        place = _place(rng, things, inside, plan, radius)
        if place is not None:
            things.groups.append((*place, radius))
            draw(rng, things, place, measure=False)


def _inside(room: Room, thickness: float) -> Room:
    half = 0.5 * thickness
    return Room(room.x0 + half, room.y0 + half, room.x1 - half, room.y1 - half)


def _place(
    rng: np.random.Generator, things: Furniture, room: Room, plan: RoomPlan, radius: float
) -> tuple[float, float] | None:
    """A place for a disc of ``radius`` with the gap around it; None where none was found."""
    keep = radius + _GAP
    if min(room.sides) < 2.0 * keep:
        return None
    x, y = float(rng.uniform(room.x0 + keep, room.x1 - keep)), float(rng.uniform(room.y0 + keep, room.y1 - keep))
    return (x, y) if _is_clear(things, plan, x, y, radius) else None


def _is_clear(things: Furniture, plan: RoomPlan, x: float, y: float, radius: float) -> bool:
    others = all(math.hypot(x - ox, y - oy) >= radius + other + _GAP for ox, oy, other in things.groups)
    return others and all(math.hypot(x - dx, y - dy) >= radius + _DOORWAY for dx, dy, _ in plan.doors.tolist())


def _table(rng: np.random.Generator, things: Furniture, at: tuple[float, float], measure: bool) -> float:
    """Four legs under a table of 0.8 to 1.4 m, turned anyhow; half of the tables have chairs at their long sides."""
    if measure:
        return 0.95
    length, depth, turn = float(rng.uniform(0.8, 1.3)), float(rng.uniform(0.6, 0.9)), float(rng.uniform(0.0, math.pi))
    _legs(rng, things, at, length, depth, turn)
    if rng.random() < 0.5 and depth < 0.75:
        for side in (1.0, -1.0):
            away = side * (0.5 * depth + 0.15)
            chair = (at[0] - away * math.sin(turn), at[1] + away * math.cos(turn))
            _legs(rng, things, chair, 0.38, 0.36, turn)
    return 0.95


def _chair(rng: np.random.Generator, things: Furniture, at: tuple[float, float], measure: bool) -> float:
    """Four legs, 0.4 m apart."""
    if not measure:
        _legs(rng, things, at, 0.42, 0.42, float(rng.uniform(0.0, math.pi)))
    return 0.35


def _legs(
    rng: np.random.Generator, things: Furniture, at: tuple[float, float], length: float, depth: float, turn: float
) -> None:
    radius, cos, sin = float(rng.uniform(*_LEG)), math.cos(turn), math.sin(turn)
    for u in (-0.5 * length, 0.5 * length):
        for v in (-0.5 * depth, 0.5 * depth):
            things.circles.append((at[0] + u * cos - v * sin, at[1] + u * sin + v * cos, radius))


def _pillar(rng: np.random.Generator, things: Furniture, at: tuple[float, float], measure: bool) -> float:
    """Something round: a bin, a plant, a column."""
    if not measure:
        things.circles.append((*at, float(rng.uniform(0.08, 0.3))))
    return 0.3


def _crate(rng: np.random.Generator, things: Furniture, at: tuple[float, float], measure: bool) -> float:
    """A slanted box: a sofa, a chest."""
    if not measure:
        half, turn = 0.5 * rng.uniform((0.5, 0.3), (1.0, 0.7)), float(rng.uniform(0.0, math.pi))
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
        spin = np.array([(math.cos(turn), math.sin(turn)), (-math.sin(turn), math.cos(turn))])
        things.polygons.append(corners @ spin + at)
    return 0.62


def _cupboard(rng: np.random.Generator, things: Furniture, room: Room, plan: RoomPlan) -> None:
    """A box flush with one of the walls, never before a door."""
    long, deep = float(rng.uniform(0.6, min(1.6, 0.5 * min(room.sides)))), float(rng.uniform(0.3, 0.5))
    side, share = int(rng.integers(4)), float(rng.random())
    if side < 2:
        x = room.x0 + share * (room.sides[0] - long)
        y0, y1 = (room.y0, room.y0 + deep) if side == 0 else (room.y1 - deep, room.y1)
        box = (x, y0, x + long, y1)
    else:
        y = room.y0 + share * (room.sides[1] - long)
        x0, x1 = (room.x0, room.x0 + deep) if side == 2 else (room.x1 - deep, room.x1)
        box = (x0, y, x1, y + long)
    middle = (0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3]), 0.5 * math.hypot(box[2] - box[0], box[3] - box[1]))
    if _is_clear(things, plan, *middle):
        things.groups.append(middle)
        x0, y0, x1, y1 = box
        things.polygons.append(np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]))
