"""CARMEN logs: what a robot's wheels and its laser reported, line by line (gzip too), read and written.

Read are ``ODOM``, ``FLASER`` (the old message of a front laser) and ``ROBOTLASER1`` (the new one, which tells its own
angles); ``PARAM robot_front_laser_max`` tells which ranges are no returns. Other messages are passed over.
"""

import gzip
import math
import os
import re
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import LidarenaError
from lidarena.base.files import write_bytes
from lidarena.slam.planar import between

CLOCK_SLACK = 1.0
"""How far back the clock may jump from one reading to the next [s]. Clocks of real logs stutter (Intel's goes back by
up to 0.9 s, 629 times); more than this is another recording."""
_GZIP = b"\x1f\x8b"
_KEYWORD = re.compile(r"[A-Z][A-Z0-9_]*\Z")
_MAX_BEAMS = 20_000
_PLANET = 1e8
"""No robot's odometry says more, in metres or radians."""
_FARTHEST = float(np.finfo(np.float32).max)
"""Ranges are kept in single precision, where a larger one would be infinite [m]."""
_MOUNT_SPREAD = 0.02
"""A laser whose pose on the robot varies by more than this [m, rad] is not bolted to it: some logs store a corrected
pose there."""


class LogError(LidarenaError):
    """A recorded log that is missing, torn or contradicts itself, or relations that are not this log's."""


@dataclass(frozen=True)
class RecordedLog:
    """A log of ``R`` readings, ``S`` of which came with a scan of ``B`` beams.

    Attributes:
        name: Of the file.
        times: (R,) time stamps in the order of the log [s].
        odometry: (R, 3) the robot's pose by its wheels alone [m, m, rad].
        scan_readings: (S,) which readings have a scan, ascending.
        ranges: (S, B) float32 [m].
        angles: (B,) the beams' directions in the laser's frame, counter-clockwise [rad].
        max_range: Ranges from here on are no returns [m].
        mount: (3,) where the laser sits on the robot [m, m, rad].
        skipped: Torn lines that were left out because the caller asked for it.
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


def read_log(path: str | os.PathLike[str], skip_torn: bool = False) -> RecordedLog:
    """Read a CARMEN log.

    Args:
        path: The file, plain or gzip.
        skip_torn: Leave torn lines out instead of refusing the log.

    Raises:
        LogError: The file is missing, not text, not gzip though its name says so, cut short; a line is torn; there is
            no scan; the number or angles of the beams change; or time runs back by more than ``CLOCK_SLACK``.
    """
    where = f"log {os.fspath(path)!r}"
    entries = _Entries()
    for number, line in enumerate(_lines(Path(path), where), start=1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        try:
            entries.enter(words)
        except _TornLineError as torn:
            if not skip_torn:
                raise LogError(
                    f"line {number} of {where} is torn: {torn}; mend it, or leave torn lines out (--skip-torn)"
                ) from None
            entries.skipped += 1
        except _ConflictError as conflict:
            raise LogError(f"line {number} of {where} {conflict}") from None
    if not entries.ranges:
        raise LogError(f"{where} has no scans; lines that begin with FLASER or ROBOTLASER1 are needed")
    return entries.log(Path(path).name)


def save_log(path: str | Path, log: RecordedLog) -> Path:
    """Write a log as ``ODOM`` and ``FLASER`` lines; gzip if the name ends in ``.gz``.

    The beams must span the half turn in front as ``FLASER`` has it, and the laser must sit on the robot's centre.

    Raises:
        LogError: They do not.
    """
    beams = len(log.angles)
    if not np.allclose(log.angles, _front_angles(beams), atol=1e-4) or np.any(log.mount != 0.0):
        raise LogError(f"the {beams} beams of log {log.name!r} cannot be told in FLASER lines, which know no angles")
    text = [f"PARAM robot_front_laser_max {log.max_range:.9g}"]
    scans = dict(zip(log.scan_readings.tolist(), log.ranges, strict=True))
    for k, (time, pose) in enumerate(zip(log.times, log.odometry, strict=True)):
        place = " ".join(f"{value:.9g}" for value in pose)
        stamp = f"{time:.6f} lidarena {time - log.times[0]:.6f}"
        if k in scans:
            ranges = " ".join(f"{value:.6g}" for value in scans[k])
            text.append(f"FLASER {beams} {ranges} {place} {place} {stamp}")
        else:
            text.append(f"ODOM {place} 0 0 0 {stamp}")
    data = ("\n".join(text) + "\n").encode()
    return write_bytes(path, gzip.compress(data, mtime=0) if str(path).endswith(".gz") else data)


class _TornLineError(ValueError):
    """A line that is no whole message."""


class _ConflictError(ValueError):
    """A whole message that contradicts the ones before it."""


@dataclass(frozen=True)
class _Scan:
    """Ranges [m], the first beam's angle and the step to the next [rad], the longest range if told, the mount."""

    kind: str
    ranges: NDArray[np.float64]
    start: float
    step: float
    longest: float = math.inf
    mount: NDArray[np.float64] | None = None

    def __str__(self) -> str:
        return f"{len(self.ranges)} beams {math.degrees(self.step):.4g}° apart ({self.kind})"

    def like(self, other: "_Scan") -> bool:
        """Whether both come from one laser."""
        same = self.kind == other.kind and len(self.ranges) == len(other.ranges)
        return same and abs(self.start - other.start) < 1e-3 and abs(self.step - other.step) < 1e-4


