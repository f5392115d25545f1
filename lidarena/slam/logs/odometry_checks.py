"""Odometry that no robot can have driven: zeros, resets and jumps, found and taken out of the way of the wheels."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.planar import between, compose, wrapped

_SPEED, _TURN_RATE = 3.0, 4.0
"""Faster than this no robot with a laser drives indoors [m/s, rad/s]."""
_STEP, _TURN = 1.0, 1.5
"""Motions from one reading to the next that are believed whatever the clock says [m, rad]."""
_ZERO_STEP = 0.3
"""A reading at exactly (0, 0, 0) is believed if the one before is this near [m, rad]."""
_MOST_WILD = 0.05
"""With a larger share of motions that no robot can drive, none is believed."""
_LONGEST_OUTLIER = 20
"""So many readings may be wrong until the odometry goes on where it was."""


class CheckedOdometry(NamedTuple):
    """A way of the wheels without jumps.

    Attributes:
        poses: (R, 3), each jump replaced by standing still.
        unsure: (R,) bool; the motion that leads to a reading is not known.
        notes: Sentences on what was found.
    """

    poses: NDArray[np.float64]
    unsure: NDArray[np.bool_]
    notes: tuple[str, ...]


def checked_odometry(times: NDArray[np.float64], poses: NDArray[np.float64]) -> CheckedOdometry:
    """Look through the wheels' way (R, 3) for what no robot can have driven, and take it out.

    Single readings that are far off are put between their neighbours. After a jump or a reset the way goes on from
    where it was, and the motion at the jump is marked as not known, so that scan matching looks for it farther away.
    """
    unsure = np.zeros(len(poses), np.bool_)
    if len(poses) > 1 and np.ptp(poses, axis=0).max() <= 1e-9:
        unsure[1:] = True
        note = "the odometry says that the robot never moved; its way is found by scan matching alone"
        return CheckedOdometry(poses, unsure, (note,))
    wild = int(np.sum(_implausible(times, poses)))
    if wild > _MOST_WILD * len(poses):
        note = (
            f"{wild:,} of {len(poses) - 1:,} motions of the odometry are such as no robot can drive (is it in metres "
            "and radians?); it is left out, and the way is found by scan matching alone"
        )
        return CheckedOdometry(np.tile(poses[:1], (len(poses), 1)), np.arange(len(poses)) > 0, (note,))
    mended, outliers = _without_outliers(times, poses)
    jumps = np.flatnonzero(_implausible(times, mended)) + 1
    if len(jumps):
        mended = _without_jumps(mended, jumps)
        unsure[jumps] = True
    notes = []
    if outliers:
        notes.append(f"{outliers:,} odometry readings are far off those around them; they were put between these")
    for jump in jumps[:3]:
        steps = between(poses[jump - 1], poses[jump])
        notes.append(
            f"the odometry jumps by {math.hypot(steps[0], steps[1]):.1f} m and {math.degrees(abs(steps[2])):.0f}° at "
            f"{times[jump]:.1f} s (reading {jump + 1:,}); scan matching has to bridge it"
        )
    if len(jumps) > 3:
        notes.append(f"{len(jumps) - 3:,} more jumps of the odometry follow; the map is likely torn")
    return CheckedOdometry(mended, unsure, tuple(notes))


def _implausible(times: NDArray[np.float64], poses: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which motions (R - 1,) from one reading to the next no robot can have made."""
    return _too_far(poses[:-1], poses[1:], np.maximum(np.diff(times), 0.0))


def _too_far(
    first: NDArray[np.float64], second: NDArray[np.float64], seconds: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether no robot came from one pose (n, 3) to the other in so many seconds (n,)."""
    away = np.hypot(second[:, 0] - first[:, 0], second[:, 1] - first[:, 1])
    turned = np.abs(wrapped(second[:, 2] - first[:, 2]))
    far = (away > _STEP + _SPEED * seconds) | (turned > _TURN + _TURN_RATE * seconds)
    # a reset or an unset line: exactly zero, though the robot was elsewhere a moment ago
    zeroed = (np.all(second == 0.0, axis=1) != np.all(first == 0.0, axis=1)) & (np.maximum(away, turned) > _ZERO_STEP)
    return np.asarray(far | zeroed, np.bool_)


def _without_outliers(times: NDArray[np.float64], poses: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """Put short runs of readings that the odometry comes back from between those around them; also how many."""
    jumps = [int(jump) + 1 for jump in np.flatnonzero(_implausible(times, poses))]
    mended, count, done = poses.copy(), 0, 0
    for jump in jumps:
        last = jump - 1
        # the way comes back by a jump, or it only went on from where it had jumped to
        for back in (k for k in jumps if max(jump, done) < k <= jump + _LONGEST_OUTLIER):
            seconds = np.array([max(times[back] - times[last], 0.0)])
            if last >= done and not _too_far(poses[last : last + 1], poses[back : back + 1], seconds)[0]:
                share = np.arange(1.0, back - last)[:, None] / (back - last)
                motion = between(poses[last], poses[back])
                mended[jump:back] = compose(np.broadcast_to(poses[last], (len(share), 3)), share * motion)
                count, done = count + len(share), back
                break
    return mended, count


def _without_jumps(poses: NDArray[np.float64], jumps: NDArray[np.int64]) -> NDArray[np.float64]:
    """The same way (R, 3) with every motion that leads to one of the readings ``jumps`` left out."""
    whole = poses.copy()
    for jump, following in zip(jumps, [*jumps[1:], len(poses)], strict=True):
        part = between(np.broadcast_to(poses[jump], (following - jump, 3)), poses[jump:following])
        whole[jump:following] = compose(np.broadcast_to(whole[jump - 1], part.shape), part)
    return whole
