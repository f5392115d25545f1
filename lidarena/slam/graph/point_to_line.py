"""Scan matching from points to lines (Censi 2008), by which beam of the other scan looks where a point lies.

A point is compared with the points of the other scan's beams in its direction: no tree is built, what the other laser
could not have seen is left alone, and a wall is never taken for its own back.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf, merged
from lidarena.slam.graph.surface_points import BeamFan, SurfacePoints

_SAME_SIDE = 0.6
"""Least cosine between the normals of two points of one surface."""
_MOST_BEAMS = 24
"""Beams to either side among which a neighbour is looked for."""
SPREAD = 0.03
"""How far points lie from a surface that is seen twice, with all that is not the noise of a range [m]."""


@leaf
def add_pair(
    store: SurfacePoints,
    fan: BeamFan,
    i: int,
    j: int,
    motion: NDArray[np.float64],
    nearby: float,
    stride: int,
    system: NDArray[np.float64],
) -> None:
    """Add what scan ``i`` says about where it lies, seen from scan ``j``.

    Args:
        store: The scans.
        fan: Their beams.
        i: A scan.
        j: Another.
        motion: (3,) pose of i in the frame of j.
        nearby: Points farther apart are none of one surface [m].
        stride: Every so manyth beam of i is used.
        system: (12,) to which is added: the normal equations' upper triangle (xx, xy, xt, yy, yt, tt), the gradient
            (x, y, t), the sum of squared distances, the number of points that fit, the number that could have fitted.
    """
    cos, sin = math.cos(motion[2]), math.sin(motion[2])
    for b in range(0, fan.beams, stride):
        weight = store.weights[i, b]
        if weight == 0.0:
            continue
        ax, ay = float(store.points[i, b, 0]), float(store.points[i, b, 1])
        rx, ry = cos * ax - sin * ay, sin * ax + cos * ay
        x, y = rx + motion[0], ry + motion[1]
        middle = _beam_towards(fan, x, y)
        if middle < -2 or middle > fan.beams + 1:
            continue
        system[11] += 1.0
        nix, niy = float(store.normals[i, b, 0]), float(store.normals[i, b, 1])
        chosen = _nearest(store, fan, j, middle, (x, y, cos * nix - sin * niy, sin * nix + cos * niy), nearby)
        if chosen >= 0:
            _add_point(store, j, chosen, (x, y, -ry, rx), weight, system)


@merged
def _beam_towards(fan: BeamFan, x: float, y: float) -> int:
    """Which beam of a laser goes towards a point; below 0 or beyond the last where none does."""
    turn = math.atan2(y, x) - fan.first
    turn -= 2.0 * math.pi * math.floor((turn + 0.5 * (2.0 * math.pi - fan.step * fan.beams)) / (2.0 * math.pi))
    return math.floor(turn / fan.step + 0.5)


@merged
def _nearest(
    store: SurfacePoints, fan: BeamFan, j: int, middle: int, point: tuple[float, float, float, float], nearby: float
) -> int:
    """The beam of scan ``j`` near ``middle`` whose surface a point (x, y, normal) lies on best; -1 if on none."""
    points, normals = store.points, store.normals
    x, y, nx, ny = point
    limit = nearby * nearby
    distance = math.sqrt(x * x + y * y) + 1e-9
    width = min(int(nearby / (distance * abs(fan.step))) + 1, _MOST_BEAMS)
    best, chosen = math.inf, -1
    for k in range(max(middle - width, 0), min(middle + width + 1, fan.beams)):
        dx, dy = x - points[j, k, 0], y - points[j, k, 1]
        d = dx * dx + dy * dy
        if d >= best or store.weights[j, k] == 0.0:
            continue
        if nx * normals[j, k, 0] + ny * normals[j, k, 1] <= _SAME_SIDE:
            continue
        across = dx * normals[j, k, 0] + dy * normals[j, k, 1]
        extent = max(nearby, float(store.extents[j, k]))
        if across * across < limit and d - across * across < extent * extent:
            best, chosen = d, k
    return chosen


@merged
def _add_point(
    store: SurfacePoints,
    j: int,
    chosen: int,
    point: tuple[float, float, float, float],
    weight: float,
    system: NDArray[np.float64],
) -> None:
    """Add how far a point (x, y and how it moves when its scan turns) is from the surface of a beam of scan ``j``."""
    x, y, turning_x, turning_y = point
    qx, qy = float(store.normals[j, chosen, 0]), float(store.normals[j, chosen, 1])
    off = qx * (x - store.points[j, chosen, 0]) + qy * (y - store.points[j, chosen, 1])
    turning = qx * turning_x + qy * turning_y
    scaled = off / SPREAD
    w = weight * store.weights[j, chosen] / (1.0 + scaled * scaled) / (SPREAD * SPREAD)
    system[0] += w * qx * qx
    system[1] += w * qx * qy
    system[2] += w * qx * turning
    system[3] += w * qy * qy
    system[4] += w * qy * turning
    system[5] += w * turning * turning
    system[6] += w * qx * off
    system[7] += w * qy * off
    system[8] += w * turning * off
    system[9] += off * off
    system[10] += 1.0


@leaf
def solve3(s: NDArray[np.float64], p: NDArray[np.float64], step: NDArray[np.float64]) -> None:
    """Solve a system of ``add_pair`` to which the diagonal p (3,) is added, for the ``step`` (3,) that it asks for."""
    a, b, c, d, e, f = s[0] + p[0], s[1], s[2], s[3] + p[1], s[4], s[5] + p[2]
    c0, c1, c2 = d * f - e * e, c * e - b * f, b * e - c * d
    determinant = a * c0 + b * c1 + c * c2
    x, y, t = -s[6], -s[7], -s[8]
    step[0] = (c0 * x + c1 * y + c2 * t) / determinant
    step[1] = (c1 * x + (a * f - c * c) * y + (b * c - a * e) * t) / determinant
    step[2] = (c2 * x + (b * c - a * e) * y + (a * d - b * b) * t) / determinant


@kernel
def align(
    store: SurfacePoints,
    fan: BeamFan,
    i: int,
    others: NDArray[np.int64],
    poses: NDArray[np.float64],
    pose: NDArray[np.float64],
    prior: NDArray[np.float64],
    nearby: NDArray[np.float64],
    stride: int,
    system: NDArray[np.float64],
) -> None:
    """Move a scan so that it fits others that stay where they are.

    Args:
        store: The scans.
        fan: Their beams.
        i: The scan.
        others: (K,) the others.
        poses: (K, 3) where they are.
        pose: (3,) where it is, to be moved.
        prior: (3,) how surely it is there already: weights [1/m², 1/m², 1/rad²].
        nearby: (rounds,) for each round: points farther apart are none of one surface [m].
        stride: Every so manyth beam is used.
        system: (16,) the last round's in world coordinates, as ``add_pair`` has it; the rest is room to work in.
    """
    motion, step = np.empty(3), np.empty(3)
    local = np.empty(12)
    start = pose.copy()
    for r in range(nearby.shape[0]):
        system[:] = 0.0
        for o in range(others.shape[0]):
            cos, sin = math.cos(poses[o, 2]), math.sin(poses[o, 2])
            dx, dy = pose[0] - poses[o, 0], pose[1] - poses[o, 1]
            motion[0], motion[1], motion[2] = cos * dx + sin * dy, cos * dy - sin * dx, pose[2] - poses[o, 2]
            local[:] = 0.0
            add_pair(store, fan, i, others[o], motion, nearby[r], stride, local)
            _add_turned(system, local, cos, sin)
        for k in range(3):
            system[6 + k] += prior[k] * (pose[k] - start[k])
        solve3(system, prior, step)
        for k in range(3):
            pose[k] += step[k]
        if abs(step[0]) + abs(step[1]) + abs(step[2]) < 1e-4 and r > 2:
            break


@leaf
def _add_turned(total: NDArray[np.float64], s: NDArray[np.float64], cos: float, sin: float) -> None:
    """Add a system of the frame of a pose that is turned by cos, sin, in world coordinates."""
    total[0] += cos * cos * s[0] - 2.0 * cos * sin * s[1] + sin * sin * s[3]
    total[1] += cos * sin * (s[0] - s[3]) + (cos * cos - sin * sin) * s[1]
    total[3] += sin * sin * s[0] + 2.0 * cos * sin * s[1] + cos * cos * s[3]
    total[2] += cos * s[2] - sin * s[4]
    total[4] += sin * s[2] + cos * s[4]
    total[5] += s[5]
    total[6] += cos * s[6] - sin * s[7]
    total[7] += sin * s[6] + cos * s[7]
    for k in range(8, 12):
        total[k] += s[k]
