"""Rosbags: ``sensor_msgs/LaserScan`` with ``nav_msgs/Odometry`` or ``/tf`` out of rosbag 1, rosbag 2 and MCAP files.

They are read by the ``rosbags`` library, without ROS.
"""

import math
import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import LidarenaError, suggest
from lidarena.slam.logs.assembly import Assembly, RawScan
from lidarena.slam.logs.beams import BeamLayout
from lidarena.slam.logs.cut_bags import read_cut_bag
from lidarena.slam.logs.recorded_log import LogError, LogOptions, RecordedLog
from lidarena.slam.logs.tf_tree import TransformTree
from lidarena.slam.logs.trajectory import interpolated

SCAN, ODOMETRY = "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry"
TRANSFORMS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
NO_ODOMETRY = "none"
_MAX_BEAMS = 20_000

_Poses = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Times (n,) ascending and poses (n, 3)."""


def read_bag(path: str | os.PathLike[str], options: LogOptions | None = None) -> RecordedLog:
    """Read a rosbag.

    The odometry is interpolated at the times of the scans. The transform from the robot's frame to the laser's, if the
    bag tells it, is where the laser sits.

    Args:
        path: A ``.bag``, ``.db3`` or ``.mcap`` file, or the folder of a rosbag 2.
        options: Which topics to take, and what else the bag does not tell.

    Raises:
        LogError: It is missing, damaged or no bag; it has no such topic, or several among which to choose; or its
            messages make no sense.
    """
    wanted, where = options or LogOptions(), f"bag {os.fspath(path)!r}"
    messages = _Messages(where, wanted)
    for connection, stamp, raw in _raw_messages(Path(path), where, messages):
        messages.enter(connection, stamp, raw)
    return messages.log(Path(path).name)


class _Messages:
    """The messages of a bag that matter, sorted by what they are.

    Args:
        where: What messages to the user call the bag.
        options: The user's.
    """

    def __init__(self, where: str, options: LogOptions) -> None:
        self.where, self.options, self.assembly = where, options, Assembly()
        self.scans: list[tuple[float, RawScan, str]] = []
        self.odometry: list[tuple[float, float, float, float]] = []
        self.robot_frame, self.is_cut = "", False
        self.tree = TransformTree()
        self.scan_topic, self.odometry_topic = "", NO_ODOMETRY
        self.decode: Callable[[Any, str], Any] = lambda raw, kind: raw

    def choose(self, connections: Sequence[Any]) -> list[Any]:
        """Choose the topics, and return the connections that are to be read."""
        kinds = {each.topic: each.msgtype for each in connections}
        counts: dict[str, int] = {}
        for each in connections:
            counts[each.topic] = counts.get(each.topic, 0) + each.msgcount
        self.scan_topic = self._scan_topic(kinds, counts)
        self.odometry_topic = self._odometry_topic(kinds, counts)
        self.assembly.notes.append(f"scans are read from {self.scan_topic}, odometry from {self.odometry_topic}")
        topics = {self.scan_topic, self.odometry_topic}
        topics |= {topic for topic, kind in kinds.items() if kind in TRANSFORMS}
        return [each for each in connections if each.topic in topics]

    def _scan_topic(self, kinds: dict[str, str], counts: dict[str, int]) -> str:
        found = sorted((topic for topic, kind in kinds.items() if kind == SCAN), key=lambda topic: -counts[topic])
        asked = self.options.scan_topic
        if asked is not None:
            if asked not in found:
                raise LogError(f"{self.where} has no LaserScan topic {asked!r}{suggest(asked, found or ['none'])}")
            return asked
        if not found:
            others = ", ".join(sorted({kind.rpartition("/")[2] for kind in kinds.values()})) or "nothing"
            raise LogError(f"{self.where} has no topic of sensor_msgs/LaserScan, which is needed; it holds {others}")
        if len(found) > 1:
            several = ", ".join(f"{topic} ({counts[topic]:,})" for topic in found)
            self.assembly.notes.append(
                f"there are several scan topics: {several}; the one with most scans is taken, --scan chooses another"
            )
        return found[0]

    def _odometry_topic(self, kinds: dict[str, str], counts: dict[str, int]) -> str:
        known = (ODOMETRY, *TRANSFORMS)
        found = sorted(
            (topic for topic, kind in kinds.items() if kind in known and "static" not in topic and counts[topic]),
            key=lambda topic: (known.index(kinds[topic]), -counts[topic]),
        )
        asked = self.options.odometry_topic
        if asked is not None:
            if asked not in (*found, NO_ODOMETRY):
                allowed = suggest(asked, [*found, NO_ODOMETRY])
                raise LogError(f"{self.where} has no topic of odometry or transforms {asked!r}{allowed}")
            return asked
        odometries = [topic for topic in found if kinds[topic] == ODOMETRY]
        if len(odometries) > 1:
            several = ", ".join(f"{topic} ({counts[topic]:,})" for topic in odometries)
            self.assembly.notes.append(
                f"there are several odometry topics: {several}; the one with most messages is taken, --odom chooses "
                "another"
            )
        return found[0] if found else NO_ODOMETRY

    def enter(self, connection: Any, stamp: int, raw: bytes) -> None:
        """Enter a message."""
        try:
            message = self.decode(raw, connection.msgtype)
            if connection.msgtype == SCAN:
                self._enter_scan(message, stamp)
            elif connection.msgtype == ODOMETRY:
                self.robot_frame = self.robot_frame or message.child_frame_id.lstrip("/")
                self.odometry.append((_seconds(message.header, stamp), *_planar(message.pose.pose)))
            elif connection.msgtype in TRANSFORMS:
                for each in message.transforms:
                    self.tree.add(
                        each.header.frame_id, each.child_frame_id, _seconds(each.header, stamp), _planar(each.transform)
                    )
        except LogError:
            raise
        except Exception as error:  # whatever the decoders raise on torn bytes
            if not (self.options.skip_torn or self.is_cut):
                raise LogError(
                    f"{self.where} has a torn message on {connection.topic} at {stamp * 1e-9:.3f} s; leave torn "
                    "messages out (--skip-torn)"
                ) from error
            self.assembly.skipped += 1

    def _enter_scan(self, message: Any, stamp: int) -> None:
        ranges = np.asarray(message.ranges, np.float64)
        step, start = float(message.angle_increment), float(message.angle_min)
        if not (math.isfinite(start) and math.isfinite(step) and 1e-5 < abs(step) < math.pi):
            raise ValueError("beams")
        if not 2 <= len(ranges) <= _MAX_BEAMS:
            raise ValueError("beams")
        longest, least = float(message.range_max), float(message.range_min)
        ranges = np.where(ranges < least, 0.0, ranges) if least > 0.0 else ranges
        if step < 0.0:  # a laser upside down counts clockwise
            ranges, start, step = ranges[::-1], start + step * (len(ranges) - 1), -step
        # single precision does not hold degrees; what it rounded is put right
        layout = BeamLayout(len(ranges), _tidied(start), _tidied(step))
        longest = longest if math.isfinite(longest) and longest > 0.0 else math.inf
        self.scans.append((_seconds(message.header, stamp), RawScan(ranges, layout, longest), message.header.frame_id))

    def log(self, name: str) -> RecordedLog:
        """What was read, as arrays."""
        if not self.scans:
            raise LogError(f"{self.where} has no scans on {self.scan_topic}; LaserScan messages are needed")
        laser = self.scans[0][2].lstrip("/")
        told, mount = self._told_odometry(laser)
        self.assembly.mount_told = mount
        times = np.array([time for time, _, _ in self.scans])
        poses = np.zeros((len(times), 3)) if told is None else interpolated(*told, times)
        if told is None:
            self.assembly.notes.append("no odometry is read; the way is found by scan matching alone")
        for (time, scan, _), pose in zip(self.scans, poses.tolist(), strict=True):
            self.assembly.add(time, pose, scan)
        return self.assembly.log(name, self.where, self.options)

    def _told_odometry(self, laser: str) -> tuple[_Poses | None, NDArray[np.float64] | None]:
        """The robot's poses by its wheels, and where the laser sits on it."""
        if self.odometry_topic == NO_ODOMETRY:
            return None, None
        if self.odometry:
            table = np.array(self.odometry)
            told = (table[:, 0], table[:, 1:])
            return _sorted(told), self.tree.fixed(self.robot_frame, laser)
        chain = self.tree.moving(laser)
        if chain is None:
            raise LogError(
                f"{self.where} has no transforms on {self.odometry_topic} that lead from an odometry frame to the "
                f"laser's {laser!r}; give --odom TOPIC, or --odom none for scan matching alone"
            )
        times, poses, base = chain
        return _sorted((times, poses)), self.tree.fixed(base, laser)


