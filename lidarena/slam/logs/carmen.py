"""CARMEN logs: what a robot's wheels and its laser reported, line by line (gzip too), read and written.

Read are ``ODOM``, ``FLASER`` (the old message of a front laser) and ``ROBOTLASER1`` (the new one, which tells its own
angles), and of the ``PARAM`` lines which ranges are no returns, how wide the front laser looks and where it sits. Other
messages are passed over, among them ``RLASER``, a second laser that looks back.
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

from lidarena.base.files import write_bytes
from lidarena.slam.logs.assembly import Assembly, RawScan
from lidarena.slam.logs.beams import BeamLayout
from lidarena.slam.logs.recorded_log import LogError, LogOptions, RecordedLog
from lidarena.slam.planar import between

__all__ = ["LogError", "RecordedLog", "read_log", "save_log"]

_GZIP = b"\x1f\x8b"
_KEYWORD = re.compile(r"[A-Z][A-Z0-9_]*\Z")
_MAX_BEAMS = 20_000
_PLANET = 1e8
"""No robot's odometry says more, in metres or radians."""
_HALF_TURN_BEAMS = 361
"""With more beams than these a ``FLASER`` is not taken to look over the half turn in front."""


def read_log(path: str | os.PathLike[str], skip_torn: bool = False, options: LogOptions | None = None) -> RecordedLog:
    """Read a CARMEN log.

    Args:
        path: The file, plain or gzip.
        skip_torn: Leave torn lines out instead of refusing the log.
        options: What the file does not tell.

    Raises:
        LogError: The file is missing, not text, not gzip though its name says so, cut short; a line is torn; there is
            no scan; a ``FLASER`` has more than 361 beams and nothing tells its field of view; or too many stamps are
            wrong.
    """
    wanted = options or LogOptions(skip_torn)
    where = f"log {os.fspath(path)!r}"
    entries = _Entries(wanted)
    torn_before = ""
    for number, line in enumerate(_lines(Path(path), where, entries), start=1):
        if torn_before:
            raise LogError(torn_before)
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        try:
            entries.enter(words)
        except _TornLineError as torn:
            if wanted.skip_torn or skip_torn:
                entries.assembly.skipped += 1
                continue
            torn_before = f"line {number} of {where} is torn: {torn}; mend it, or leave torn lines out (--skip-torn)"
    if torn_before:
        if not (wanted.keep_cut and entries.assembly.scans):
            raise LogError(torn_before)
        entries.assembly.notes.append(f"{where} is cut off in line {number}; what stands before it is kept")
    if not entries.assembly.scans:
        raise LogError(f"{where} has no scans; lines that begin with FLASER or ROBOTLASER1 are needed")
    return entries.assembly.log(Path(path).name, where, wanted)


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


@dataclass
class _Entries:
    """What has been read so far, and what ``PARAM`` lines told of the front laser.

    Attributes:
        options: The user's.
        field_of_view: [rad].
        resolution: Of its beams [rad].
    """

    options: LogOptions
    assembly: Assembly = field(default_factory=Assembly)
    field_of_view: float | None = None
    resolution: float | None = None

    def enter(self, words: list[str]) -> None:
        """Enter a line, wholly or not at all."""
        if words[0] == "PARAM":
            if len(words) > 2:
                self._parameter(words[1], words[2:3])
        elif words[0] == "FLASER":
            self.assembly.add(*_flaser(words, self._front_layout))
        elif words[0] in _READERS:
            self.assembly.add(*_READERS[words[0]](words))
        elif not _KEYWORD.match(words[0]):
            raise _TornLineError(f"it begins with {words[0][:20]!r}, which is no message")

    def _parameter(self, name: str, value: list[str]) -> None:
        if name in ("robot_front_laser_max", "robot_frontlaser_max"):
            self.assembly.longest = min(self.assembly.longest, _numbers(value, 1, least=1e-3)[0])
        elif name in ("robot_frontlaser_offset", "robot_front_laser_offset"):
            self.assembly.mount_told = np.array([_numbers(value, 1, -100.0, 100.0)[0], 0.0, 0.0])
        elif name in ("laser_front_laser_fov", "robot_front_laser_fov"):
            self.field_of_view = _radians(_numbers(value, 1, 1e-3, 360.001)[0], 6.3)
        elif name in ("laser_front_laser_resolution", "robot_front_laser_resolution"):
            self.resolution = _radians(_numbers(value, 1, 1e-5, 90.0)[0], 0.03)

    def _front_layout(self, beams: int) -> BeamLayout:
        """How the beams of a ``FLASER`` lie, by the user, the ``PARAM`` lines or, up to 361 beams, the half turn."""
        wide = self.options.field_of_view or self.field_of_view
        intervals = max(beams - 1 if beams % 2 else beams, 1)
        if wide is None and self.resolution is not None:
            wide = self.resolution * intervals
        if wide is None and beams > _HALF_TURN_BEAMS:
            raise LogError(
                f"a FLASER with {beams} beams does not tell where they point; give its field of view in degrees "
                "(--fov 240), or a line PARAM laser_front_laser_fov 240"
            )
        wide = math.pi if wide is None or wide > 2.0 * math.pi + 1e-3 else wide
        start, second = -wide / 2.0, -wide / 2.0 + wide / intervals
        return BeamLayout(beams, start, second - start)


