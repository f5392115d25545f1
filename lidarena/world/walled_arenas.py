"""Arenas with walls that are drawn: for ``arena="lidarena.world.walled_arenas:NAME"``.

``walls``, ``pockets``, ``mazes`` and ``rooms`` are what the shipped agent has been trained in. ``long_wall``,
``zigzag``, ``u_wall`` and ``cul_de_sac`` are what it is asked about, and has not been trained in. All have 100 m rooms,
in which a robot of 1 m goes from a start to a goal 60 m or more away; walls are rows of round posts that touch.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lidarena.world.arenas import Arena
from lidarena.world.random_arenas import ROOM

Points = NDArray[np.float64]
_POST = 0.8
"""Radius of the posts that walls are made of [m]."""
_SPACING = 1.2
_ROBOT = 1.0
_ROOMY = 1.5
"""Room between obstacles and the robot at start and goal [m]."""
_APART = 60.0
_TRIES = 1000


def posts_along(points: Sequence[tuple[float, float]] | Points) -> Points:
    """Posts (n, 3) x, y, radius along the line through some points [m]."""
    corners, rows = np.asarray(points, np.float64), []
    for a, b in pairwise(corners):
        count = max(math.ceil(float(np.hypot(*(b - a))) / _SPACING), 1)
        rows.append(a + np.linspace(0.0, 1.0, count + 1)[:, None] * (b - a))
    return np.insert(np.vstack(rows), 2, _POST, axis=1)


def walls(rng: np.random.Generator) -> Arena:
    """One to four straight walls of 15 to 70 m, more or less across the way, and some round obstacles."""
    start, goal = _ends(rng)
    obstacles = [_beside(rng, int(rng.integers(0, 8)))]
    for _ in range(int(rng.integers(1, 5))):
        middle = _between(rng, start, goal)
        half = 0.5 * rng.uniform(15.0, 70.0) * _heading(goal - start, math.pi / 2 + rng.uniform(-0.9, 0.9))
        obstacles.append(posts_along(np.stack([middle - half, middle + half])))
    return _arena(rng, "walls", obstacles, start, goal)


def pockets(rng: np.random.Generator) -> Arena:
    """One or two pockets across the way: arcs, or a back wall with arms of 2 to 30 m, open towards the start."""
    start, goal = _ends(rng)
    obstacles = [_beside(rng, int(rng.integers(0, 8)))]
    for _ in range(int(rng.integers(1, 3))):
        middle = _between(rng, start, goal)
        turn = rng.uniform(-0.6, 0.6)
        if rng.random() < 0.3:
            radius, opening = rng.uniform(4.0, 16.0), rng.uniform(2.0, 4.6)
            angles = math.atan2(*(goal - start)[::-1]) + turn + np.linspace(-opening / 2, opening / 2, 24)
            obstacles.append(posts_along(middle + radius * np.column_stack([np.cos(angles), np.sin(angles)])))
            continue
        back, ahead = _heading(goal - start, math.pi / 2 + turn), _heading(goal - start, turn)
        half, slant = 0.5 * rng.uniform(4.0, 34.0), rng.uniform(-0.3, 0.6)
        left, right = rng.uniform(2.0, 30.0, 2) * (rng.random(2) < 0.9)
        line = [
            middle + half * back - left * (ahead - slant * back),
            middle + half * back,
            middle - half * back,
            middle - half * back - right * (ahead + slant * back),
        ]
        obstacles.append(posts_along(np.stack(line)))
    return _arena(rng, "pockets", obstacles, start, goal)


def mazes(rng: np.random.Generator) -> Arena:
    """A maze of 4 to 7 corridors a side, of which some walls are missing."""
    count = int(rng.integers(4, 8))
    side, open_sides = 100.0 / count, _spanning_tree(rng, count)
    rows = []
    for here, there in _neighbours(count):
        if (here, there) in open_sides or rng.random() < 0.12:
            continue
        corner = np.array([there[1], there[0]], np.float64) * side
        along = np.array([0.0, side]) if here[0] == there[0] else np.array([side, 0.0])
        rows.append(posts_along(np.stack([corner, corner + along])))
    start, goal = _ends(rng)
    return _arena(rng, "mazes", rows or [np.empty((0, 3))], start, goal)


def rooms(rng: np.random.Generator) -> Arena:
    """A storey that walls divide into rooms with doors of 4 to 9 m."""
    rows: list[Points] = [_beside(rng, int(rng.integers(0, 5)))]
    lines = [(0.0, 0.0, 100.0, 100.0)]
    for _ in range(int(rng.integers(2, 5))):
        widest = max(range(len(lines)), key=lambda k: max(lines[k][2] - lines[k][0], lines[k][3] - lines[k][1]))
        x0, y0, x1, y1 = lines.pop(widest)
        upright, share, door = x1 - x0 >= y1 - y0, rng.uniform(0.35, 0.65), 0.5 * rng.uniform(4.0, 9.0)
        low, high = (y0, y1) if upright else (x0, x1)
        gap = rng.uniform(low + door + 3.0, high - door - 3.0)
        at = x0 + share * (x1 - x0) if upright else y0 + share * (y1 - y0)
        for a, b in ((low, gap - door), (gap + door, high)):
            rows.append(posts_along([(at, a), (at, b)] if upright else [(a, at), (b, at)]))
        lines += [(x0, y0, at, y1), (at, y0, x1, y1)] if upright else [(x0, y0, x1, at), (x0, at, x1, y1)]
    start, goal = _ends(rng)
    return _arena(rng, "rooms", rows, start, goal)


def long_wall(rng: np.random.Generator) -> Arena:
    """A wall of 40 to 75 m across the way, whose ends lie in the room."""
    start, goal = np.array([10.0, rng.uniform(25.0, 75.0)]), np.array([90.0, rng.uniform(25.0, 75.0)])
    length = rng.uniform(40.0, 75.0)
    low, x, lean = rng.uniform(8.0, 92.0 - length), rng.uniform(40.0, 65.0), rng.uniform(-6.0, 6.0)
    return _arena(rng, "long_wall", [posts_along([(x - lean, low), (x + lean, low + length)])], start, goal)


def zigzag(rng: np.random.Generator) -> Arena:
    """Two walls, each from one side of the room nearly to the other, past which the way goes to and fro."""
    start, goal = np.array([10.0, rng.uniform(15.0, 85.0)]), np.array([90.0, rng.uniform(15.0, 85.0)])
    first, second = rng.uniform(28.0, 42.0), rng.uniform(58.0, 72.0)
    lower, upper = (
        [(first, 0.0), (first, rng.uniform(60.0, 88.0))],
        [(second, rng.uniform(12.0, 40.0)), (second, 100.0)],
    )
    rows = [posts_along(lower), posts_along(upper)]
    if rng.random() < 0.5:
        rows = [row * (1.0, -1.0, 1.0) + (0.0, 100.0, 0.0) for row in rows]
    return _arena(rng, "zigzag", rows, start, goal)


def u_wall(rng: np.random.Generator) -> Arena:
    """A rectangular U of 2 to 28 m, open towards the start, in the middle of the way."""
    start, goal = np.array([8.0, rng.uniform(35.0, 65.0)]), np.array([92.0, rng.uniform(35.0, 65.0)])
    deep, half = rng.uniform(2.0, 28.0), 0.5 * rng.uniform(12.0, 30.0)
    x, y = rng.uniform(45.0, 65.0), 0.5 * (start[1] + goal[1]) + rng.uniform(-3.0, 3.0)
    line = [(x - deep, y + half), (x, y + half), (x, y - half), (x - deep, y - half)]
    return _arena(rng, "u_wall", [posts_along(line)], start, goal)


def cul_de_sac(rng: np.random.Generator) -> Arena:
    """A lane of 25 to 45 m towards the goal that is closed at its end, with the start before or in it."""
    start, goal = np.array([12.0, rng.uniform(40.0, 60.0)]), np.array([88.0, rng.uniform(40.0, 60.0)])
    mouth, half = rng.uniform(4.0, 22.0), 0.5 * rng.uniform(8.0, 14.0)
    end = mouth + rng.uniform(25.0, 45.0)
    line = [(mouth, start[1] + half), (end, start[1] + half), (end, start[1] - half), (mouth, start[1] - half)]
    return _arena(rng, "cul_de_sac", [posts_along(line)], start, goal)


def _ends(rng: np.random.Generator) -> tuple[Points, Points]:
    while True:
        start, goal = rng.uniform(_ROBOT + _ROOMY, 100.0 - _ROBOT - _ROOMY, (2, 2))
        if np.hypot(*(goal - start)) >= _APART:
            return start, goal


def _heading(way: Points, turn: float) -> Points:
    """The direction (2,) of a way, turned to the left by an angle."""
    angle = math.atan2(way[1], way[0]) + turn
    return np.array([math.cos(angle), math.sin(angle)])


def _between(rng: np.random.Generator, start: Points, goal: Points) -> Points:
    """A place on the way, or a little beside it."""
    place: Points = start + rng.uniform(0.25, 0.75) * (goal - start) + rng.normal(0.0, 6.0, 2)
    return place


def _beside(rng: np.random.Generator, count: int) -> Points:
    """Round obstacles of 2 to 5 m anywhere."""
    return np.column_stack([rng.uniform(0.0, 100.0, (count, 2)), rng.uniform(2.0, 5.0, count)])


def _neighbours(count: int) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """All pairs of cells (row, column) of a square that lie beside each other, the lower one first."""
    cells = [(row, column) for row in range(count) for column in range(count)]
    right = [((row, column), (row, column + 1)) for row, column in cells if column + 1 < count]
    return right + [((row, column), (row + 1, column)) for row, column in cells if row + 1 < count]


def _spanning_tree(rng: np.random.Generator, count: int) -> set[tuple[tuple[int, int], tuple[int, int]]]:
    """Pairs of cells between which there must be no wall, so that every cell can be reached (Kruskal)."""
    pairs = _neighbours(count)
    part = {(row, column): row * count + column for row in range(count) for column in range(count)}
    chosen = set()
    for number in rng.permutation(len(pairs)):
        one, other = pairs[number]
        if part[one] != part[other]:
            chosen.add((one, other))
            old, new = part[other], part[one]
            part = {cell: new if own == old else own for cell, own in part.items()}
    return chosen


def _arena(rng: np.random.Generator, name: str, obstacles: Sequence[Points], start: Points, goal: Points) -> Arena:
    """Put everything into the room; obstacles at the ends give way, and so do ends that stand in a wall."""
    circles = np.vstack(obstacles)
    for _ in range(_TRIES):
        away = [np.hypot(*(circles[:, :2] - end).T) - circles[:, 2] for end in (start, goal)]
        if not len(circles) or min(float(gap.min()) for gap in away) > _ROBOT + _ROOMY:
            break
        start, goal = _ends(rng)
    ends = [(float(end[0]), float(end[1])) for end in (start, goal)]
    return Arena(name, circles, ends[0], ends[1], ROOM, _ROBOT)
