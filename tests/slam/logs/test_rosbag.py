"""Rosbags of all three formats read as what was written; bad ones are refused in one sentence."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from lidarena.slam.logs.reading import read_recording
from lidarena.slam.logs.recorded_log import LogError, LogOptions, RecordedLog
from lidarena.slam.logs.rosbag import NO_ODOMETRY, read_bag
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

LOG = record(ring(), way(LAP, stride=0.5))
MOUNT = (0.2, -0.1, 0.3)
FORMATS = ("bag", "sqlite3", "mcap")


class Bag:
    """Writes a bag."""

    def __init__(self, place: Path, kind: str, compressed: bool = False) -> None:
        self.ros1, self.place = kind == "bag", place
        self.store = get_typestore(Stores.ROS1_NOETIC if self.ros1 else Stores.ROS2_HUMBLE)
        if self.ros1:
            text = "geometry_msgs/TransformStamped[] transforms"
            self.store.register(get_types_from_msg(text, "tf2_msgs/msg/TFMessage"))
        if self.ros1:
            self.writer: Any = Writer1(place)
            if compressed:
                self.writer.set_compression(Writer1.CompressionFormat.LZ4)
        else:
            plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
            self.writer = Writer2(place, version=9, storage_plugin=plugin)
            if compressed:
                self.writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
        self.writer.open()
        self.connections: dict[str, Any] = {}

    def make(self, kind: str, **fields: Any) -> Any:
        return self.store.types[kind](**fields)

    def header(self, time: float, frame: str) -> Any:
        nanoseconds = round(time * 1e9)
        stamp = self.make("builtin_interfaces/msg/Time", sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
        extra = {"seq": 0} if self.ros1 else {}
        return self.make("std_msgs/msg/Header", stamp=stamp, frame_id=frame, **extra)

    def write(self, topic: str, time: float, message: Any) -> None:
        kind = message.__msgtype__
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        dump = self.store.serialize_ros1 if self.ros1 else self.store.serialize_cdr
        self.writer.write(self.connections[topic], round(time * 1e9), dump(message, kind))

    def scan(self, time: float, ranges: np.ndarray, topic: str = "/scan", **changed: Any) -> None:
        values = {"angle_min": -math.pi / 2, "angle_max": math.pi / 2, "angle_increment": math.pi / 180}
        values |= {"time_increment": 0.0, "scan_time": 0.0, "range_min": 0.05, "range_max": 30.0} | changed
        none = np.zeros(0, np.float32)
        header = self.header(time, "laser")
        message = self.make(
            "sensor_msgs/msg/LaserScan", header=header, ranges=np.float32(ranges), intensities=none, **values
        )
        self.write(topic, time, message)

    def _turn(self, theta: float) -> Any:
        return self.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(theta / 2), w=math.cos(theta / 2))

    def odometry(self, time: float, pose: np.ndarray, topic: str = "/odom") -> None:
        point = self.make("geometry_msgs/msg/Point", x=float(pose[0]), y=float(pose[1]), z=0.0)
        at = self.make("geometry_msgs/msg/Pose", position=point, orientation=self._turn(float(pose[2])))
        zero = self.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        twist = self.make("geometry_msgs/msg/Twist", linear=zero, angular=zero)
        message = self.make(
            "nav_msgs/msg/Odometry",
            header=self.header(time, "odom"),
            child_frame_id="base_link",
            pose=self.make("geometry_msgs/msg/PoseWithCovariance", pose=at, covariance=np.zeros(36)),
            twist=self.make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)),
        )
        self.write(topic, time, message)

    def transform(self, time: float, parent: str, child: str, pose: Any, topic: str = "/tf") -> None:
        x, y, theta = (float(value) for value in pose)
        move = self.make("geometry_msgs/msg/Vector3", x=x, y=y, z=0.3)
        at = self.make("geometry_msgs/msg/Transform", translation=move, rotation=self._turn(theta))
        one = self.make(
            "geometry_msgs/msg/TransformStamped", header=self.header(time, parent), child_frame_id=child, transform=at
        )
        self.write(topic, time, self.make("tf2_msgs/msg/TFMessage", transforms=[one]))


def bag_of(
    place: Path,
    kind: str,
    log: RecordedLog = LOG,
    odometry: str = "/odom",
    compressed: bool = False,
    scan: str = "/scan",
) -> Path:
    bag = Bag(place, kind, compressed)
    bag.transform(log.times[0], "base_link", "laser", MOUNT, "/tf_static")
    scans = dict(zip(log.scan_readings.tolist(), log.ranges, strict=True))
    for k, (time, pose) in enumerate(zip(log.times, log.odometry, strict=True)):
        if odometry == "/odom":
            bag.odometry(time, pose)
        if odometry == "/tf":
            bag.transform(time, "odom", "base_link", pose)
        if k in scans:
            bag.scan(time, scans[k])
    bag.writer.close()
    return place


def cut(place: Path, share: float) -> Path:
    """Keep so much of a bag, from its beginning on."""
    file = next(one for one in place.iterdir() if one.suffix in (".db3", ".mcap")) if place.is_dir() else place
    data = file.read_bytes()
    file.write_bytes(data[: int(share * len(data))])
    return place


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize(("odometry", "compressed"), [("/odom", False), ("/tf", False), ("/odom", True)])
def test_a_bag_reads_as_what_was_written(tmp_path: Path, kind: str, odometry: str, compressed: bool) -> None:
    log = read_recording(bag_of(tmp_path / f"a.{kind}", kind, odometry=odometry, compressed=compressed))
    np.testing.assert_allclose(log.times, LOG.times[LOG.scan_readings], atol=1e-6)
    np.testing.assert_allclose(log.odometry, LOG.odometry[LOG.scan_readings], atol=1e-6)
    np.testing.assert_array_equal(log.ranges, LOG.ranges)
    np.testing.assert_allclose(log.angles, LOG.angles, atol=1e-9)
    np.testing.assert_allclose(log.mount, MOUNT, atol=1e-9)
    assert log.notes[0] == f"scans are read from /scan, odometry from {odometry}"


def test_without_odometry_the_way_is_left_to_scan_matching(tmp_path: Path) -> None:
    log = read_bag(bag_of(tmp_path / "a.bag", "bag", odometry="none"))
    assert not log.has_odometry and log.unsure[1:].all()
    assert any("scan matching alone" in note for note in log.notes)
    again = read_bag(bag_of(tmp_path / "b.bag", "bag"), LogOptions(odometry_topic=NO_ODOMETRY))
    assert not again.has_odometry


def test_of_two_scan_topics_the_fuller_is_taken_and_told(tmp_path: Path) -> None:
    bag = Bag(tmp_path / "a.bag", "bag")
    for k in range(6):
        bag.scan(1e9 + k, np.full(180, 2.0), "/front")
        if k % 2:
            bag.scan(1e9 + k, np.full(180, 3.0), "/back")
    bag.writer.close()
    log = read_bag(tmp_path / "a.bag")
    assert len(log.ranges) == 6 and any("/front (6), /back (3)" in note for note in log.notes)
    assert len(read_bag(tmp_path / "a.bag", LogOptions(scan_topic="/back")).ranges) == 3
    with pytest.raises(LogError, match="has no LaserScan topic '/bakc'; did you mean '/back'"):
        read_bag(tmp_path / "a.bag", LogOptions(scan_topic="/bakc"))
    with pytest.raises(LogError, match="has no topic of odometry or transforms '/odom'"):
        read_bag(tmp_path / "a.bag", LogOptions(odometry_topic="/odom"))


def test_a_laser_upside_down_and_unset_stamps_are_read(tmp_path: Path) -> None:
    bag = Bag(tmp_path / "a.bag", "bag")
    ranges = np.linspace(1.0, 4.0, 180)
    for _ in range(3):
        bag.scan(0.0, ranges, angle_min=math.pi / 2, angle_increment=-math.pi / 180)
    bag.writer.close()
    log = read_bag(tmp_path / "a.bag")
    assert (np.diff(log.angles) > 0).all()
    np.testing.assert_allclose(log.ranges[0], ranges[::-1], rtol=1e-6)
    assert (np.diff(log.times) >= 0).all()


def test_a_bag_of_a_camera_is_refused(tmp_path: Path) -> None:
    bag = Bag(tmp_path / "a.bag", "bag")
    bag.odometry(1e9, np.zeros(3))
    bag.writer.close()
    with pytest.raises(LogError, match="no topic of sensor_msgs/LaserScan, which is needed; it holds Odometry"):
        read_bag(tmp_path / "a.bag")


def test_scans_that_are_all_infinite_are_refused(tmp_path: Path) -> None:
    silent = replace(LOG, ranges=np.full_like(LOG.ranges, np.inf))
    with pytest.raises(LogError, match="has no scan with a single return"):
        read_bag(bag_of(tmp_path / "a.bag", "bag", silent))


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.99])
def test_a_bag_that_was_cut_off_is_refused_in_one_sentence(tmp_path: Path, kind: str, share: float) -> None:
    place = cut(bag_of(tmp_path / f"a.{kind}", kind), share)
    try:
        log = read_recording(place)
    except LogError as refusal:
        assert ("\n" not in str(refusal) and "a.bag" in str(refusal)) or "a." in str(refusal)
    else:
        np.testing.assert_array_equal(log.ranges, LOG.ranges[: len(log.ranges)])


def test_a_missing_bag_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read: No such file"):
        read_recording(tmp_path / "none.bag")


CSAIL = Path(__file__).resolve().parents[4] / "shared" / "data" / "logs"


@pytest.mark.skipif(not (CSAIL / "mit-csail.bag").exists(), reason="the recorded logs are not beside the checkout")
def test_the_bag_of_a_real_log_equals_its_carmen_log() -> None:
    bag, log = read_recording(CSAIL / "mit-csail.bag"), read_recording(CSAIL / "mit-csail.log.gz")
    np.testing.assert_array_equal(bag.times, log.times)
    np.testing.assert_array_equal(bag.ranges, log.ranges)
    np.testing.assert_allclose(bag.odometry, log.odometry, atol=1e-12)
    np.testing.assert_allclose(bag.angles, log.angles, atol=1e-12)
