"""A recorded log as arrays, whatever file it came from, and what a user may tell a reader of such files."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import LidarenaError

RANGE_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
"""Units in which ranges may be stored [m]."""


class LogError(LidarenaError):
    """A recorded log that is missing, torn or contradicts itself, or relations that are not this log's."""


@dataclass(frozen=True)
class LogOptions:
    """What a file does not tell, or tells wrongly.

    Attributes:
        skip_torn: Leave torn lines or messages out instead of refusing the log.
        keep_cut: Keep what stands before the place where a file was cut off.
        max_range: Ranges from here on are no returns [m]; None goes by the file.
        field_of_view: Of a ``FLASER``'s beams [rad]; None goes by the file.
        range_unit: Of the ranges, see ``RANGE_UNITS``.
        ignore_times: Number the readings 0.1 s apart, whatever their stamps say.
        scan_topic: Of a rosbag; None takes the one there is.
        odometry_topic: Of a rosbag, of ``nav_msgs/Odometry`` or ``/tf``; ``"none"`` for no odometry; None guesses.

    Raises:
        LogError: A value is out of range.
    """

    skip_torn: bool = False
    keep_cut: bool = False
    max_range: float | None = None
    field_of_view: float | None = None
    range_unit: str = "m"
    ignore_times: bool = False
    scan_topic: str | None = None
    odometry_topic: str | None = None

    def __post_init__(self) -> None:
        if self.max_range is not None and not 0.1 <= self.max_range <= 1000.0:
            raise LogError(f"the longest range is {self.max_range:g} m; 0.1 to 1000 m are allowed")
        if self.field_of_view is not None and not 0.01 <= self.field_of_view <= 2.0 * math.pi + 1e-6:
            wide = math.degrees(self.field_of_view)
            raise LogError(f"the field of view is {wide:g}°; up to 360° are allowed")
        if self.range_unit not in RANGE_UNITS:
            raise LogError(f"ranges in {self.range_unit!r} are not known; {', '.join(RANGE_UNITS)} are allowed")


@dataclass(frozen=True)
class RecordedLog:
    """A log of ``R`` readings, ``S`` of which came with a scan of ``B`` beams.

    Scans whose beams lie otherwise than most are brought onto the beams of most, see ``lidarena.slam.logs.beams``.

    Attributes:
        name: Of the file.
        times: (R,) time stamps in the order of the log [s].
        odometry: (R, 3) the robot's pose by its wheels alone [m, m, rad].
        scan_readings: (S,) which readings have a scan, ascending.
        ranges: (S, B) float32 [m]; 0 where nothing was measured, ``max_range`` or more where nothing returned.
        angles: (B,) the beams' directions in the laser's frame, counter-clockwise [rad].
        max_range: Ranges from here on are no returns [m].
        mount: (3,) where the laser sits on the robot [m, m, rad].
        skipped: Torn lines that were left out because the caller asked for it.
        unsure: (R,) readings whose motion from the reading before the wheels did not tell; empty if there are none.
        notes: What a reader should know: sentences on what was mended or guessed.
    """

    name: str
    times: NDArray[np.float64]
    odometry: NDArray[np.float64]
    scan_readings: NDArray[np.int64]
    ranges: NDArray[np.float32]
    angles: NDArray[np.float64]
    max_range: float
    mount: NDArray[np.float64]
    skipped: int = 0
    unsure: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))
    notes: tuple[str, ...] = ()

    @property
    def has_odometry(self) -> bool:
        """Whether the wheels ever tell that the robot moved."""
        return bool(np.ptp(self.odometry, axis=0).max() > 1e-9)
