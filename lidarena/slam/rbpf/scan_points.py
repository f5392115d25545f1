"""From a scan to the points that are matched: neighbouring beams averaged, with the surface's normal at each."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.rbpf.likelihood_field import SECTORS
from lidarena.slam.rbpf.point_blocks import BLOCK


class PointParameters(NamedTuple):
    """How points are made of a scan; the defaults are for a lidar with a beam a degree and a few metres of range.

    Attributes:
        spacing: Beams are averaged over this length of wall [m]; a cell's side, more points would say nothing new.
        jump: Consecutive hits farther apart than this belong to different surfaces [m] …
        jump_spread: … or than this many times their range, if that is more.
        normal_window: A normal is fitted to the points this far to both sides [m] …
        normal_spread: … or this many times their range, if that is more: beams that are far apart there still meet.
        flatness: Largest ratio of the fitted points' variances across and along the wall; corners exceed it and get no
            normal.
    """

    spacing: float = 0.05
    jump: float = 0.2
    jump_spread: float = 0.0
    normal_window: float = 0.16
    normal_spread: float = 0.0
    flatness: float = 0.08


def points_for(increment: float, jump_beams: float = 2.9, normal_beams: float = 2.6) -> PointParameters:
    """Settings for a lidar whose beams are so far apart; with a beam a degree nothing changes within 3.5 m.

    Args:
        increment: Angle between two beams [rad].
        jump_beams: Hits on one surface are at most this many beam spacings apart.
        normal_beams: A wall's normal is fitted over at least this many beam spacings to both sides.
    """
    return PointParameters(jump_spread=jump_beams * increment, normal_spread=normal_beams * increment)


@leaf
def extract_points(
    scan: NDArray[np.float32],
    directions: NDArray[np.float64],
    max_range: float,
    parameters: PointParameters,
    first: int,
    stride: int,
    means: NDArray[np.float64],
    surface: NDArray[np.int64],
    points: NDArray[np.float64],
    flat: NDArray[np.bool_],
) -> int:
    """Average a scan's hits into points and fit normals; returns how many points there are.

    Args:
        scan: (beams,) ranges [m]; ``max_range`` and above means no return.
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: [m].
        parameters: Settings.
        first: First averaged point that is wanted.
        stride: From there on one of so many; the normals come from all.
        means: (beams, 2) work space, the averaged points.
        surface: (beams,) work space, number of the unbroken surface that each lies on.
        points: (blocks, 5, BLOCK) output in the sensor's frame: x, y [m], unit normal towards the sensor (where
            ``flat`` is False it only points back along the beam), and the normal's direction in sectors
            (``likelihood_field.SECTORS`` to the turn).
        flat: (beams,) output, whether the normal was fitted.
    """
    total = _average_hits(scan, directions, max_range, parameters, means, surface)
    count = 0
    for i in range(first, total, stride):
        block, lane = count // BLOCK, count % BLOCK
        point = points[block, :, lane]
        flat[count] = _fit_normal(i, total, parameters, means, surface, point)
        point[4] = math.atan2(point[3], point[2]) * (SECTORS / (2.0 * math.pi))
        count += 1
    return count


@leaf
def _average_hits(
    scan: NDArray[np.float32],
    directions: NDArray[np.float64],
    max_range: float,
    parameters: PointParameters,
    means: NDArray[np.float64],
    surface: NDArray[np.int64],
) -> int:
    """Average runs of hits shorter than the spacing; ``surface`` (beams,) numbers the unbroken surfaces."""
    count = number = members = 0
    first_x = first_y = last_x = last_y = sum_x = sum_y = 0.0
    for k in range(scan.shape[0]):
        hit = scan[k] < max_range and scan[k] > 0.0
        x, y = scan[k] * directions[0, k], scan[k] * directions[1, k]
        apart = max(parameters.jump, parameters.jump_spread * scan[k])
        jump = members > 0 and (x - last_x) ** 2 + (y - last_y) ** 2 > apart * apart
        full = members > 0 and (x - first_x) ** 2 + (y - first_y) ** 2 >= parameters.spacing * parameters.spacing
        if members > 0 and (jump or full or not hit):
            means[count, 0], means[count, 1] = sum_x / members, sum_y / members
            surface[count] = number
            count += 1
            members = 0
            if jump or not hit:
                number += 1
        if hit:
            if members == 0:
                first_x, first_y, sum_x, sum_y = x, y, 0.0, 0.0
            sum_x, sum_y, last_x, last_y = sum_x + x, sum_y + y, x, y
            members += 1
    if members > 0:
        means[count, 0], means[count, 1] = sum_x / members, sum_y / members
        surface[count] = number
        count += 1
    return count


@leaf
def _fit_normal(
    i: int,
    count: int,
    parameters: PointParameters,
    means: NDArray[np.float64],
    surface: NDArray[np.int64],
    point: NDArray[np.float64],
) -> bool:
    """Fit a line to the neighbours of mean ``i`` on its surface; returns False where they are too few or bent.

    ``point`` (5,) takes the place and the normal.
    """
    px, py = means[i, 0], means[i, 1]
    point[0], point[1] = px, py
    away = max(math.sqrt(px * px + py * py), 1e-9)
    point[2], point[3] = -px / away, -py / away
    window = max(parameters.normal_window, parameters.normal_spread * away)
    n, sx, sy, sxx, sxy, syy = 0, 0.0, 0.0, 0.0, 0.0, 0.0
    for step in (-1, 1):
        j = i if step == -1 else i + 1
        while 0 <= j < count and surface[j] == surface[i]:
            dx, dy = means[j, 0] - px, means[j, 1] - py
            if dx * dx + dy * dy > window * window:
                break
            n += 1
            sx, sy = sx + dx, sy + dy
            sxx, sxy, syy = sxx + dx * dx, sxy + dx * dy, syy + dy * dy
            j += step
    if n < 3:
        return False
    sxx, sxy, syy = sxx / n - sx * sx / (n * n), sxy / n - sx * sy / (n * n), syy / n - sy * sy / (n * n)
    mean, half = 0.5 * (sxx + syy), 0.5 * (sxx - syy)
    root = math.sqrt(half * half + sxy * sxy)
    if mean - root > parameters.flatness * (mean + root):
        return False
    # the eigenvector of the smaller eigenvalue, from whichever row of the matrix determines it better
    nx, ny = (sxy, -half - root) if half > 0.0 else (half - root, sxy)
    length = math.sqrt(nx * nx + ny * ny)
    if length == 0.0:
        return False
    if nx * px + ny * py > 0.0:
        length = -length
    point[2], point[3] = nx / length, ny / length
    return True