def _raw_messages(path: Path, where: str, messages: _Messages) -> Iterator[tuple[Any, int, bytes]]:
    """The raw messages of the topics that were chosen."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    if not path.exists():
        raise LogError(f"{where} cannot be read: No such file or directory")
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            messages.decode = reader.deserialize
            yield from reader.messages(connections=messages.choose(reader.connections))
    except LidarenaError:
        raise
    except Exception as error:  # the readers of three formats raise whatever their parsers do
        reason = " ".join(str(error.args[0]).split()) if error.args else type(error).__name__
        if messages.scans and messages.options.keep_cut:
            messages.assembly.notes.append(f"{where} is damaged or cut off; what stands before that place is kept")
            return
        if messages.options.keep_cut:
            left = list(_left_of_cut(path, where, messages))
            if left:
                yield from left
                return
        raise LogError(
            f"{where} is damaged, cut off or no rosbag ({reason[:120].rstrip('.')}); a whole .bag, .db3 or .mcap file "
            "or the folder of a rosbag 2 is needed ('rosbag reindex' mends a cut one)"
        ) from error


def _left_of_cut(path: Path, where: str, messages: _Messages) -> Iterator[tuple[Any, int, bytes]]:
    """The raw messages that a damaged bag still holds, of the topics that were chosen."""
    cut = read_cut_bag(path, (SCAN, ODOMETRY, *TRANSFORMS))
    if cut is None or not any(each.msgtype == SCAN and each.msgcount for each in cut.connections):
        return
    messages.assembly.notes.append(f"{where} is damaged or cut off; what can be read from its beginning on is kept")
    messages.decode, messages.is_cut = cut.decode, True
    yield from cut.chosen(each.topic for each in messages.choose(cut.connections))


def _seconds(header: Any, stamp: int) -> float:
    """A message's own time stamp, or when it was recorded if it has none [s]."""
    own = header.stamp.sec + header.stamp.nanosec * 1e-9
    return float(own if own > 0.0 else stamp * 1e-9)


def _planar(pose: Any) -> tuple[float, float, float]:
    """x, y and the turn about the vertical of a ROS pose or transform."""
    place = pose.position if hasattr(pose, "position") else pose.translation
    turn = pose.orientation if hasattr(pose, "orientation") else pose.rotation
    theta = math.atan2(2.0 * (turn.w * turn.z + turn.x * turn.y), 1.0 - 2.0 * (turn.y * turn.y + turn.z * turn.z))
    if not math.isfinite(place.x + place.y + theta):
        raise ValueError("pose")
    return float(place.x), float(place.y), theta


def _tidied(angle: float) -> float:
    """An angle that went through single precision, in whole thousandths of a degree if it is that near to them."""
    degrees = round(math.degrees(angle), 3)
    return math.radians(degrees) if abs(math.radians(degrees) - angle) < 3e-7 * max(abs(angle), 0.1) else angle


def _sorted(told: _Poses) -> _Poses:
    """The same poses in the order of their times."""
    order = np.argsort(told[0], kind="stable")
    return told[0][order], told[1][order]
