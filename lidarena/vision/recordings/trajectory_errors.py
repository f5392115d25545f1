"""How far an estimated trajectory is off: KITTI's relative errors, RPE and ATE as ``evo`` has them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.vision.rigid_motion import fit_motion, inverse, moved, vector_of

Floats = NDArray[np.float64]

KITTI_LENGTHS = (100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0)
SHORT_LENGTHS = (10.0, 20.0, 30.0, 40.0, 50.0)
"""Of paths that are shorter than KITTI's shortest [m]."""


@dataclass(frozen=True)
class TrajectoryErrors:
    """How far a trajectory is off.

    Attributes:
        translation: KITTI's relative translational error, a share of the path; NaN where the path is too short.
        rotation: KITTI's relative rotational error [rad/m].
        lengths: Of the parts of the path that these are means over [m].
        ate: Root mean square of the positions' distances after the best rigid alignment [m], ``evo_ape -a``.
        final: Distance at the end, both starting alike [m].
        path: Length of the true path [m].
    """

    translation: float
    rotation: float
    lengths: tuple[float, ...]
    ate: float
    final: float
    path: float


def trajectory_errors(truth: Floats, estimate: Floats) -> TrajectoryErrors:
    """Compare poses (N, 4, 4), camera to world.

    Raises:
        VisionError: They are not as many, or fewer than 3.
    """
    _check_alike(truth, estimate)
    path = path_lengths(truth)
    usual = tuple(length for length in KITTI_LENGTHS if length < path[-1])
    lengths = usual or tuple(length for length in SHORT_LENGTHS if length < path[-1])
    translation, rotation = kitti_errors(truth, estimate, lengths, 10 if usual else 1)
    start = truth[0] @ inverse(estimate[0])
    final = float(np.linalg.norm(moved(start, estimate[-1:, :3, 3]) - truth[-1, :3, 3]))
    return TrajectoryErrors(translation, rotation, lengths, absolute_error(truth, estimate), final, float(path[-1]))


def _check_alike(truth: Floats, estimate: Floats) -> None:
    if len(truth) != len(estimate) or len(truth) < 3:
        raise VisionError(
            f"{len(estimate)} estimated and {len(truth)} true poses; as many of both, 3 at least, are needed"
        )


def path_lengths(poses: Floats) -> Floats:
    """Length of the path up to each pose (N,) [m]."""
    steps = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def kitti_errors(truth: Floats, estimate: Floats, lengths: tuple[float, ...], every: int = 10) -> tuple[float, float]:
    """KITTI's relative errors: the mean, over parts of the path of these lengths, of the error over the length.

    Args:
        truth: (N, 4, 4) camera to world.
        estimate: The same.
        lengths: Of the parts; each ends at the first pose beyond [m].
        every: Parts begin at every so many poses; 10 in KITTI's own program.

    Returns:
        The share of the path, and the angle over it [rad/m]; NaN if the path has no such part.
    """
    path = path_lengths(truth)
    shifts, turns = [], []
    for first in range(0, len(truth), every):
        for length in lengths:
            beyond = np.flatnonzero(path > path[first] + length)
            if not len(beyond):
                continue
            off = _relative_error(truth, estimate, first, int(beyond[0]))
            shifts.append(float(np.linalg.norm(off[:3, 3])) / length)
            turns.append(float(np.linalg.norm(vector_of(off[:3, :3]))) / length)
    return (float(np.mean(shifts)), float(np.mean(turns))) if shifts else (float("nan"), float("nan"))


def _relative_error(truth: Floats, estimate: Floats, first: int, last: int) -> Floats:
    true, found = inverse(truth[first]) @ truth[last], inverse(estimate[first]) @ estimate[last]
    return np.asarray(inverse(true) @ found)


def relative_pose_errors(truth: Floats, estimate: Floats, delta: float, tolerance: float = 0.1) -> Floats:
    """Translational RPE [m] over all parts of the path of length ``delta``, ``evo_rpe -d DELTA -u m --all_pairs``.

    Args:
        truth: (N, 4, 4) camera to world; the path is measured along it.
        estimate: The same.
        delta: [m].
        tolerance: A part may be longer or shorter by this share.
    """
    _check_alike(truth, estimate)
    path = path_lengths(truth)
    errors = []
    for first in range(len(truth) - 1):
        ahead = path[first + 1 :] - path[first]
        nearest = int(np.argmin(np.abs(ahead - delta)))
        if abs(ahead[nearest] - delta) <= tolerance * delta:
            off = _relative_error(truth, estimate, first, first + 1 + nearest)
            errors.append(float(np.linalg.norm(off[:3, 3])))
    return np.array(errors)


def absolute_error(truth: Floats, estimate: Floats) -> float:
    """ATE: root mean square of the distances after the best rigid alignment [m], ``evo_ape -a``."""
    _check_alike(truth, estimate)
    there, here = truth[:, :3, 3], estimate[:, :3, 3]
    off = moved(fit_motion(here, there), here) - there
    return float(np.sqrt(np.square(off).sum(axis=1).mean()))
