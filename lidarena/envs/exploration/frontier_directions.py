"""Which way to the edge of the known map: around walls, as the robot would have to drive."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel, leaf, take_next
from lidarena.envs.worker_threads import on_threads

_FADE = 2.0
"""A piece of the edge counts e times less that much further away than the nearest [m]."""
_ENOUGH = 5.0
"""So many squares, half a metre of edge, are as much as can be said."""
_MARGIN = 0.15
"""A square lies in sight that is nearer, by this, than the nearest hit in its sector and the two beside it [m]."""
_NEAR = 2
"""A square is narrow within so many squares of a wall."""
_STRAIGHT, _DIAGONAL, _WHERE_NARROW = 2, 3, 3
"""Lengths of steps, in half squares, and how many times longer they count where it is narrow."""
_BUCKETS = _DIAGONAL * _WHERE_NARROW + 1
_FAR = 2**30
_UNKNOWN, _FREE, _NARROW, _WALL = -1, 0, 1, 2


@inlined
def most_of_square(occupancy: NDArray[np.int8], r: int, c: int) -> int:
    """The largest of the 2 × 2 cells that square (r, c) is made of."""
    y, x = 2 * r, 2 * c
    lower = max(occupancy[y, x], occupancy[y, x + 1])
    upper = max(occupancy[y + 1, x], occupancy[y + 1, x + 1])
    return int(max(lower, upper))


@inlined
def shape_in_squares(occupancy: NDArray[np.int8]) -> tuple[int, int]:
    """Rows and columns of squares in maps (worlds, rows, columns); an odd last row or column of cells is left out."""
    return occupancy.shape[1] // 2, occupancy.shape[2] // 2


@leaf
def _pool(occupancy: NDArray[np.int8], squares: NDArray[np.int8]) -> None:
    """Make 2 × 2 cells a square: a wall if one is, else free if one is, else unknown; free near a wall is narrow."""
    rows, columns = squares.shape
    for r in range(rows):
        for c in range(columns):
            most = most_of_square(occupancy, r, c)
            squares[r, c] = _WALL if most > 0 else most
    for r in range(rows):
        for c in range(columns):
            if squares[r, c] != _WALL:
                continue
            for y in range(max(r - _NEAR, 0), min(r + _NEAR + 1, rows)):
                for x in range(max(c - _NEAR, 0), min(c + _NEAR + 1, columns)):
                    if squares[y, x] == _FREE:
                        squares[y, x] = _NARROW


@inlined
def _sector_in_sight(dx: float, dy: float, ranges: NDArray[np.float32]) -> int:
    """The sector of a place in the robot's frame, -1 if a wall may hide it."""
    sectors = ranges.shape[0]
    sector = math.floor(math.atan2(dy, dx) / (2.0 * math.pi) * sectors + 0.5) % sectors
    free = min(ranges[sector], ranges[sector - 1], ranges[(sector + 1) % sectors])
    return sector if math.hypot(dx, dy) < max(float(free), 2.0 * _MARGIN) - _MARGIN else -1


@kernel
def _search(
    squares: NDArray[np.int8],
    pose: NDArray[np.float64],
    ranges: NDArray[np.float32],
    side: float,
    out: NDArray[np.float32],
) -> None:
    """Dijkstra's algorithm with buckets (Dial 1969) from ``pose`` (relative to the map) over free squares."""
    rows, columns = squares.shape
    reached = np.full((rows, columns), _FAR, np.int32)
    via = np.zeros((rows, columns), np.int16)  # the sector of the way's last square in sight; its complement after that
    queue = np.empty((_BUCKETS, rows * columns), np.int32)
    filled = np.zeros(_BUCKETS, np.int64)
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    row = min(max(int(pose[1] / side), 0), rows - 1)
    column = min(max(int(pose[0] / side), 0), columns - 1)
    reached[row, column] = 0
    queue[0, 0], filled[0] = row * columns + column, 1
    length, waiting, first = 0, 1, -1
    while waiting > 0:
        bucket = length % _BUCKETS
        for k in range(filled[bucket]):
            r, c = queue[bucket, k] // columns, queue[bucket, k] % columns
            if reached[r, c] != length:
                continue  # a shorter way was found since
            if via[r, c] >= 0:
                dx, dy = (c + 0.5) * side - pose[0], (r + 0.5) * side - pose[1]
                seen = _sector_in_sight(cos * dx + sin * dy, cos * dy - sin * dx, ranges)
                via[r, c] = seen if seen >= 0 else ~via[r, c]
            if squares[r, c] == _UNKNOWN and length > 0:
                first = length if first < 0 else first
                further = 0.5 * side * (length - first)
                sector = via[r, c] if via[r, c] >= 0 else ~via[r, c]
                out[sector] += math.exp(-further / _FADE) / _ENOUGH
                continue
            for y in range(max(r - 1, 0), min(r + 2, rows)):
                for x in range(max(c - 1, 0), min(c + 2, columns)):
                    straight = y == r or x == c
                    if squares[y, x] == _WALL or (squares[y, x] == _UNKNOWN and not straight):
                        continue
                    step = _STRAIGHT if straight else _DIAGONAL
                    new = length + (step * _WHERE_NARROW if squares[y, x] == _NARROW else step)
                    if new >= reached[y, x]:
                        continue
                    reached[y, x], via[y, x] = new, via[r, c]
                    there = new % _BUCKETS
                    queue[there, filled[there]] = y * columns + x
                    filled[there] += 1
                    waiting += 1
        waiting -= filled[bucket]
        filled[bucket] = 0
        length += 1


