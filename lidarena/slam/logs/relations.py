"""Relations: true motions between pairs of moments of a log, by which SLAM is measured (Kümmerle et al. 2009).

A relation compares where the robot was at one time, seen from where it was at another, with the truth: what counts is
whether places that the robot came to twice fit, not how far a whole map has bent.
"""

import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.carmen import LogError
from lidarena.slam.logs.trajectory import interpolated
from lidarena.slam.planar import between, wrapped

TIME_SLACK = 1.0
"""A relation belongs to a log if a pose is this near to both of its times [s]."""
_SAME_STAMP = 2e-6
"""Stamps that differ by no more are the same, written with six digits [s]."""


@dataclass(frozen=True)
class Relations:
    """``K`` relations.

    Attributes:
        name: Of the file.
        times: (K, 2) of the two poses [s].
        motions: (K, 3) pose at the second time in the frame of the pose at the first [m, m, rad].
    """

    name: str
    times: NDArray[np.float64]
    motions: NDArray[np.float64]


@dataclass(frozen=True)
class RelationErrors:
    """How far a trajectory is from ``K`` relations.

    Attributes:
        translation: (K,) [m].
        rotation: (K,) [rad], at least 0.
        unused: Relations with a time at which the trajectory has no pose.
    """

    translation: NDArray[np.float64]
    rotation: NDArray[np.float64]
    unused: int

    def __str__(self) -> str:
        degrees = np.degrees(self.rotation)
        left = f" ({self.unused:,} more have no pose at their times)" if self.unused else ""
        return (
            f"{len(self.translation):,} relations: translation {self.translation.mean():.4f} ± "
            f"{self.translation.std():.4f} m, rotation {degrees.mean():.2f} ± {degrees.std():.2f}°{left}"
        )


def read_relations(path: str | os.PathLike[str]) -> Relations:
    """Read lines of ``t1 t2 dx dy dz roll pitch yaw``.

    Raises:
        LogError: The file is missing, empty or torn.
    """
    where = f"relations {os.fspath(path)!r}"
    try:
        lines = Path(path).read_text(encoding="latin-1").splitlines()
    except OSError as error:
        raise LogError(f"{where} cannot be read: {error.strerror}") from error
    rows = []
    for number, line in enumerate(lines, start=1):
        words = line.split()
        if words and not words[0].startswith("#"):
            rows.append(_row(words, f"line {number} of {where} is torn"))
    if not rows:
        raise LogError(f"{where} holds no relations; lines of t1 t2 dx dy dz roll pitch yaw are needed")
    table = np.array(rows)
    return Relations(Path(path).name, table[:, :2], table[:, [2, 3, 7]])


def _row(words: list[str], torn: str) -> list[float]:
    try:
        row = [float(word) for word in words]
    except ValueError:
        row = []
    if len(row) != 8 or not all(math.isfinite(value) for value in row):
        raise LogError(f"{torn}; eight numbers are needed, t1 t2 dx dy dz roll pitch yaw")
    return row


def check_overlap(relations: Relations, times: NDArray[np.float64], log: str) -> None:
    """Refuse relations of which none belongs to a trajectory or log with these ``times`` (R,).

    Raises:
        LogError: They are another log's.
    """
    if not _belonging(relations, np.sort(times)).any():
        a, b = relations.times.min(), relations.times.max()
        raise LogError(
            f"relations {relations.name!r} belong to another log than {log!r}: their times are {a:.0f} to {b:.0f} s, "
            f"the log's {times.min():.0f} to {times.max():.0f} s"
        )


def relation_errors(
    times: NDArray[np.float64], poses: NDArray[np.float64], relations: Relations, log: str = "the trajectory"
) -> RelationErrors:
    """Compare a trajectory with relations, at their times, between whose neighbouring poses it is interpolated.

    Args:
        times: (R,) ascending [s].
        poses: (R, 3).
        relations: What is true.
        log: What messages call the trajectory.

    Raises:
        LogError: None of the relations belongs to it.
    """
    check_overlap(relations, times, log)
    used = _belonging(relations, times)
    first, second = (_poses_at(times, poses, relations.times[used, end]) for end in (0, 1))
    error = between(relations.motions[used], between(first, second))
    return RelationErrors(np.hypot(error[:, 0], error[:, 1]), np.abs(wrapped(error[:, 2])), int(np.sum(~used)))


def _poses_at(
    times: NDArray[np.float64], poses: NDArray[np.float64], wanted: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Poses (n, 3) at the ``wanted`` times (n,): the first with exactly that stamp, or between the neighbours."""
    nearest = _nearest(times, wanted)
    exact = np.abs(times[nearest] - wanted) <= _SAME_STAMP
    found: NDArray[np.float64] = np.where(exact[:, None], poses[nearest], interpolated(times, poses, wanted))
    return found


def _belonging(relations: Relations, times: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which relations (K,) have a pose near both of their times."""
    away = np.abs(times[_nearest(times, relations.times)] - relations.times)
    near: NDArray[np.bool_] = np.all(away <= TIME_SLACK, axis=1)
    return near


def _nearest(times: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.int64]:
    """Index of the time nearest to each wanted one."""
    after = np.clip(np.searchsorted(times, wanted), 1 if len(times) > 1 else 0, len(times) - 1)
    before = np.maximum(after - 1, 0)
    nearest: NDArray[np.int64] = np.where(wanted - times[before] <= times[after] - wanted, before, after)
    return nearest
