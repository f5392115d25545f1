"""An episode as it is played again in a report: poses, scans, particles, the map as it grew, and what was planned.

Nothing here knows a family: a replay holds whatever of the names that all families share an environment tells.
"""

import gzip
import json
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.registration import owner_of
from lidarena.evaluation.recording import Recording, entry_of

MOST_FRAMES = 1000
"""More are thinned out, every other one."""
MOST_BEAMS = 90
"""Of a scan; of a denser one every second, third … beam is kept."""
MOST_POINTS = 200
"""Of a planned path: that of a field which is stuck has some 100,000, and every frame shows it."""
_OCCUPIED = 50
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class EpisodeReplay:
    """An episode to be played.

    Attributes:
        content: Plain numbers and texts, see ``ReplayRecorder.finish``.
    """

    content: Mapping[str, Any]

    def write(self, path: Path) -> None:
        """Write it as JSON, packed by gzip."""
        path.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps(self.content, separators=(",", ":"), allow_nan=False)
        path.write_bytes(gzip.compress(text.encode(), mtime=0))

    @classmethod
    def read(cls, path: Path) -> "EpisodeReplay":
        """Read what ``write`` wrote.

        Raises:
            ConfigError: The file is missing or torn.
        """
        try:
            content = json.loads(gzip.decompress(path.read_bytes()))
        except (OSError, EOFError, zlib.error, UnicodeDecodeError, json.JSONDecodeError) as error:
            raise ConfigError(f"{str(path)!r} is no replay, or is torn: {error}") from None
        if not isinstance(content, dict) or "times" not in content:
            raise ConfigError(f"{str(path)!r} is no replay")
        return cls(content)


@dataclass
class _Frame:
    """What one instant looks like; poses of robots (R, 3), particles (N, 2), scans (R, beams), a packed map."""

    time: float
    true: Floats | None
    believed: Floats | None
    goals: Floats | None
    scans: Floats | None
    particles: Floats | None
    planned: Floats | None
    cells: bytes = b""
    shape: tuple[int, ...] = ()
    origin: tuple[float, ...] = ()
    resolution: float = 0.0


@dataclass
class ReplayRecorder:
    """Takes the frames of an episode while it runs; its memory does not grow with the episode's length."""

    _frames: list[_Frame] = field(default_factory=list)
    _stride: int = 1
    _seen: int = 0

    def note(self, recording: Recording) -> None:
        """Take the instant that a recording has just noted."""
        self._seen += 1
        if (self._seen - 1) % self._stride == 0:
            self._add(_frame_of(recording, self._seen - 1))

    def finish(self, recording: Recording) -> EpisodeReplay | None:
        """Return the replay; None where the environment tells no poses.

        The content has ``times`` [s], and by robots and frames ``true`` and ``believed`` poses [mm, mm, mrad],
        ``goals`` [mm], ``scans`` [cm], ``particles`` [cm], ``planned`` paths [cm], a ``map`` as changes of cells, and
        ``walls`` and ``pillars`` [mm]; what the environment does not tell is left out.
        """
        if (self._seen - 1) % self._stride:
            self._add(_frame_of(recording, self._seen - 1))  # the last instant is always there
        frames = self._frames
        if not frames or (frames[0].true is None and frames[0].believed is None):
            return None
        content: dict[str, Any] = {"times": [round(frame.time, 3) for frame in frames]}
        for name, scale in (("true", 1000), ("believed", 1000), ("goals", 1000), ("scans", 100), ("particles", 100)):
            values = [getattr(frame, name) for frame in frames]
            if all(value is not None and value.shape == values[0].shape for value in values):
                content[name] = [_whole(value, scale) for value in values]
        if any(frame.planned is not None for frame in frames):
            content["planned"] = [[] if f.planned is None else _whole(f.planned, 100) for f in frames]
        if "scans" in content:
            content["angles"] = _angles(recording.env)
        content |= _surroundings(recording)
        if all(frame.cells for frame in frames):
            content["map"] = _changes(frames)
        return EpisodeReplay(content)

    def _add(self, frame: _Frame) -> None:
        self._frames.append(frame)
        if len(self._frames) > MOST_FRAMES:
            self._frames = self._frames[::2]
            self._stride *= 2


def _frame_of(recording: Recording, step: int) -> _Frame:
    info = recording.info
    true, pose = _poses(entry_of(info, "truth.pose")), _poses(info.get("pose"))
    known = "map" in info or "odometry_pose" in info  # the pose is SLAM's
    time = info.get("time", step)
    frame = _Frame(
        float(time) if np.ndim(time) == 0 else float(np.max(time)),
        true if true is not None or known else pose,
        pose if known else None,
        _points(info.get("goal")),
        _scans(info.get("scan")),
        _particles(recording.env),
        _planned(recording.policy),
    )
    cells = info.get("map")
    if isinstance(cells, np.ndarray) and cells.ndim == 2 and "origin" in info and "resolution" in info:
        kinds = np.where(cells < 0, 0, np.where(cells >= _OCCUPIED, 2, 1)).astype(np.uint8)
        frame.cells, frame.shape = zlib.compress(kinds.tobytes(), 1), kinds.shape
        frame.origin = tuple(float(value) for value in np.ravel(info["origin"])[:2])
        frame.resolution = float(info["resolution"])
    return frame


