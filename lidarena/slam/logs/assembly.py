"""From the messages of a file, one by one, to a recorded log: clocks, beams, wheels and mount are looked through."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.beams import BeamLayout, bring_together
from lidarena.slam.logs.clocks import mended_times, numbered_times
from lidarena.slam.logs.odometry_checks import checked_odometry
from lidarena.slam.logs.recorded_log import LogOptions, RecordedLog
from lidarena.slam.planar import wrapped

_MOUNT_SPREAD = 0.02
"""A laser whose pose on the robot varies by more than this [m, rad] is not bolted to it: some logs store a corrected
pose there."""


@dataclass(frozen=True)
class RawScan:
    """A scan as it was stored.

    Attributes:
        ranges: (n,), whatever they mean.
        layout: Of its beams.
        longest: Range from which on there are no returns, infinite if the message does not tell [m].
        mount: (3,) where the laser sits on the robot, if the message tells.
    """

    ranges: NDArray[np.float64]
    layout: BeamLayout
    longest: float = math.inf
    mount: NDArray[np.float64] | None = None


@dataclass
class Assembly:
    """What has been read so far.

    Attributes:
        longest: Range from which on there are no returns [m].
        mount_told: (3,) where the file says for all scans that the laser sits; what the scans tell counts more.
        skipped: Torn messages.
        notes: Sentences for the user.
    """

    times: list[float] = field(default_factory=list)
    odometry: list[Sequence[float]] = field(default_factory=list)
    scan_readings: list[int] = field(default_factory=list)
    scans: list[RawScan] = field(default_factory=list)
    longest: float = math.inf
    mount_told: NDArray[np.float64] | None = None
    skipped: int = 0
    notes: list[str] = field(default_factory=list)

    def add(self, time: float, pose: Sequence[float], scan: RawScan | None) -> None:
        """Enter a message: time stamp [s], the robot's pose by its wheels, and the scan if there is one."""
        if scan is not None:
            self.scan_readings.append(len(self.times))
            self.scans.append(scan)
            self.longest = min(self.longest, scan.longest)
        self.times.append(time)
        self.odometry.append(pose)

    def log(self, name: str, where: str, options: LogOptions) -> RecordedLog:
        """Everything as arrays.

        Args:
            name: Of the file.
            where: What messages call it.
            options: The user's.

        Raises:
            LogError: Time stamps, ranges or beams make no sense.
        """
        stored = np.array(self.times, np.float64)
        times, told = (numbered_times(len(stored)), ()) if options.ignore_times else mended_times(stored, where)
        wheels = checked_odometry(times, np.array(self.odometry, np.float64))
        ranges, layouts = [scan.ranges for scan in self.scans], [scan.layout for scan in self.scans]
        beams = bring_together(ranges, layouts, self.longest, options, where)
        return RecordedLog(
            name=name,
            times=times,
            odometry=wheels.poses,
            scan_readings=np.array(self.scan_readings, np.int64),
            ranges=beams.ranges,
            angles=beams.angles,
            max_range=beams.max_range,
            mount=self._mount(),
            skipped=self.skipped,
            unsure=wheels.unsure if wheels.unsure.any() else np.zeros(0, np.bool_),
            notes=(*self.notes, *told, *beams.notes, *wheels.notes),
        )

    def _mount(self) -> NDArray[np.float64]:
        """Where the laser sits, (3,), if the scans always tell the same place; else what the file says."""
        told = np.zeros(3) if self.mount_told is None else self.mount_told
        mounts = [scan.mount for scan in self.scans if scan.mount is not None]
        middle = _middle(np.array(mounts)) if mounts else None
        return told if middle is None or not np.any(np.abs(middle) > 1e-6) else middle


def _middle(mounts: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Median of poses (n, 3) that are all alike, None if they are not; angles are taken on the circle."""
    turn = math.atan2(float(np.sin(mounts[:, 2]).mean()), float(np.cos(mounts[:, 2]).mean()))
    off = mounts - (0.0, 0.0, turn)
    off[:, 2] = wrapped(off[:, 2])
    middle: NDArray[np.float64] = np.median(off, axis=0)
    if np.abs(off - middle).max() >= _MOUNT_SPREAD:
        return None
    middle[2] = wrapped(np.array(middle[2] + turn))
    return middle
