"""The lidar: all beams of all robots against the floor plans, in one kernel.

A scan's beams leave one point at equal angles, so an edge seen from there covers one run of consecutive beams. The
kernel therefore visits edges, not rays: it finds the run from the angles of the edge's two ends, and along the run the
*inverse* range to a line is linear in the beam's direction, ``1/t = A cos φ + B sin φ``, so the inner loop is two
multiplications and a maximum. Which edges can matter at all is looked up by the tile that the robot stands in.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.base.random_streams import normal
from lidarena.world.floorplan import Floorplan
from lidarena.world.map_geometry import TILE, MapGeometry, lay_out

FULL_CIRCLE = 2.0 * math.pi
"""Field of view of a lidar that sees all around [rad]."""
_FIRST_BEAM = np.int64(0)  # a plain 0 as an argument would be a type of its own, compiled apart
NO_OUTLINE = np.empty((0, 2))
"""Of robots that are discs."""
_TOUCH = 1e-9
"""Beams this close (in beam spacings) to an edge's end still hit it, so that no beam slips between two edges."""


class LidarSpec(NamedTuple):
    """A planar lidar that looks ahead; the defaults are the TurtleBot3's LDS-01, seeing from 0 m on.

    Attributes:
        beams: How many. Over a full circle they are even, the first one straight ahead, counter-clockwise; over less
            they are even from one end of the field of view to the other, the first one the rightmost.
        max_range: Longest range measured; a beam that meets nothing reports exactly this [m].
        noise: Standard deviation of a range [m].
        field_of_view: Angle that the beams span, half of it to either side of straight ahead [rad].
        min_range: A beam that measures less reports 0, as the LDS-01's driver does: it met something, but says not
            where [m].
        rate: Scans per second [Hz]; between two scans the last one is kept. Infinite: one at every decision.
    """

    beams: int = 360
    max_range: float = 3.5
    noise: float = 0.01
    field_of_view: float = FULL_CIRCLE
    min_range: float = 0.0
    rate: float = math.inf

    @property
    def sees_all_around(self) -> bool:
        """Whether the field of view is the full circle."""
        return self.field_of_view >= FULL_CIRCLE

    @property
    def increment(self) -> float:
        """Angle from one beam to the next [rad]."""
        return self.field_of_view / (self.beams if self.sees_all_around else self.beams - 1)

    @property
    def angles(self) -> NDArray[np.float64]:
        """Of the beams, in the robot's frame (beams,) [rad]: from 0 to 2π all around, else from -π to π."""
        turned = np.arange(self.beams, dtype=np.float64) * self.increment
        return np.asarray(turned if self.sees_all_around else turned - 0.5 * self.field_of_view)

    @property
    def directions(self) -> NDArray[np.float64]:
        """Cosines and sines of the beams' angles (2, beams)."""
        return np.stack([np.cos(self.angles), np.sin(self.angles)])

    def nearest_beam(self, angle: float) -> int:
        """The number of the beam that is nearest to an angle [rad]."""
        apart = np.abs((self.angles - angle + np.pi) % (2.0 * np.pi) - np.pi)
        return int(np.argmin(apart))


class Fan(NamedTuple):
    """How beams are numbered, for the kernel.

    Attributes:
        per_radian: Beams in a radian.
        first: Angle of the first beam, in beams.
        turn: Beams that would fill a full circle.
        closed: Whether they do.
    """

    per_radian: float
    first: float
    turn: float
    closed: bool


class Scanner(NamedTuple):
    """The lidars of a batch of worlds, ready to scan.

    Attributes:
        lidar: What each of them is.
        geometry: The floor plans as ``Lidar`` laid them out.
        directions: (2, beams) cos and sin of the beams' angles.
        plan: (W,) index of each world's floor plan in ``geometry``.
    """

    lidar: LidarSpec
    geometry: MapGeometry
    directions: NDArray[np.float64]
    plan: NDArray[np.int64]