def _radians(value: float, most: float) -> float:
    """An angle in degrees, as CARMEN has it, or in radians, as some converters do, who never exceed ``most``."""
    return value if value <= most else math.radians(value)


_Message = tuple[float, Sequence[float], RawScan | None]
"""Time stamp [s], the robot's pose by its wheels, and the scan if there is one."""


def _odom(words: list[str]) -> _Message:
    """``ODOM x y theta tv rv accel time host logger_time``."""
    if len(words) != 10:
        raise _TornLineError(f"ODOM has {len(words)} words where 10 are needed")
    return _time(words[7]), _pose(words[1:4]), None


def _flaser(words: list[str], layout: Callable[[int], BeamLayout]) -> _Message:
    """``FLASER n range … x y theta odom_x odom_y odom_theta time host logger_time``."""
    n = _count(words[1:2], 1)
    if len(words) != n + 11:
        raise _TornLineError(f"FLASER has {len(words)} words where {n + 11} are needed for {n} beams")
    laser, robot = np.array(_pose(words[n + 2 : n + 5])), _pose(words[n + 5 : n + 8])
    scan = RawScan(_ranges(words[2 : n + 2]), layout(n), mount=between(np.array(robot), laser))
    return _time(words[n + 8]), robot, scan


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
    if not (1e-5 < step < math.pi and longest > 0.0):
        raise _TornLineError(f"ROBOTLASER1 has beams {step:g} rad apart, up to {longest:g} m")
    laser, robot = np.array(_pose(rest[0:3])), _pose(rest[3:6])
    layout = BeamLayout(n, start, step)
    scan = RawScan(_ranges(words[9 : 9 + n]), layout, longest, between(np.array(robot), laser))
    return _time(rest[11]), robot, scan


_READERS: dict[str, Callable[[list[str]], _Message]] = {"ODOM": _odom, "ROBOTLASER1": _robotlaser}


def _front_angles(beams: int) -> NDArray[np.float64]:
    """Directions (beams,) of a ``FLASER``: the half turn in front from -90° on, to +90° if the number is odd."""
    step = math.pi / max(beams - 1 if beams % 2 else beams, 1)
    return np.asarray(-math.pi / 2 + step * np.arange(beams), np.float64)


def _ranges(words: list[str]) -> NDArray[np.float64]:
    """Ranges (n,), infinite, NaN or negative ones too."""
    try:
        return np.array([float(word) for word in words])
    except ValueError as error:
        raise _TornLineError(f"it has {str(error).rpartition(': ')[2][:30]} where a number is needed") from None


def _time(word: str) -> float:
    """A time stamp [s]."""
    return _numbers([word], 1)[0]


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
        raise _TornLineError(f"it has {wrong[0]:g} where a finite number is needed, of no absurd size")
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


def _lines(path: Path, where: str, entries: _Entries) -> Iterator[str]:
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
        if entries.options.keep_cut and entries.assembly.scans:
            entries.assembly.notes.append(f"{where} is damaged or cut off; what stands before that place is kept")
            return
        raise LogError(f"{where} is damaged: its gzip data end too early or are torn") from error
    except OSError as error:
        raise LogError(f"{where} cannot be read: {error.strerror}") from error
