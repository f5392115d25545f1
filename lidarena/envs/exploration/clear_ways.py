"""Which way to the edge of the known map, on ways that keep clear of what is known to stand there."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel, leaf, take_next
from lidarena.envs.exploration.frontier_directions import most_of_square, shape_in_squares
from lidarena.envs.worker_threads import on_threads

_FADE = 2.0
"""A piece of the edge counts e times less that much further away than the nearest [m]."""
_ENOUGH = 5.0
"""So many squares, half a metre of edge, are as much as can be said."""
_FURTHEST = 6.0
"""Edge so much further away than the nearest is left out [m]."""
_NEARNESS = 4.0
"""The nearest edge is e times less near that much further away [m]."""
_SIGHT = 35
"""As far as ways are followed in a straight line [squares]."""
_STRAIGHT, _DIAGONAL = 2, 3
"""Lengths of steps, in half squares."""
_LEAST, _LITTLE, _AMPLE = 0.07, 0.15, 0.23
"""Room beside the robot's contact distance, see ``Clearance`` [m]."""
_AMPLY, _ROOMILY, _NARROWLY, _TIGHTLY = 1, 2, 4, 8
"""How many times longer a step counts with ample room, with less, with little, and with too little."""
_BUCKETS = _DIAGONAL * _TIGHTLY + 1
_FAR = 2**30
_UNKNOWN, _FREE, _WALL = -1, 0, 2
_HIDDEN, _OPAQUE, _CLEAR, _TIGHT = 0, 1, 2, 3
WAY_EXTRAS = 3
"""What follows the sectors in what ``clear_ways`` returns: the direction's two numbers and how near the edge is."""


class Clearance(NamedTuple):
    """How much room a way needs: from the middle of a square to that of the nearest wall cell [half cells, squared].

    Attributes:
        least: A way does not enter squares with less.
        little: Ways through less are long, and no straight line leads into less.
        ample: Ways through less are somewhat long.
        turning: No way ends where there is less: a robot that can neither stop nor reverse would not get out again.
        reach: Beyond so many squares from a wall there is room for all of these.
    """

    least: float
    little: float
    ample: float
    turning: float
    reach: int


def room_for(contact_distance: float, turning_radius: float, resolution: float) -> Clearance:
    """The room that a robot needs, see ``clear_ways``."""
    half = 0.5 * resolution
    least, little, ample, turning = (
        ((contact_distance + more) / half) ** 2 for more in (_LEAST, _LITTLE, _AMPLE, max(turning_radius, _LEAST))
    )
    return Clearance(least, little, ample, turning, math.ceil(math.sqrt(max(ample, turning)) / 4.0))


@leaf
def _pool(occupancy: NDArray[np.int8], squares: NDArray[np.int8], gaps: NDArray[np.int32], reach: int) -> None:
    """Make 2 × 2 cells a square: a wall if one is, else free if one is, else unknown; and measure squares' room.

    Args:
        occupancy: (cells, cells).
        squares: (rows, columns) output.
        gaps: (rows, columns) output; squared distances to the nearest wall cell [half cells].
        reach: So many squares away from a wall cell they are measured.
    """
    rows, columns = squares.shape
    gaps[:] = _FAR
    for r in range(rows):
        for c in range(columns):
            y, x = 2 * r, 2 * c
            most = most_of_square(occupancy, r, c)
            squares[r, c] = most
            if most <= 0:
                continue
            squares[r, c] = _WALL
            for k in range(4):
                if occupancy[y + (k >> 1), x + (k & 1)] > 0:
                    _keep_off(2 * (y + (k >> 1)) + 1, 2 * (x + (k & 1)) + 1, r, c, reach, gaps)


@leaf
def _keep_off(y: int, x: int, r: int, c: int, reach: int, gaps: NDArray[np.int32]) -> None:
    """Take the distances of squares around (r, c) to the wall cell whose middle is (y, x) [half cells]."""
    rows, columns = gaps.shape
    for i in range(max(r - reach, 0), min(r + reach + 1, rows)):
        dy = 4 * i + 2 - y
        for j in range(max(c - reach, 0), min(c + reach + 1, columns)):
            dx = 4 * j + 2 - x
            gaps[i, j] = min(gaps[i, j], dy * dy + dx * dx)


