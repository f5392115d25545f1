"""How fast what the beams of a scan have met is moving: discs made out from one scan to the next.

Beams whose ends lie beside each other and on a circle have met a disc. Where it goes is told by where it was before;
ends that lie on no circle, as on walls, stand still, unless they lie where a disc was expected.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.world.lidar import LidarSpec

MOST_TRACKS = 24
_LARGEST = 6.0
"""What has a greater radius is no disc but a wall [steps of the robot]."""
_ROUND = 0.15
"""The ends of a disc's beams lie no farther from its circle [steps]."""
_GATE = 1.6
"""Nothing is taken for a disc that was expected farther away [steps]."""
_COAST = 4
"""Scans for which a disc that was not seen is still expected."""
_SLOWEST = 0.1
"""What seems slower stands [steps a decision]."""


class ScanTracks(NamedTuple):
    """Discs that ``W`` robots keep track of.

    Attributes:
        discs: (W, T, 7) x, y [m], velocity [m a decision], radius [m], scans in which it was seen (0: no disc), and
            scans since then.
        motion: (W, beams, 2) velocity of what each beam has met [m a decision].
        ends: (W, beams, 2) where the beams end [m].
        group: (W, beams) number of the run of neighbouring ends that each belongs to; -1 where nothing was met.
    """

    discs: NDArray[np.float64]
    motion: NDArray[np.float64]
    ends: NDArray[np.float64]
    group: NDArray[np.int64]


def no_tracks(worlds: int, beams: int) -> ScanTracks:
    """Nothing was seen yet."""
    return ScanTracks(
        np.zeros((worlds, MOST_TRACKS, 7)),
        np.zeros((worlds, beams, 2)),
        np.zeros((worlds, beams, 2)),
        np.full((worlds, beams), -1, np.int64),
    )


@inlined
def _meets(distance: float, lidar: LidarSpec) -> bool:
    """Whether a beam has met something, and says where."""
    return bool(0.0 < distance < np.float32(lidar.max_range))