def _poses(value: Any) -> Floats | None:
    """Poses as (robots, 3); None where there are none."""
    array = None if value is None or isinstance(value, Mapping) else np.asarray(value)
    if array is None or array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or array.shape[-1] != 3:
        return None
    poses = array.reshape(-1, 3).astype(np.float64)
    return poses if np.isfinite(poses).all() else None


def _points(value: Any) -> Floats | None:
    array = None if value is None or isinstance(value, Mapping) else np.asarray(value)
    if array is None or array.dtype.kind not in "fiu" or array.ndim not in (1, 2) or array.shape[-1] not in (2, 3):
        return None
    points = array.reshape(-1, array.shape[-1])[:, :2].astype(np.float64)
    return points if np.isfinite(points).all() else None


def _scans(value: Any) -> Floats | None:
    array = None if value is None or isinstance(value, Mapping) else np.asarray(value)
    if array is None or array.dtype.kind != "f" or array.ndim not in (1, 2) or not np.isfinite(array).all():
        return None
    scans = array.reshape(-1, array.shape[-1]).astype(np.float64)
    return scans[:, :: _thinning(scans.shape[1])]


def _thinning(beams: int) -> int:
    return -(-beams // MOST_BEAMS)


def _angles(env: Any) -> list[float]:
    """Of the beams that are kept, in the robot's frame [rad]; empty where the options tell no lidar."""
    owner = owner_of(env, "options")
    lidar = getattr(getattr(owner, "options", None), "lidar", None)
    angles = np.asarray(getattr(lidar, "angles", np.empty(0)), np.float64)
    return [round(float(angle), 4) for angle in angles[:: _thinning(max(len(angles), 1))]]


def _particles(env: Any) -> Floats | None:
    """Of a particle filter, (N, 2); None of other estimators."""
    owner = owner_of(env, "episodes")
    found: Any = owner
    for name in ("episodes", "core", "estimator", "particles"):
        found = getattr(found, name, None)
    return None if found is None or len(found) != 1 else np.array(found[0, :, :2], np.float64)


def _planned(policy: Any) -> Floats | None:
    """The path that a policy is on, (n, 2), where it shows it; a long one by some of its points."""
    for one in (policy, getattr(policy, "driver", None), getattr(policy, "_driver", None)):
        path = getattr(one, "path", None)
        if isinstance(path, np.ndarray) and path.ndim == 2 and path.shape[1] == 2 and np.isfinite(path).all():
            every = max(1, -(-len(path) // MOST_POINTS))
            shown = path[::every] if (len(path) - 1) % every == 0 else np.vstack([path[::every], path[-1:]])
            return shown.astype(np.float64)
    return None


def _surroundings(recording: Recording) -> dict[str, Any]:
    """Walls, pillars and the robots' radius."""
    plan = getattr(recording.env.unwrapped, "floorplan", None)
    found: dict[str, Any] = {}
    if plan is not None:
        found["walls"] = _whole(np.asarray(plan.edges, np.float64), 1000)
        found["pillars"] = _whole(np.asarray(plan.circles, np.float64), 1000)
    radius = recording.info.get("radius")
    if radius is not None and np.size(radius) and np.isfinite(np.asarray(radius, np.float64)).all():
        found["radius"] = round(1000 * float(np.max(radius)))
    return found


def _whole(values: Floats, scale: float) -> list[Any]:
    """Rounded to whole numbers of a smaller unit, which text holds in little room."""
    numbers: list[Any] = np.rint(scale * values).astype(np.int64).tolist()
    return numbers


def _changes(frames: Sequence[_Frame]) -> dict[str, Any]:
    """The map in the last frame's cells, and which of them changed in each frame.

    A change is 3 · cell + kind (0 unknown, 1 free, 2 occupied); each is written as its distance from the one before.
    """
    last = frames[-1]
    now = np.zeros(last.shape, np.uint8)
    changes = []
    for frame in frames:
        kinds = np.frombuffer(zlib.decompress(frame.cells), np.uint8).reshape(frame.shape)
        shown = _onto(kinds, frame, last)
        cells = np.flatnonzero(shown != now)
        coded = 3 * cells.astype(np.int64) + shown.ravel()[cells]
        changes.append(np.diff(coded, prepend=0).tolist())
        now = shown
    rows, columns = last.shape
    size = {"rows": rows, "columns": columns, "resolution": last.resolution, "origin": list(last.origin)}
    return size | {"changes": changes}


def _onto(kinds: NDArray[np.uint8], frame: _Frame, last: _Frame) -> NDArray[np.uint8]:
    """A frame's cells in the last frame's grid, which may have grown or moved; what lies outside is left out."""
    if frame.shape == last.shape and frame.origin == last.origin:
        return kinds
    shown = np.zeros(last.shape, np.uint8)
    shift = [round((a - b) / last.resolution) for a, b in zip(frame.origin, last.origin, strict=True)][::-1]
    rows, columns = np.nonzero(kinds)
    inside = (rows + shift[0] >= 0) & (rows + shift[0] < last.shape[0])
    inside &= (columns + shift[1] >= 0) & (columns + shift[1] < last.shape[1])
    rows, columns = rows[inside], columns[inside]
    shown[rows + shift[0], columns + shift[1]] = kinds[rows, columns]
    return shown
