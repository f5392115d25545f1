"""What the arena's robots meet on a step, and what they see after it."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.world.lidar import NO_OUTLINE, Scanner, add_range_noise, cast_beams, scan_is_due, see_discs
from lidarena.world.map_geometry import MapGeometry


class Measurements(NamedTuple):
    """Measurements of ``W`` worlds with one robot each.

    Attributes:
        ranges: (W, 1, beams) exact ranges [m].
        scans: (W, 1, beams) measured ranges, float32 [m].
        distance: (W,) to the goal [m].
        gap: (W,) least distance between the robot and anything else in the last step [m].
        path_length: (W,) of what was driven [m].
        since_scan: (W,) time since the last scan [s].
    """

    ranges: NDArray[np.float64]
    scans: NDArray[np.float32]
    distance: NDArray[np.float64]
    gap: NDArray[np.float64]
    path_length: NDArray[np.float64]
    since_scan: NDArray[np.float64]


@inlined
def _point_gap(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Squared distance of a point from the segment a → b."""
    ex, ey = bx - ax, by - ay
    squared = ex * ex + ey * ey
    share = ((px - ax) * ex + (py - ay) * ey) / squared if squared > 0.0 else 0.0
    share = min(max(share, 0.0), 1.0)
    dx, dy = px - ax - share * ex, py - ay - share * ey
    return dx * dx + dy * dy


@inlined
def _cross(ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float) -> bool:
    """Whether the segments a → b and c → d cross each other."""
    c_side = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    d_side = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
    a_side = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
    b_side = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
    return c_side * d_side < 0.0 and a_side * b_side < 0.0


@leaf
def way_gap(ax: float, ay: float, bx: float, by: float, world: int, geometry: MapGeometry) -> float:
    """Distance of the segment a → b from the nearest surface of a world; 0 where it crosses one."""
    least, count = math.inf, geometry.edges.shape[0]
    tile = geometry.first_tile[world]
    for i in range(geometry.tile_start[tile], geometry.tile_start[tile + 1]):
        item = geometry.items[i]
        if item >= count:
            cx, cy, radius = geometry.circles[item - count]
            least = min(least, math.sqrt(_point_gap(cx, cy, ax, ay, bx, by)) - radius)
            continue
        x1, y1, x2, y2 = geometry.edges[item]
        if _cross(ax, ay, bx, by, x1, y1, x2, y2):
            return 0.0
        squared = min(_point_gap(ax, ay, x1, y1, x2, y2), _point_gap(bx, by, x1, y1, x2, y2))
        squared = min(squared, _point_gap(x1, y1, ax, ay, bx, by), _point_gap(x2, y2, ax, ay, bx, by))
        least = min(least, math.sqrt(squared))
    return least


@leaf
def turn_and_sweep(
    turns: NDArray[np.float64],
    step: float,
    margin: float,
    geometry: MapGeometry,
    radii: NDArray[np.float64],
    poses: NDArray[np.float64],
    gaps: NDArray[np.float64],
    near: NDArray[np.bool_],
) -> None:
    """Turn every robot, and look how near the way ahead comes to anything.

    Args:
        turns: (W,) to the left [rad].
        step: Length of the way [m].
        margin: A robot that comes nearer than this is left to the solver [m].
        geometry: The worlds, each a plan of one tile.
        radii: (W,) of the robots [m].
        poses: (W, 1, 3) their headings are turned.
        gaps: (W,) output: least distance between the robot and a surface on the way [m].
        near: (W,) output: whether it may touch.
    """
    for w in range(turns.shape[0]):
        theta = poses[w, 0, 2] + turns[w]
        theta -= 2.0 * math.pi * math.floor(theta / (2.0 * math.pi) + 0.5)
        poses[w, 0, 2] = theta
        x, y = poses[w, 0, 0], poses[w, 0, 1]
        away = way_gap(x, y, x + step * math.cos(theta), y + step * math.sin(theta), w, geometry)
        gaps[w] = away - radii[w]
        near[w] = gaps[w] < margin


@leaf
def sense(
    first: int,
    last: int,
    before: NDArray[np.float64],
    poses: NDArray[np.float64],
    goals: NDArray[np.float64],
    period: float,
    scanner: Scanner,
    streams: NDArray[np.uint64],
    discs: NDArray[np.float64],
    disc_counts: NDArray[np.int64],
    disc_radius: float,
    measurements: Measurements,
) -> None:
    """Measure in worlds first … last - 1 after a step.

    Args:
        first: World.
        last: World after the last.
        before: (W, 1, 3) poses before the step.
        poses: (W, 1, 3) poses after it.
        goals: (W, 2) [m].
        period: Duration of the step [s].
        scanner: The lidars; each world is a plan of its own.
        streams: (W, 4) random streams.
        discs: (W, M, 4) moving obstacles: x, y [m], velocity.
        disc_counts: (W,) how many of them there are.
        disc_radius: Of them [m].
        measurements: Output.
    """
    lidar, geometry, directions = scanner.lidar, scanner.geometry, scanner.directions
    cast_beams(first, last, poses, scanner.plan, 0.0, NO_OUTLINE, geometry, directions, lidar, measurements.ranges)
    for w in range(first, last):
        if disc_counts[w]:
            see_discs(
                poses[w, 0], discs[w, : disc_counts[w]], disc_radius, directions, lidar, measurements.ranges[w, 0]
            )
        if scan_is_due(w, period, lidar, measurements.since_scan):
            add_range_noise(w, w + 1, lidar, streams, measurements.ranges, measurements.scans)
        dx, dy = poses[w, 0, 0] - before[w, 0, 0], poses[w, 0, 1] - before[w, 0, 1]
        measurements.path_length[w] += math.sqrt(dx * dx + dy * dy)
        dx, dy = goals[w, 0] - poses[w, 0, 0], goals[w, 1] - poses[w, 0, 1]
        measurements.distance[w] = math.sqrt(dx * dx + dy * dy)


@leaf
def observe(
    poses: NDArray[np.float64],
    goals: NDArray[np.float64],
    max_range: float,
    side: float,
    radii: NDArray[np.float64],
    proximity: bool,
    measurements: Measurements,
    out: NDArray[np.float32],
) -> None:
    """Write the observations.

    Args:
        poses: (W, 1, 3).
        goals: (W, 2) [m].
        max_range: Of the lidar [m].
        side: Distances to the goal are given over this [m].
        radii: (W,) of the robots [m].
        proximity: Whether beams are given as the radius over the range, at most 1, or as the range over the longest.
        measurements: Of the worlds.
        out: (W, beams + 3) output: beams, distance, cosine and sine of the goal's bearing.
    """
    beams = out.shape[1] - 3
    for w in range(out.shape[0]):
        for k in range(beams):
            scan = measurements.scans[w, 0, k]
            out[w, k] = radii[w] / max(np.float64(scan), radii[w]) if proximity else scan / max_range
        x, y, distance = goals[w, 0] - poses[w, 0, 0], goals[w, 1] - poses[w, 0, 1], measurements.distance[w]
        cos, sin = math.cos(poses[w, 0, 2]), math.sin(poses[w, 0, 2])
        out[w, beams] = min(distance / side, 1.0)
        out[w, beams + 1] = min(max((x * cos + y * sin) / distance, -1.0), 1.0) if distance > 0.0 else 1.0
        out[w, beams + 2] = min(max((y * cos - x * sin) / distance, -1.0), 1.0) if distance > 0.0 else 0.0