class Lidar:
    """Casts the beams of many robots, each in one of several floor plans.

    Args:
        plans: The floor plans that worlds may refer to.
        spec: Beams, range and noise.
    """

    def __init__(self, plans: Sequence[Floorplan], spec: LidarSpec | None = None) -> None:
        self.spec = spec or LidarSpec()
        self.geometry = lay_out(plans, self.spec.max_range)
        self.directions = self.spec.directions

    def cast(
        self,
        poses: NDArray[np.float64],
        plan: NDArray[np.int64],
        radius: float = 0.0,
        outline: NDArray[np.float64] = NO_OUTLINE,
    ) -> NDArray[np.float64]:
        """Exact ranges ``(worlds, robots, beams)`` [m], ``max_range`` where a beam meets nothing.

        Args:
            poses: ``(worlds, robots, 3)`` x, y, theta.
            plan: ``(worlds,)`` index of each world's floor plan.
            radius: Of the other robots, which beams meet too; 0 leaves them invisible [m].
            outline: ``(n, 2)`` corners of the other robots, counter-clockwise in their frame, that beams meet in place
                of the discs; they lie within ``radius`` [m].
        """
        worlds, robots = poses.shape[:2]
        ranges = np.empty((worlds, robots, self.spec.beams))
        cast_beams(0, worlds, poses, plan, radius, outline, self.geometry, self.directions, self.spec, ranges)
        return ranges


@leaf
def cast_beams(
    first: int,
    last: int,
    poses: NDArray[np.float64],
    plan: NDArray[np.int64],
    radius: float,
    outline: NDArray[np.float64],
    geometry: MapGeometry,
    directions: NDArray[np.float64],
    lidar: LidarSpec,
    ranges: NDArray[np.float64],
) -> None:
    """Fill ``ranges`` (worlds, robots, beams) of worlds first … last - 1; see ``Lidar.cast``."""
    beams, fan = directions.shape[1], _fan_of(lidar)
    for w in range(first, last):
        for r in range(poses.shape[1]):
            x, y, theta = poses[w, r, 0], poses[w, r, 1], poses[w, r, 2]
            inverse = ranges[w, r]  # inverse ranges until the end
            for k in range(beams):
                inverse[k] = 1.0 / lidar.max_range
            _see_plan(x, y, theta, plan[w], geometry, lidar.max_range, fan, directions, inverse)
            if radius > 0.0:
                for other in range(poses.shape[1]):
                    if other != r:
                        _see_robot(poses[w, r], poses[w, other], radius, outline, lidar, fan, directions, inverse)
            for k in range(beams):
                ranges[w, r, k] = min(1.0 / ranges[w, r, k], lidar.max_range)


@inlined
def _fan_of(lidar: LidarSpec) -> Fan:
    """How a lidar's beams are numbered."""
    if lidar.field_of_view >= FULL_CIRCLE:
        return Fan(lidar.beams / (2.0 * math.pi), 0.0, np.float64(lidar.beams), True)
    per_radian = (lidar.beams - 1) / lidar.field_of_view
    return Fan(per_radian, -0.5 * (lidar.beams - 1), 2.0 * math.pi * per_radian, False)