@leaf
def _look_around(
    squares: NDArray[np.int8], gaps: NDArray[np.int32], row: int, column: int, room: Clearance, sight: NDArray[np.int8]
) -> None:
    """Find the squares to which one can drive in a straight line from (row, column).

    Args:
        squares: (rows, columns).
        gaps: (rows, columns).
        row: Of the robot.
        column: Of the robot.
        room: That ways need.
        sight: (2 _SIGHT + 1,) * 2 output, the robot in the middle; _TIGHT where the robot leaves a place that has
            little room, _OPAQUE for squares in sight beyond which there is no sight.
    """
    rows, columns = squares.shape
    sight[:] = _HIDDEN
    sight[_SIGHT, _SIGHT] = _CLEAR if gaps[row, column] >= room.little else _TIGHT
    for ring in range(1, _SIGHT + 1):
        shrunk = (ring - 1.0) / ring
        for dr in range(-ring, ring + 1):
            step = 1 if abs(dr) == ring else 2 * ring
            for dc in range(-ring, ring + 1, step):
                r, c = row + dr, column + dc
                if not (0 <= r < rows and 0 <= c < columns) or squares[r, c] == _WALL:
                    continue
                before = sight[_SIGHT + round(dr * shrunk), _SIGHT + round(dc * shrunk)]
                if before < _CLEAR:
                    continue
                roomy = gaps[r, c] >= room.little
                if squares[r, c] == _UNKNOWN:
                    sight[_SIGHT + dr, _SIGHT + dc] = _OPAQUE
                elif roomy:
                    sight[_SIGHT + dr, _SIGHT + dc] = _CLEAR
                elif before == _TIGHT:
                    sight[_SIGHT + dr, _SIGHT + dc] = _TIGHT


class _Search(NamedTuple):
    """A search in progress; the first four are (rows, columns).

    Attributes:
        squares: What they are.
        gaps: Squared distances to the nearest wall cell [half cells].
        reached: Lengths of ways [half squares].
        via: Each way's last square in sight.
        queue: (_BUCKETS, rows × columns) squares by the length of their way, modulo.
        filled: (_BUCKETS,) squares in each.
    """

    squares: NDArray[np.int8]
    gaps: NDArray[np.int32]
    reached: NDArray[np.int32]
    via: NDArray[np.int32]
    queue: NDArray[np.int32]
    filled: NDArray[np.int64]


@inlined
def _times(gap: int, room: Clearance) -> int:
    """How many times longer a step counts into a square with that much room."""
    if gap >= room.ample:
        return _AMPLY
    if gap >= room.little:
        return _ROOMILY
    return _NARROWLY if gap >= room.least else _TIGHTLY


@leaf
def _spread(r: int, c: int, room: Clearance, search: _Search) -> int:
    """Lengthen the way to (r, c) into the squares around; returns how many of them wait from now on."""
    rows, columns = search.squares.shape
    length, tight, waiting = search.reached[r, c], search.gaps[r, c] < room.least, 0
    for y in range(max(r - 1, 0), min(r + 2, rows)):
        for x in range(max(c - 1, 0), min(c + 2, columns)):
            what, gap, straight = search.squares[y, x], search.gaps[y, x], y == r or x == c
            if what == _WALL or (what == _UNKNOWN and not (straight and gap >= room.turning)):
                continue
            if gap < room.least and not tight:
                continue
            new = length + (_STRAIGHT if straight else _DIAGONAL) * _times(gap, room)
            if new < search.reached[y, x]:
                search.reached[y, x], search.via[y, x] = new, search.via[r, c]
                there = new % _BUCKETS
                search.queue[there, search.filled[there]] = y * columns + x
                search.filled[there] += 1
                waiting += 1
    return waiting


@leaf
def _tell(x: float, y: float, theta: float, further: float, out: NDArray[np.float32]) -> None:
    """Add a square of the edge to the sector of (x, y), seen from the robot in the map's directions [m]."""
    sectors = out.shape[0] - WAY_EXTRAS
    bearing = math.atan2(y, x) - theta
    sector = math.floor(bearing / (2.0 * math.pi) * sectors + 0.5) % sectors
    out[sector] = min(out[sector] + np.float32(math.exp(-further / _FADE) / _ENOUGH), np.float32(1.0))
    if out[sectors + 2] == 0.0:  # the first is the nearest
        out[sectors] = min(max(0.5 + 0.5 * math.cos(bearing), 0.0), 1.0)
        out[sectors + 1] = min(max(0.5 + 0.5 * math.sin(bearing), 0.0), 1.0)
        out[sectors + 2] = 1.0