_Message = tuple[float, Sequence[float], _Scan | None]
"""Time stamp [s], the robot's pose by its wheels, and the scan if there is one."""


@dataclass
class _Entries:
    """What has been read so far."""

    times: list[float] = field(default_factory=list)
    odometry: list[Sequence[float]] = field(default_factory=list)
    scan_readings: list[int] = field(default_factory=list)
    ranges: list[NDArray[np.float64]] = field(default_factory=list)
    mounts: list[NDArray[np.float64]] = field(default_factory=list)
    first: _Scan | None = None
    longest: float = math.inf
    latest: float = -math.inf
    skipped: int = 0

    def enter(self, words: list[str]) -> None:
        """Enter a line, wholly or not at all."""
        if words[0] == "PARAM":
            if len(words) > 2 and words[1] in ("robot_front_laser_max", "robot_frontlaser_max"):
                self.longest = min(self.longest, _numbers(words[2:3], 1, least=1e-3)[0])
        elif words[0] in _READERS:
            self._enter(*_READERS[words[0]](words))
        elif not _KEYWORD.match(words[0]):
            raise _TornLineError(f"it begins with {words[0][:20]!r}, which is no message")

    def _enter(self, time: float, pose: Sequence[float], scan: _Scan | None) -> None:
        if time < self.latest - CLOCK_SLACK:
            back = self.latest - time
            raise _ConflictError(f"is {back:.3g} s before a reading above it; time must not run backwards")
        if scan is not None:
            self.first = self.first or scan
            if not scan.like(self.first):
                raise _ConflictError(f"has {scan} after scans of {self.first}; all scans must be alike")
            self.longest = min(self.longest, scan.longest)
            self.scan_readings.append(len(self.times))
            self.ranges.append(scan.ranges)
            if scan.mount is not None:
                self.mounts.append(scan.mount)
        self.latest = max(self.latest, time)
        self.times.append(time)
        self.odometry.append(pose)

    def log(self, name: str) -> RecordedLog:
        """Everything as arrays."""
        assert self.first is not None
        ranges = np.array(self.ranges, np.float32)
        # where nothing tells the longest range, the largest that occurs stands for it
        longest = self.longest if math.isfinite(self.longest) else max(float(ranges.max()), 1.0)
        return RecordedLog(
            name=name,
            times=np.array(self.times),
            odometry=np.array(self.odometry, np.float64),
            scan_readings=np.array(self.scan_readings, np.int64),
            ranges=ranges,
            angles=np.asarray(self.first.start + self.first.step * np.arange(ranges.shape[1]), np.float64),
            max_range=longest,
            mount=_mount(self.mounts),
            skipped=self.skipped,
        )


def _odom(words: list[str]) -> _Message:
    """``ODOM x y theta tv rv accel time host logger_time``."""
    if len(words) != 10:
        raise _TornLineError(f"ODOM has {len(words)} words where 10 are needed")
    return _numbers(words[7:8], 1)[0], _pose(words[1:4]), None


