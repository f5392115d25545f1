"""Bundle adjustment of a few stereo views: poses and points that fit the pixels of all images best."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.vision.camera import StereoCamera
from lidarena.vision.rigid_motion import write_rotation

Floats = NDArray[np.float64]

_STEPS = 20
_ENOUGH = 1e-7
"""Relative decrease of the cost below which the adjustment ends."""


class Observations(NamedTuple):
    """Pixels of points in stereo views, those of a point one after the other.

    Attributes:
        first: (points + 1,) where the observations of each point begin.
        frame: (M,) number of the view.
        pixels: (M, 4) u, v of the left and u, v of the right image [pixels].
        sigma: (M, 2) standard deviation of a left and of a right coordinate [pixels]; infinite where the right image
            was not matched.
    """

    first: NDArray[np.int64]
    frame: NDArray[np.int64]
    pixels: Floats
    sigma: Floats


class Adjusted(NamedTuple):
    """What an adjustment came to.

    Attributes:
        poses: (views, 4, 4) world to camera.
        points: (points, 3) in the world [m].
        covariance: (6 free views, 6 free views) of the free views' poses, for pixels of the standard deviation that was
            given; rotation vector and translation after each pose, ``X' = exp(w) X + t``.
        errors: (M,) root mean square of each observation's residuals over its standard deviation.
    """

    poses: Floats
    points: Floats
    covariance: Floats
    errors: Floats


class _Normal(NamedTuple):
    """Normal equations: of the poses, of each point, and what ties them together."""

    poses: Floats
    right: Floats
    points: Floats
    point_right: Floats
    ties: Floats


def adjust(
    camera: StereoCamera,
    poses: Floats,
    points: Floats,
    seen: Observations,
    *,
    fixed: int = 1,
    huber: float = 2.0,
    row_weight: float = 1.0,
) -> Adjusted:
    """Fit poses and points to pixels: Levenberg-Marquardt on Huber's loss, points eliminated (Schur complement).

    Args:
        camera: Of all views.
        poses: (views, 4, 4) world to camera, to begin with.
        points: (points, 3) in the world, in front of all views that see them.
        seen: The pixels.
        fixed: The first so many views stay where they are.
        huber: Residuals above so many standard deviations count linearly only.
        row_weight: Of the right image's row; 0 where it was not measured apart from the left one's.
    """
    optics = np.array([camera.focal, camera.center_x, camera.center_y, camera.baseline, row_weight])
    poses, points = poses.copy(), points.copy()
    covariance, errors = _adjust(optics, poses, points, seen, fixed, huber)
    return Adjusted(poses, points, covariance, errors)


@leaf
def _residual(optics: Floats, point: Floats, pixels: Floats, out: Floats) -> bool:
    """Write what is seen less what is expected (4,) of a point in the camera's frame; False if it is behind."""
    ahead = point[2]
    if ahead < 1e-3:
        return False
    left = optics[0] * point[0] / ahead + optics[1]
    row = optics[0] * point[1] / ahead + optics[2]
    out[0], out[1] = pixels[0] - left, pixels[1] - row
    out[2], out[3] = pixels[2] - (left - optics[0] * optics[3] / ahead), pixels[3] - row
    return True


@leaf
def _to_camera(pose: Floats, point: Floats, out: Floats) -> None:
    for i in range(3):
        out[i] = pose[i, 0] * point[0] + pose[i, 1] * point[1] + pose[i, 2] * point[2] + pose[i, 3]


@kernel
def _cost(optics: Floats, poses: Floats, points: Floats, seen: Observations, huber: float, errors: Floats) -> float:
    total, residual, local = 0.0, np.empty(4), np.empty(3)
    for point in range(len(points)):
        for k in range(seen.first[point], seen.first[point + 1]):
            _to_camera(poses[seen.frame[k]], points[point], local)
            if not _residual(optics, local, seen.pixels[k], residual):
                errors[k] = 1e6
                total += 1e12
                continue
            left, right = 1.0 / seen.sigma[k, 0], 1.0 / seen.sigma[k, 1]
            square = (residual[0] ** 2 + residual[1] ** 2) * left * left
            square += (residual[2] ** 2 + optics[4] * residual[3] ** 2) * right * right
            errors[k] = np.sqrt(square / (3.0 + optics[4]))
            total += 0.5 * square if errors[k] < huber else (3.0 + optics[4]) * huber * (errors[k] - 0.5 * huber)
    return total