@kernel
def _feel(
    occupancy: NDArray[np.int8],
    origins: NDArray[np.float64],
    poses: NDArray[np.float64],
    ranges: NDArray[np.float32],
    resolution: float,
    out: NDArray[np.float32],
    counter: NDArray[np.int64],
) -> None:
    squares = np.empty(shape_in_squares(occupancy), np.int8)
    while True:
        w = take_next(counter)
        if w >= out.shape[0]:
            break
        _pool(occupancy[w], squares)
        pose = poses[w].copy()
        pose[:2] -= origins[w]
        out[w] = 0.0
        _search(squares, pose, ranges[w], 2.0 * resolution, out[w])
        for k in range(out.shape[1]):
            out[w, k] = min(out[w, k], np.float32(1.0))


def frontier_histogram(
    occupancy: NDArray[np.int8],
    origins: NDArray[np.float64],
    poses: NDArray[np.float64],
    ranges: NDArray[np.float32],
    resolution: float,
) -> NDArray[np.float32]:
    """Say for every sector around each pose how much of the known map's edge one reaches by setting out that way.

    The map is searched in squares of two cells a side (an odd last row or column is left out), where a step within two
    squares of a wall counts three times. An unknown square that a way reaches over free ones, d metres further than the
    nearest such, adds exp(-d / 2 m) / 5 to the sector in which the way leaves the robot's sight; 1 is the most. So the
    nearest part of the edge is always felt, however far.

    Args:
        occupancy: (worlds, rows, columns) -1, 0, 100.
        origins: (worlds, 2) [m].
        poses: (worlds, 3).
        ranges: (worlds, sectors) nearest hits [m]; the first sector is centred ahead, the next ones lie to the left.
        resolution: Side of a cell [m].

    Returns:
        (worlds, sectors) in [0, 1]; all 0 where nothing unknown can be reached.
    """
    out = np.empty(ranges.shape, np.float32)
    counter = np.zeros(1, np.int64)
    on_threads(len(out), lambda _: _feel(occupancy, origins, poses, ranges, resolution, out, counter))
    return out


def mean_direction(edge: NDArray[np.float32]) -> NDArray[np.float32]:
    """The mean direction of what ``frontier_histogram`` says, as a unit vector mapped into [0, 1]².

    Args:
        edge: (worlds, sectors), not negative.

    Returns:
        (worlds, 2) in [0, 1]: (1 + x) / 2 and (1 + y) / 2, x ahead and y to the left, of the mean of the sectors'
        directions weighted by ``edge``; shorter than a unit where they disagree, 0.5 and 0.5 where all are 0.
    """
    arrow = np.empty((len(edge), 2), np.float32)
    _point(edge, arrow)
    return arrow


@leaf
def _point(edge: NDArray[np.float32], arrow: NDArray[np.float32]) -> None:
    """A loop: NumPy's product of matrices would round a world's sum as the size of the batch has it."""
    sectors = edge.shape[1]
    for w in range(edge.shape[0]):
        x = y = total = 0.0
        for k in range(sectors):
            angle = 2.0 * math.pi / sectors * k
            x += edge[w, k] * math.cos(angle)
            y += edge[w, k] * math.sin(angle)
            total += edge[w, k]
        scale = 0.5 / total if total > 0.0 else 0.0
        arrow[w, 0] = min(max(0.5 + scale * x, 0.0), 1.0)
        arrow[w, 1] = min(max(0.5 + scale * y, 0.0), 1.0)