def _flaser(words: list[str]) -> _Message:
    """``FLASER n range … x y theta odom_x odom_y odom_theta time host logger_time``."""
    n = _count(words[1:2], 1)
    if len(words) != n + 11:
        raise _TornLineError(f"FLASER has {len(words)} words where {n + 11} are needed for {n} beams")
    angles = _front_angles(n)
    ranges = np.array(_numbers(words[2 : n + 2], n, least=0.0, most=_FARTHEST))
    scan = _Scan("FLASER", ranges, angles[0], angles[1] - angles[0])
    return _numbers(words[n + 8 : n + 9], 1)[0], _pose(words[n + 5 : n + 8]), scan


def _robotlaser(words: list[str]) -> _Message:
    """``ROBOTLASER1 type start fov step max accuracy mode n range … m remission … rest``.

    The rest is the laser's pose (3), the robot's (3), velocities, safety distances and turn axis (5), time, host, time.
    """
    n = _count(words[8:9], 1)
    m = _count(words[9 + n : 10 + n], 0)
    rest = words[10 + n + m :]
    if len(rest) != 14:
        raise _TornLineError(f"ROBOTLASER1 has {len(words)} words where {24 + n + m} are needed for {n} beams")
    start, _, step, longest = _numbers(words[2:6], 4)
    if not (0.0 < step < math.pi and longest > 0.0):
        raise _TornLineError(f"ROBOTLASER1 has beams {step:g} rad apart, up to {longest:g} m")
    laser, robot = np.array(_pose(rest[0:3])), _pose(rest[3:6])
    ranges = np.array(_numbers(words[9 : 9 + n], n, least=0.0, most=_FARTHEST))
    scan = _Scan("ROBOTLASER1", ranges, start, step, longest, between(np.array(robot), laser))
    return _numbers(rest[11:12], 1)[0], robot, scan


_READERS: dict[str, Callable[[list[str]], _Message]] = {"ODOM": _odom, "FLASER": _flaser, "ROBOTLASER1": _robotlaser}


def _front_angles(beams: int) -> NDArray[np.float64]:
    """Directions (beams,) of a ``FLASER``: the half turn in front from -90° on, to +90° if the number is odd."""
    step = math.pi / max(beams - 1 if beams % 2 else beams, 1)
    return np.asarray(-math.pi / 2 + step * np.arange(beams), np.float64)


def _mount(mounts: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Where the laser sits, (3,), if it always sits there."""
    if not mounts:
        return np.zeros(3)
    middle: NDArray[np.float64] = np.median(np.array(mounts), axis=0)
    return middle if np.abs(np.array(mounts) - middle).max() < _MOUNT_SPREAD else np.zeros(3)


def _numbers(words: list[str], count: int, least: float = -math.inf, most: float = math.inf) -> list[float]:
    """So many finite numbers from ``least`` to ``most``."""
    if len(words) != count:
        raise _TornLineError(f"{count} numbers are needed where it has {len(words)}")
    try:
        values = [float(word) for word in words]
    except ValueError as error:
        raise _TornLineError(f"it has {str(error).rpartition(': ')[2][:30]} where a number is needed") from None
    if not (math.isfinite(sum(values)) and least <= min(values) and max(values) <= most):
        wrong = [value for value in values if not (math.isfinite(value) and least <= value <= most)] or [max(values)]
        raise _TornLineError(
            f"it has {wrong[0]:g} where a finite number is needed, of no absurd size, ranges from 0 on"
        )
    return values


def _pose(words: list[str]) -> list[float]:
    """x, y, theta."""
    return _numbers(words, 3, least=-_PLANET, most=_PLANET)


def _count(words: list[str], least: int) -> int:
    """A number of beams."""
    value = _numbers(words, 1)[0]
    if value != int(value) or not least <= value <= _MAX_BEAMS or value == 1:
        raise _TornLineError(f"it has {words[0]!r} where a number of beams is needed")
    return int(value)


def _lines(path: Path, where: str) -> Iterator[str]:
    """The lines of a file, unpacked if need be."""
    try:
        with path.open("rb") as stream:
            packed = stream.read(2) == _GZIP
        if path.suffix == ".gz" and not packed:
            raise LogError(f"{where} is not gzip though its name says so; rename it if it is plain text")
        with gzip.open(path, "rb") if packed else path.open("rb") as stream:
            for line in stream:
                yield line.decode("latin-1")
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise LogError(f"{where} is damaged: its gzip data end too early or are torn") from error
    except OSError as error:
        raise LogError(f"{where} cannot be read: {error.strerror}") from error