@kernel
def _accumulate(
    optics: Floats, poses: Floats, points: Floats, seen: Observations, fixed: int, huber: float, normal: _Normal
) -> None:
    """Fill the normal equations at the present poses and points."""
    normal.poses[:], normal.right[:], normal.points[:] = 0.0, 0.0, 0.0
    normal.point_right[:], normal.ties[:] = 0.0, 0.0
    residual, local, jp, jx = np.empty(4), np.empty(3), np.zeros((4, 6)), np.zeros((4, 3))
    weights = np.empty(4)
    for point in range(len(points)):
        for k in range(seen.first[point], seen.first[point + 1]):
            view = seen.frame[k]
            pose = poses[view]
            _to_camera(pose, points[point], local)
            if not _residual(optics, local, seen.pixels[k], residual):
                continue
            left, right = 1.0 / seen.sigma[k, 0] ** 2, 1.0 / seen.sigma[k, 1] ** 2
            square = (residual[0] ** 2 + residual[1] ** 2) * left
            square += (residual[2] ** 2 + optics[4] * residual[3] ** 2) * right
            size = np.sqrt(square / (3.0 + optics[4]))
            trust = 1.0 if size < huber else huber / size
            weights[0] = weights[1] = trust * left
            weights[2], weights[3] = trust * right, trust * right * optics[4]
            _derivatives(optics, pose, local, jp, jx)
            _add(weights, residual, jp, jx, point, k, view - fixed, normal)


@leaf
def _derivatives(optics: Floats, pose: Floats, local: Floats, jp: Floats, jx: Floats) -> None:
    """Derivatives of the four pixels by the pose's rotation and translation (4, 6) and by the point (4, 3)."""
    x, y, z = local[0], local[1], local[2]
    scale = optics[0] / z
    for row in range(4):
        along = 0.0 if row in (1, 3) else 1.0
        shift = x - optics[3] if row == 2 else x
        dx, dy = along * scale, (1.0 - along) * scale
        dz = -scale * (shift if row in (0, 2) else y) / z
        jp[row, 0], jp[row, 1], jp[row, 2] = dz * y - dy * z, dx * z - dz * x, dy * x - dx * y
        jp[row, 3], jp[row, 4], jp[row, 5] = dx, dy, dz
        for i in range(3):
            jx[row, i] = dx * pose[0, i] + dy * pose[1, i] + dz * pose[2, i]


@leaf
def _add(
    weights: Floats, residual: Floats, jp: Floats, jx: Floats, point: int, k: int, free: int, normal: _Normal
) -> None:
    for row in range(4):
        weight, rest = weights[row], residual[row]
        for i in range(3):
            normal.point_right[point, i] += weight * jx[row, i] * rest
            for j in range(3):
                normal.points[point, i, j] += weight * jx[row, i] * jx[row, j]
        if free < 0:
            continue
        base = 6 * free
        for i in range(6):
            normal.right[base + i] += weight * jp[row, i] * rest
            for j in range(6):
                normal.poses[base + i, base + j] += weight * jp[row, i] * jp[row, j]
            for j in range(3):
                normal.ties[k, i, j] += weight * jp[row, i] * jx[row, j]


@leaf
def _invert(block: Floats, damping: float, out: Floats) -> None:
    """Write the inverse of a symmetric 3 × 3 block whose diagonal has grown by the damping."""
    a, b, c = block[0, 0] * (1.0 + damping) + 1e-12, block[0, 1], block[0, 2]
    d, e, f = block[1, 1] * (1.0 + damping) + 1e-12, block[1, 2], block[2, 2] * (1.0 + damping) + 1e-12
    p, q, r = d * f - e * e, c * e - b * f, b * e - c * d
    scale = 1.0 / (a * p + b * q + c * r)
    out[0, 0], out[0, 1], out[0, 2] = p * scale, q * scale, r * scale
    out[1, 1], out[1, 2], out[2, 2] = (a * f - c * c) * scale, (b * c - a * e) * scale, (a * d - b * b) * scale
    out[1, 0], out[2, 0], out[2, 1] = out[0, 1], out[0, 2], out[1, 2]