@leaf
def _are_beside(
    world: int, one: int, other: int, ranges: NDArray[np.float32], step: float, lidar: LidarSpec, tracks: ScanTracks
) -> bool:
    """Whether two neighbouring beams have met the same thing, as far as can be told."""
    if not (_meets(ranges[one], lidar) and _meets(ranges[other], lidar)):
        return False
    a, b = tracks.ends[world, one], tracks.ends[world, other]
    increment = min(lidar.field_of_view, 2.0 * math.pi) / len(ranges)
    wide = 2.5 * increment * min(ranges[one], ranges[other]) + 0.3 * step
    return bool((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 < wide * wide)


@leaf
def _group_ends(world: int, ranges: NDArray[np.float32], step: float, lidar: LidarSpec, tracks: ScanTracks) -> int:
    """Number the runs of ends that lie beside each other; returns a beam with which a run begins."""
    group, beams = tracks.group[world], len(ranges)
    number = 0
    for k in range(beams):
        if k and not _are_beside(world, k - 1, k, ranges, step, lidar, tracks):
            number += 1
        group[k] = number if _meets(ranges[k], lidar) else -1
    first = beams - 1
    around = lidar.field_of_view >= 2.0 * math.pi - 1e-9
    if group[0] == group[first] or not around or not _are_beside(world, first, 0, ranges, step, lidar, tracks):
        return 0
    while group[first - 1] == group[beams - 1]:
        first -= 1
    group[first:] = group[0]
    return first


@leaf
def _circle(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> tuple[float, float, float]:
    """Middle and radius of the circle through three points; radius -1 where there is none."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    twice = 2.0 * (bx * cy - by * cx)
    if abs(twice) < 1e-12:
        return 0.0, 0.0, -1.0
    bb, cc = bx * bx + by * by, cx * cx + cy * cy
    x, y = (cy * bb - by * cc) / twice, (bx * cc - cx * bb) / twice
    return a[0] + x, a[1] + y, math.sqrt(x * x + y * y)


@leaf
def _disc_of(
    world: int, first: int, count: int, pose: NDArray[np.float64], step: float, tracks: ScanTracks
) -> tuple[float, float, float]:
    """The disc on which a run of ends lies; radius -1 if they lie on none."""
    ends, beams = tracks.ends[world], tracks.ends.shape[1]
    if count < 3:
        return 0.0, 0.0, -1.0
    last = (first + count - 1) % beams
    middle = (first + count // 2) % beams
    x, y, radius = _circle(ends[first], ends[middle], ends[last])
    if radius < 0.0 or radius > _LARGEST * step:
        return 0.0, 0.0, -1.0
    for k in range(count):
        end = ends[(first + k) % beams]
        off = math.sqrt((end[0] - x) ** 2 + (end[1] - y) ** 2) - radius
        if abs(off) > _ROUND * step:
            return 0.0, 0.0, -1.0
    near = ends[middle]
    behind = (x - pose[0]) ** 2 + (y - pose[1]) ** 2 > (near[0] - pose[0]) ** 2 + (near[1] - pose[1]) ** 2
    return (x, y, radius) if behind else (0.0, 0.0, -1.0)


@leaf
def _follow(world: int, x: float, y: float, radius: float, step: float, tracks: ScanTracks) -> int:
    """Find the disc that was expected where one is seen, or begin with a new one; its number, -1 for want of room."""
    discs = tracks.discs[world]
    best, least, spare = -1, (_GATE * step) ** 2, -1
    for t in range(len(discs)):
        if discs[t, 5] == 0.0:
            spare = t if spare < 0 else spare
            continue
        away = (discs[t, 0] - x) ** 2 + (discs[t, 1] - y) ** 2
        if discs[t, 6] > 0.0 and away < least:  # not seen in this scan yet
            best, least = t, away
    if best < 0:
        if spare >= 0:
            discs[spare, 0], discs[spare, 1], discs[spare, 2], discs[spare, 3] = x, y, 0.0, 0.0
            discs[spare, 4], discs[spare, 5], discs[spare, 6] = radius, 1.0, 0.0
        return spare
    disc = discs[best]
    seen = min(disc[5] + 1.0, 5.0)
    place, speed = 2.0 * (2.0 * seen - 1.0) / (seen * (seen + 1.0)), 6.0 / (seen * (seen + 1.0))
    off_x, off_y = x - disc[0], y - disc[1]
    disc[0], disc[1] = disc[0] + min(place, 1.0) * off_x, disc[1] + min(place, 1.0) * off_y
    disc[2], disc[3] = disc[2] + speed * off_x, disc[3] + speed * off_y
    disc[4], disc[5], disc[6] = radius, seen, 0.0
    return best


@leaf
def _lend_motion(world: int, step: float, tracks: ScanTracks) -> None:
    """Let ends move that lie on no circle but where a moving disc was expected."""
    discs, ends, motion = tracks.discs[world], tracks.ends[world], tracks.motion[world]
    for t in range(len(discs)):
        disc = discs[t]
        if disc[5] < 2.0 or disc[6] == 0.0 or disc[2] ** 2 + disc[3] ** 2 < (_SLOWEST * step) ** 2:
            continue
        reach = disc[4] + 0.4 * step
        for k in range(len(ends)):
            away = (ends[k, 0] - disc[0]) ** 2 + (ends[k, 1] - disc[1]) ** 2
            if tracks.group[world, k] >= 0 and away < reach * reach and motion[k, 0] == motion[k, 1] == 0.0:
                motion[k, 0], motion[k, 1] = disc[2], disc[3]


@leaf
def track(
    world: int,
    pose: NDArray[np.float64],
    ranges: NDArray[np.float32],
    step: float,
    directions: NDArray[np.float64],
    lidar: LidarSpec,
    tracks: ScanTracks,
) -> None:
    """Make out from a new scan what moves in a world, and how.

    Args:
        world: Which one.
        pose: (3,) from which it was taken.
        ranges: (beams,) the scan [m].
        step: What the robot drives in a decision [m].
        directions: (2, beams) cos and sin of the beams' angles.
        lidar: Of the robot.
        tracks: Changed.
    """
    discs, motion, group, beams = tracks.discs[world], tracks.motion[world], tracks.group[world], len(ranges)
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    for k in range(beams):
        tracks.ends[world, k, 0] = pose[0] + ranges[k] * (cos * directions[0, k] - sin * directions[1, k])
        tracks.ends[world, k, 1] = pose[1] + ranges[k] * (sin * directions[0, k] + cos * directions[1, k])
        motion[k, 0], motion[k, 1] = 0.0, 0.0
    for t in range(len(discs)):
        discs[t, 0], discs[t, 1], discs[t, 6] = discs[t, 0] + discs[t, 2], discs[t, 1] + discs[t, 3], discs[t, 6] + 1.0
        if discs[t, 6] > _COAST:
            discs[t, 5] = 0.0
    first = _group_ends(world, ranges, step, lidar, tracks)
    k = 0
    while k < beams:
        at = (first + k) % beams
        count = 1
        while k + count < beams and group[(at + count) % beams] == group[at]:
            count += 1
        k += count
        if group[at] < 0:
            continue
        x, y, radius = _disc_of(world, at, count, pose, step, tracks)
        found = _follow(world, x, y, radius, step, tracks) if radius >= 0.0 else -1
        if found >= 0 and discs[found, 2] ** 2 + discs[found, 3] ** 2 >= (_SLOWEST * step) ** 2:
            for j in range(count):
                motion[(at + j) % beams, 0], motion[(at + j) % beams, 1] = discs[found, 2], discs[found, 3]
    _lend_motion(world, step, tracks)
