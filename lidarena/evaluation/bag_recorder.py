"""An episode as a rosbag 2 (MCAP), which RViz, slam_toolbox or nav2 play without knowing where it comes from.

Topics, as far as the environment tells them: ``/scan`` (LaserScan in ``base_scan``), ``/odom`` (Odometry, what the
wheels say), ``/map`` (OccupancyGrid, what SLAM believes), ``/ground_truth`` (Odometry in ``map``), ``/tf`` (map to odom
to base_link to base_scan) and ``/clock``. Robots of a team have theirs under ``/robot_0``, ``/robot_1`` …, with frames
of such names.
"""

import math
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.rosbag2.errors import ReaderError
from rosbags.typesys import Stores, get_typestore

from lidarena.base.errors import WriteError
from lidarena.envs.registration import owner_of
from lidarena.evaluation.recording import Recording, entry_of
from lidarena.world.lidar import LidarSpec

BEGIN = 1.0
"""Time of the first message [s]; ROS takes 0 for "whatever is the latest"."""
MAP_PERIOD = 2.0
"""Between two maps [s]."""
Floats = NDArray[np.float64]


class BagRecorder:
    """Writes one episode; a context manager that finishes the bag when it ends.

    Args:
        path: Folder of the bag; it must not exist yet.

    Raises:
        WriteError: The bag cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._store = get_typestore(Stores.ROS2_HUMBLE)
        self._connections: dict[str, Any] = {}
        self._mapped = -math.inf
        self._last: Recording | None = None

    def __enter__(self) -> Self:
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._writer = Writer(self.path, version=9, storage_plugin=StoragePlugin.MCAP)
            self._writer.open()
        except OSError as error:
            raise WriteError(f"{str(self.path)!r} cannot be written: {error.strerror}") from error
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None and self._last is not None:
            self._write_map(self._last, BEGIN + _time_of(self._last), final=True)
        try:
            self._writer.close()
        except (OSError, ReaderError) as trouble:
            if kind is None:
                raise WriteError(f"{str(self.path)!r} cannot be written: {trouble}") from trouble

    def note(self, recording: Recording) -> None:
        """Write what a recording has just noted."""
        info, now = recording.info, BEGIN + _time_of(recording)
        self._write("/clock", now, self._make("rosgraph_msgs/msg/Clock", clock=self._stamp(now)))
        poses, wheels = _rows(info.get("pose")), _rows(info.get("odometry_pose"))
        true = _rows(entry_of(info, "truth.pose"))
        scans = info.get("scan")
        scans = None if scans is None or np.ndim(scans) not in (1, 2) else np.atleast_2d(np.asarray(scans, np.float32))
        count = 0 if poses is None else len(poses)
        for robot in range(count):
            prefix = f"robot_{robot}/" if count > 1 else ""
            pose = poses[robot]  # type: ignore[index]
            odometry = pose if wheels is None or len(wheels) <= robot else wheels[robot]
            self._write(f"/{prefix}odom", now, self._odometry(now, odometry, f"{prefix}odom", f"{prefix}base_link"))
            if true is not None and len(true) > robot:
                place = self._odometry(now, true[robot], "map", f"{prefix}base_link")
                self._write(f"/{prefix}ground_truth", now, place)
            self._write_frames(now, pose, odometry, prefix)
            lidar = _lidar_of(recording.env)
            if scans is not None and len(scans) > robot and lidar is not None and lidar.beams == scans.shape[1]:
                self._write(f"/{prefix}scan", now, self._scan(now, scans[robot], lidar, f"{prefix}base_scan"))
        self._write_map(recording, now)
        self._last = recording

    def _write_frames(self, now: float, pose: Floats, odometry: Floats, prefix: str) -> None:
        """Tell where the frames are; map → odom is what takes the wheels' pose to SLAM's."""
        turn = pose[2] - odometry[2]
        cos, sin = math.cos(turn), math.sin(turn)
        x, y = odometry[:2]
        correction = np.array([pose[0] - cos * x + sin * y, pose[1] - sin * x - cos * y, turn])
        chain = (
            ("map", f"{prefix}odom", correction),
            (f"{prefix}odom", f"{prefix}base_link", odometry),
            (f"{prefix}base_link", f"{prefix}base_scan", np.zeros(3)),
        )
        transforms = [
            self._make(
                "geometry_msgs/msg/TransformStamped",
                header=self._header(now, parent),
                child_frame_id=child,
                transform=self._make(
                    "geometry_msgs/msg/Transform",
                    translation=self._make("geometry_msgs/msg/Vector3", x=float(at[0]), y=float(at[1]), z=0.0),
                    rotation=self._rotation(float(at[2])),
                ),
            )
            for parent, child, at in chain
        ]
        self._write("/tf", now, self._make("tf2_msgs/msg/TFMessage", transforms=transforms))

    def _write_map(self, recording: Recording, now: float, final: bool = False) -> None:
        cells, info = recording.info.get("map"), recording.info
        due = now >= self._mapped + MAP_PERIOD or (final and now > self._mapped)
        if not isinstance(cells, np.ndarray) or cells.ndim != 2 or "resolution" not in info or not due:
            return
        self._mapped = now
        x, y = np.ravel(info["origin"])[:2].tolist()
        grid = self._make(
            "nav_msgs/msg/OccupancyGrid",
            header=self._header(now, "map"),
            info=self._make(
                "nav_msgs/msg/MapMetaData",
                map_load_time=self._stamp(now),
                resolution=float(info["resolution"]),
                width=cells.shape[1],
                height=cells.shape[0],
                origin=self._pose(np.array([x, y, 0.0])),
            ),
            data=np.ascontiguousarray(cells, np.int8).ravel(),
        )
        self._write("/map", now, grid)

    def _scan(self, now: float, ranges: NDArray[np.float32], lidar: LidarSpec, frame: str) -> Any:
        met = np.where(ranges >= lidar.max_range, np.float32(np.inf), ranges)  # ROS: no return is infinite
        return self._make(
            "sensor_msgs/msg/LaserScan",
            header=self._header(now, frame),
            angle_min=float(lidar.angles[0]),
            angle_max=float(lidar.angles[-1]),
            angle_increment=float(lidar.increment),
            time_increment=0.0,
            scan_time=0.0 if math.isinf(lidar.rate) else 1.0 / lidar.rate,
            range_min=max(float(lidar.min_range), 1e-3),
            range_max=float(lidar.max_range),
            ranges=met.astype(np.float32),
            intensities=np.zeros(0, np.float32),
        )

    def _odometry(self, now: float, pose: Floats, frame: str, child: str) -> Any:
        zero = self._make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        nothing = np.zeros(36)
        twist = self._make("geometry_msgs/msg/Twist", linear=zero, angular=zero)
        return self._make(
            "nav_msgs/msg/Odometry",
            header=self._header(now, frame),
            child_frame_id=child,
            pose=self._make("geometry_msgs/msg/PoseWithCovariance", pose=self._pose(pose), covariance=nothing),
            twist=self._make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=nothing),
        )

    def _pose(self, pose: Floats) -> Any:
        point = self._make("geometry_msgs/msg/Point", x=float(pose[0]), y=float(pose[1]), z=0.0)
        return self._make("geometry_msgs/msg/Pose", position=point, orientation=self._rotation(float(pose[2])))

    def _rotation(self, turn: float) -> Any:
        return self._make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(turn / 2), w=math.cos(turn / 2))

    def _header(self, now: float, frame: str) -> Any:
        return self._make("std_msgs/msg/Header", stamp=self._stamp(now), frame_id=frame)

    def _stamp(self, now: float) -> Any:
        nanoseconds = round(now * 1e9)
        return self._make("builtin_interfaces/msg/Time", sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)

    def _make(self, kind: str, **fields: Any) -> Any:
        return self._store.types[kind](**fields)

    def _write(self, topic: str, now: float, message: Any) -> None:
        kind = message.__msgtype__
        if topic not in self._connections:
            self._connections[topic] = self._writer.add_connection(topic, kind, typestore=self._store)
        try:
            self._writer.write(self._connections[topic], round(now * 1e9), self._store.serialize_cdr(message, kind))
        except OSError as error:
            raise WriteError(f"{str(self.path)!r} cannot be written: {error.strerror}") from error


def _time_of(recording: Recording) -> float:
    """Of an episode [s]; of an environment that tells none, as many seconds as there were steps."""
    time = recording.info.get("time")
    return float(recording.steps) if time is None else float(np.max(time))


def _rows(value: Any) -> Floats | None:
    """Poses as (robots, 3); None where there are none."""
    if value is None or isinstance(value, dict):
        return None
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or array.shape[-1] != 3:
        return None
    return array.reshape(-1, 3).astype(np.float64)


def _lidar_of(env: Any) -> LidarSpec | None:
    owner = owner_of(env, "options")
    lidar = getattr(getattr(owner, "options", None), "lidar", None)
    return lidar if isinstance(lidar, LidarSpec) else None