@leaf
def _eliminate(
    seen: Observations, fixed: int, damping: float, normal: _Normal, inverses: Floats, left: Floats, right: Floats
) -> None:
    """Take the points out of the poses' normal equations; fills ``inverses`` (points, 3, 3)."""
    for point in range(inverses.shape[0]):
        _invert(normal.points[point], damping, inverses[point])
        for k in range(seen.first[point], seen.first[point + 1]):
            a = 6 * (seen.frame[k] - fixed)
            if a < 0:
                continue
            for i in range(6):
                part_0, part_1, part_2 = 0.0, 0.0, 0.0
                for d in range(3):
                    tie = normal.ties[k, i, d]
                    part_0 += tie * inverses[point, d, 0]
                    part_1 += tie * inverses[point, d, 1]
                    part_2 += tie * inverses[point, d, 2]
                rest = normal.point_right[point]
                right[a + i] -= part_0 * rest[0] + part_1 * rest[1] + part_2 * rest[2]
                for other in range(seen.first[point], seen.first[point + 1]):
                    b = 6 * (seen.frame[other] - fixed)
                    if b < 0:
                        continue
                    for j in range(6):
                        ties = normal.ties[other, j]
                        left[a + i, b + j] -= part_0 * ties[0] + part_1 * ties[1] + part_2 * ties[2]


@kernel
def _reduce(seen: Observations, fixed: int, damping: float, normal: _Normal, inverses: Floats) -> tuple[Floats, Floats]:
    """The normal equations of the poses alone; fills ``inverses`` (points, 3, 3)."""
    left, right = normal.poses.copy(), normal.right.copy()
    for i in range(len(right)):
        left[i, i] *= 1.0 + damping
    _eliminate(seen, fixed, damping, normal, inverses, left, right)
    return left, right


@kernel
def _moved_by(
    step: Floats, seen: Observations, fixed: int, normal: _Normal, inverses: Floats, poses: Floats, points: Floats
) -> tuple[Floats, Floats]:
    """The poses and points after a step (6 free,) of the poses, points following."""
    new_poses, new_points = poses.copy(), points.copy()
    turn = np.empty((3, 3))
    for view in range(fixed, len(poses)):
        part = step[6 * (view - fixed) : 6 * (view - fixed) + 6]
        write_rotation(part[0], part[1], part[2], turn)
        new_poses[view, :3] = turn @ poses[view, :3]
        new_poses[view, :3, 3] += part[3:]
    rest = np.empty(3)
    for point in range(len(points)):
        rest[:] = normal.point_right[point]
        for k in range(seen.first[point], seen.first[point + 1]):
            a = 6 * (seen.frame[k] - fixed)
            if a >= 0:
                for i in range(6):
                    for d in range(3):
                        rest[d] -= normal.ties[k, i, d] * step[a + i]
        for i in range(3):
            for d in range(3):
                new_points[point, i] += inverses[point, i, d] * rest[d]
    return new_poses, new_points


@kernel
def _adjust(
    optics: Floats, poses: Floats, points: Floats, seen: Observations, fixed: int, huber: float
) -> tuple[Floats, Floats]:
    size = 6 * (len(poses) - fixed)
    normal = _Normal(
        np.zeros((size, size)), np.zeros(size), np.zeros((len(points), 3, 3)), np.zeros((len(points), 3)),
        np.zeros((len(seen.frame), 6, 3)),
    )  # fmt: skip
    inverses, errors = np.zeros((len(points), 3, 3)), np.zeros(len(seen.frame))
    cost, damping = _cost(optics, poses, points, seen, huber, errors), 1e-4
    _accumulate(optics, poses, points, seen, fixed, huber, normal)
    for _ in range(_STEPS):
        left, right = _reduce(seen, fixed, damping, normal, inverses)
        step = np.linalg.solve(left + 1e-12 * np.eye(size), right)
        new_poses, new_points = _moved_by(step, seen, fixed, normal, inverses, poses, points)
        new_cost = _cost(optics, new_poses, new_points, seen, huber, errors)
        if not new_cost < cost:
            damping *= 10.0
            if damping > 1e4:
                break
            continue
        gain = (cost - new_cost) / max(cost, 1e-12)
        poses[...], points[...], cost, damping = new_poses, new_points, new_cost, max(0.1 * damping, 1e-9)
        _accumulate(optics, poses, points, seen, fixed, huber, normal)
        if gain < _ENOUGH:
            break
    left, right = _reduce(seen, fixed, 0.0, normal, inverses)
    _cost(optics, poses, points, seen, huber, errors)
    return np.linalg.inv(left + 1e-9 * np.eye(size)).astype(np.float64), errors