@leaf
def _see_plan(
    x: float,
    y: float,
    theta: float,
    plan: int,
    geometry: MapGeometry,
    max_range: float,
    fan: Fan,
    directions: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> None:
    """Raise ``inverse`` (beams,) to the inverse ranges of one plan's edges and circles near (x, y)."""
    row = math.floor((y - geometry.tile_origin[plan, 1]) / TILE)
    column = math.floor((x - geometry.tile_origin[plan, 0]) / TILE)
    row = min(max(row, 0), geometry.tile_shape[plan, 0] - 1)
    column = min(max(column, 0), geometry.tile_shape[plan, 1] - 1)
    tile = geometry.first_tile[plan] + row * geometry.tile_shape[plan, 1] + column
    count = geometry.edges.shape[0]
    cos, sin = math.cos(theta), math.sin(theta)
    for i in range(geometry.tile_start[tile], geometry.tile_start[tile + 1]):
        item = geometry.items[i]
        if item < count:
            x1, y1, x2, y2 = geometry.edges[item]
            # into the robot's frame, where beam k always points in direction k
            ax, ay = (x1 - x) * cos + (y1 - y) * sin, (y1 - y) * cos - (x1 - x) * sin
            bx, by = (x2 - x) * cos + (y2 - y) * sin, (y2 - y) * cos - (x2 - x) * sin
            _see_edge(ax, ay, bx, by, max_range, fan, directions, inverse)
        else:
            cx, cy, radius = geometry.circles[item - count]
            reach = max_range + radius
            if (cx - x) * (cx - x) + (cy - y) * (cy - y) < reach * reach:
                _see_circle(cx - x, cy - y, radius, theta, fan, directions, inverse)


@leaf
def see_discs(
    pose: NDArray[np.float64],
    discs: NDArray[np.float64],
    radius: float,
    directions: NDArray[np.float64],
    lidar: LidarSpec,
    ranges: NDArray[np.float64],
) -> None:
    """Shorten the ranges of a robot's beams that meet discs.

    Args:
        pose: (3,) of the robot.
        discs: (n, 2 or more) x, y of their centres [m].
        radius: Of the discs [m].
        directions: (2, beams) cos and sin of the beams' angles.
        lidar: The robot's.
        ranges: (beams,) changed [m].
    """
    fan, reach = _fan_of(lidar), lidar.max_range + radius
    for k in range(len(ranges)):
        ranges[k] = 1.0 / ranges[k]
    for d in range(len(discs)):
        dx, dy = discs[d, 0] - pose[0], discs[d, 1] - pose[1]
        if dx * dx + dy * dy < reach * reach:
            _see_circle(dx, dy, radius, pose[2], fan, directions, ranges)
    for k in range(len(ranges)):
        ranges[k] = min(1.0 / ranges[k], lidar.max_range)


@leaf
def _see_robot(
    pose: NDArray[np.float64],
    other: NDArray[np.float64],
    radius: float,
    outline: NDArray[np.float64],
    lidar: LidarSpec,
    fan: Fan,
    directions: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> None:
    """Raise ``inverse`` along the beams from ``pose`` (3,) that meet the robot at ``other`` (3,)."""
    dx, dy, corners = other[0] - pose[0], other[1] - pose[1], outline.shape[0]
    if corners == 0:
        _see_circle(dx, dy, radius, pose[2], fan, directions, inverse)
        return
    reach = lidar.max_range + radius
    if dx * dx + dy * dy >= reach * reach:
        return
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    turned_cos, turned_sin = math.cos(other[2] - pose[2]), math.sin(other[2] - pose[2])
    middle_x, middle_y = dx * cos + dy * sin, dy * cos - dx * sin
    for k in range(corners):
        following = k + 1 if k + 1 < corners else 0
        ax = middle_x + outline[k, 0] * turned_cos - outline[k, 1] * turned_sin
        ay = middle_y + outline[k, 0] * turned_sin + outline[k, 1] * turned_cos
        bx = middle_x + outline[following, 0] * turned_cos - outline[following, 1] * turned_sin
        by = middle_y + outline[following, 0] * turned_sin + outline[following, 1] * turned_cos
        _see_edge(ax, ay, bx, by, lidar.max_range, fan, directions, inverse)


@leaf
def _see_edge(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    reach: float,
    fan: Fan,
    directions: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> None:
    """Raise ``inverse`` along the beams that meet the front of the edge a → b, given in the robot's frame."""
    cross = ax * by - ay * bx
    if cross >= -1e-12:  # seen from behind, or edge-on
        return
    ex, ey = bx - ax, by - ay
    if cross * cross > (ex * ex + ey * ey) * reach * reach:  # its whole line is out of range
        return
    beams = inverse.shape[0]
    low = math.atan2(by, bx) * fan.per_radian - fan.first  # b is clockwise of a
    high = math.atan2(ay, ax) * fan.per_radian - fan.first
    if high < low:
        high += fan.turn
    begin = math.ceil(low - _TOUCH)
    end = math.floor(high + _TOUCH) + 1
    a, b = ey / cross, -ex / cross
    if not fan.closed:
        _raise_run(max(begin, _FIRST_BEAM), min(end, beams), a, b, directions, inverse)
        end = math.floor(high - fan.turn + _TOUCH) + 1  # the same edge, seen across the gap behind
        _raise_run(_FIRST_BEAM, min(end, beams), a, b, directions, inverse)
        return
    if begin < 0:
        begin, end = begin + beams, end + beams
    _raise_run(begin, min(end, beams), a, b, directions, inverse)
    if end > beams:
        _raise_run(_FIRST_BEAM, end - beams, a, b, directions, inverse)


@leaf
def _raise_run(
    begin: int, end: int, a: float, b: float, directions: NDArray[np.float64], inverse: NDArray[np.float64]
) -> None:
    """Raise ``inverse[begin:end]`` to ``a cos φ + b sin φ``."""
    cos, sin = directions[0], directions[1]
    for k in range(begin, end):
        value = a * cos[k] + b * sin[k]
        inverse[k] = value if value > inverse[k] else inverse[k]


@leaf
def _see_circle(
    dx: float,
    dy: float,
    radius: float,
    theta: float,
    fan: Fan,
    directions: NDArray[np.float64],
    inverse: NDArray[np.float64],
) -> None:
    """Raise ``inverse`` along the beams that meet a circle whose centre is (dx, dy) from the robot."""
    squared = dx * dx + dy * dy
    if squared <= radius * radius:
        return
    beams = inverse.shape[0]
    middle = (math.atan2(dy, dx) - theta) * fan.per_radian - fan.first
    half = math.asin(radius / math.sqrt(squared)) * fan.per_radian
    cos, sin = math.cos(theta), math.sin(theta)
    cx, cy = dx * cos + dy * sin, dy * cos - dx * sin
    excess = radius * radius - squared
    if fan.closed:
        for n in range(math.ceil(middle - half), math.floor(middle + half) + 1):
            _meet_circle(n % beams, cx, cy, excess, directions, inverse)
        return
    for turns in range(-1, 2):
        shifted = middle + turns * fan.turn
        begin, end = math.ceil(shifted - half), math.floor(shifted + half) + 1
        for n in range(max(begin, 0), min(end, beams)):
            _meet_circle(n, cx, cy, excess, directions, inverse)


@inlined
def _meet_circle(
    k: int, cx: float, cy: float, excess: float, directions: NDArray[np.float64], inverse: NDArray[np.float64]
) -> None:
    """Raise ``inverse[k]`` if beam k meets a circle at (cx, cy); ``excess``: its radius² less its distance²."""
    along = cx * directions[0, k] + cy * directions[1, k]
    root = excess + along * along
    if root >= 0.0 and along > 0.0:
        inverse[k] = max(inverse[k], 1.0 / (along - math.sqrt(root)))


@inlined
def scan_is_due(w: int, period: float, lidar: LidarSpec, since: NDArray[np.float64]) -> bool:
    """Whether the lidar of world w scans now, ``period`` after it was asked last [s].

    Args:
        w: World.
        period: [s].
        lidar: Its rate is what matters.
        since: (worlds,) time since the last scan, changed [s]; ``first_scan`` in the beginning.
    """
    interval = 1.0 / lidar.rate
    since[w] += period
    if since[w] < interval - 1e-9:
        return False
    since[w] = min(since[w] - interval, interval)
    return True


def first_scan(period: float, lidar: LidarSpec) -> float:
    """What ``since`` of ``scan_is_due`` must be for a scan to be due at once [s]."""
    return 1.0 / lidar.rate - period


@leaf
def add_range_noise(
    first: int,
    last: int,
    lidar: LidarSpec,
    streams: NDArray[np.uint64],
    ranges: NDArray[np.float64],
    scans: NDArray[np.float32],
) -> None:
    """Fill ``scans`` (worlds, robots, beams) with what the lidar makes of ranges, see ``LidarSpec``.

    Args:
        first: First world.
        last: World after the last.
        lidar: Its noise and its shortest and longest ranges matter.
        streams: (worlds, 4) random streams.
        ranges: (worlds, robots, beams) exact ranges.
        scans: (worlds, robots, beams) output.
    """
    for w in range(first, last):
        for r in range(ranges.shape[1]):
            for k in range(ranges.shape[2]):
                value = ranges[w, r, k]
                if value < lidar.max_range and lidar.noise > 0.0:
                    value += lidar.noise * normal(streams[w])
                scans[w, r, k] = min(value, lidar.max_range) if value >= lidar.min_range else 0.0