@kernel
def _search(
    squares: NDArray[np.int8],
    gaps: NDArray[np.int32],
    pose: NDArray[np.float64],
    room: Clearance,
    side: float,
    out: NDArray[np.float32],
) -> None:
    """Dijkstra's algorithm with buckets (Dial 1969) from ``pose`` (relative to the map) over free squares.

    Args:
        squares: (rows, columns).
        gaps: (rows, columns).
        pose: (3,).
        room: That ways need.
        side: Of a square [m].
        out: (sectors + 3,) output of zeros.
    """
    rows, columns = squares.shape
    reached, via = np.full((rows, columns), _FAR, np.int32), np.empty((rows, columns), np.int32)
    queue, filled = np.empty((_BUCKETS, rows * columns), np.int32), np.zeros(_BUCKETS, np.int64)
    search = _Search(squares, gaps, reached, via, queue, filled)
    sight = np.empty((2 * _SIGHT + 1, 2 * _SIGHT + 1), np.int8)
    row = min(max(int(pose[1] / side), 0), rows - 1)
    column = min(max(int(pose[0] / side), 0), columns - 1)
    _look_around(squares, gaps, row, column, room, sight)
    reached[row, column] = 0
    via[row, column] = queue[0, 0] = row * columns + column
    filled[0] = 1
    out[-3] = out[-2] = 0.5
    length, waiting, first = 0, 1, _FAR
    while waiting > 0 and 0.5 * side * (length - first) <= _FURTHEST:
        bucket = length % _BUCKETS
        for k in range(filled[bucket]):
            r, c = queue[bucket, k] // columns, queue[bucket, k] % columns
            if reached[r, c] != length:
                continue  # a shorter way was found since
            if max(abs(r - row), abs(c - column)) <= _SIGHT and sight[r - row + _SIGHT, c - column + _SIGHT]:
                via[r, c] = r * columns + c
            if squares[r, c] == _UNKNOWN and length > 0:
                first = min(first, length)
                x, y = (via[r, c] % columns + 0.5) * side - pose[0], (via[r, c] // columns + 0.5) * side - pose[1]
                _tell(x, y, pose[2], 0.5 * side * (length - first), out)
            else:
                waiting += _spread(r, c, room, search)
        waiting -= filled[bucket]
        filled[bucket] = 0
        length += 1
    if first < _FAR:
        out[-1] = math.exp(-0.5 * side * first / _NEARNESS)


@kernel
def _find_ways(
    occupancy: NDArray[np.int8],
    origins: NDArray[np.float64],
    poses: NDArray[np.float64],
    room: Clearance,
    resolution: float,
    out: NDArray[np.float32],
    counter: NDArray[np.int64],
) -> None:
    squares = np.empty(shape_in_squares(occupancy), np.int8)
    gaps = np.empty(squares.shape, np.int32)
    while True:
        w = take_next(counter)
        if w >= out.shape[0]:
            break
        _pool(occupancy[w], squares, gaps, room.reach)
        pose = poses[w].copy()
        pose[:2] -= origins[w]
        out[w] = 0.0
        _search(squares, gaps, pose, room, 2.0 * resolution, out[w])


def clear_ways(
    occupancy: NDArray[np.int8],
    origins: NDArray[np.float64],
    poses: NDArray[np.float64],
    sectors: int,
    robot: tuple[float, float],
    resolution: float,
) -> NDArray[np.float32]:
    """Say for every sector how much of the known map's edge one reaches on clear ways by setting out that way.

    The map is searched in squares of two cells a side. Ways keep 7 cm more than the contact distance from the middles
    of wall cells, and count two times as long within 23 cm more and four times within 15 cm. A robot that is where
    there is too little room for a way may leave that place. An unknown square that a way reaches and where there is
    room to turn, d metres further than the nearest such, adds exp(-d / 2 m) / 5 to the sector in which the way's last
    square lies to which a straight line leads that keeps 15 cm more than the contact distance; 1 is the most.

    Args:
        occupancy: (worlds, rows, columns) -1, 0, 100.
        origins: (worlds, 2) [m].
        poses: (worlds, 3).
        sectors: The first one is centred ahead, the next ones lie to the left.
        robot: Distance from its middle at which it touches something, and the radius of its turns [m].
        resolution: Side of a cell [m].

    Returns:
        (worlds, sectors + 3) in [0, 1]: the sectors; the direction of the way to the nearest such square as
        (1 + cos) / 2 and (1 + sin) / 2, and exp(-length / 4 m); 0.5, 0.5 and 0 where there is none.
    """
    out = np.empty((len(poses), sectors + WAY_EXTRAS), np.float32)
    counter, room = np.zeros(1, np.int64), room_for(*robot, resolution)
    on_threads(len(out), lambda _: _find_ways(occupancy, origins, poses, room, resolution, out, counter))
    return out
