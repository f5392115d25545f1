"""Where the wheels do not tell the way of a log, and whether scan matching has bridged it."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.recorded_log import RecordedLog

_FOUND = 0.55
"""From this score of its match on, a scan after a gap is believed to be where it was found."""
_MANY = 0.02
"""Share of the scans without wheels that may match badly before the map is in doubt."""


def unsure_scans(log: RecordedLog) -> NDArray[np.bool_]:
    """Which scans (S,) came after a motion since the scan before that the wheels did not tell."""
    if not len(log.unsure):
        return np.zeros(len(log.scan_readings), np.bool_)
    so_far = np.concatenate([[0], np.cumsum(log.unsure)])
    before = np.concatenate([[0], log.scan_readings[:-1] + 1])
    unsure: NDArray[np.bool_] = so_far[log.scan_readings + 1] > so_far[before]
    unsure[:1] = False
    return unsure


def unbridged(log: RecordedLog, unsure: NDArray[np.bool_], scores: Sequence[float]) -> list[str]:
    """Sentences on where scan matching has not found the way on.

    Args:
        log: The log.
        unsure: (S,) see ``unsure_scans``.
        scores: (S,) how well each scan fitted, 0 to 1.
    """
    lost = np.flatnonzero(unsure & (np.asarray(scores) < _FOUND))
    if not len(lost):
        return []
    time = log.times[log.scan_readings[lost[0]]]
    if unsure[1:].all():
        if len(lost) < _MANY * len(unsure):
            return []
        return [
            f"without odometry {len(lost):,} of {len(unsure):,} scans fit badly to the ones before, the first at "
            f"{time:.1f} s; the map is likely torn"
        ]
    return [
        f"at {len(lost)} of {int(unsure.sum())} places where the odometry jumps the scans do not tell the way on, the "
        f"first at {time:.1f} s; the map is likely torn there"
    ]
