"""Odometry of a recorded sequence: corners tracked from frame to frame, and the last few frames fitted together."""

from collections.abc import Callable
from dataclasses import dataclass, field
from time import process_time

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.base.random_streams import seed_stream
from lidarena.vision.bundle import Observations, adjust
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import FeatureOptions, Image, Pair, even, guessed_right, track
from lidarena.vision.matching import Matches
from lidarena.vision.motion import MotionOptions, estimate_motion
from lidarena.vision.recordings.recording import StereoRecording
from lidarena.vision.rigid_motion import inverse, moved, orthonormal

Floats = NDArray[np.float64]

_SAME = 1.0
"""Tracks that Lucas-Kanade does not lead back to within so many pixels are dropped."""


@dataclass(frozen=True)
class SequenceOptions:
    """How a sequence is followed.

    Attributes:
        count: Corners that are tracked.
        window: Frames that are fitted together.
        spacing: Least distance between corners [pixels].
        nearest: Least depth [m].
        farthest: Greatest depth, as a multiple of the baseline.
    """

    count: int = 700
    window: int = 6
    spacing: float = 11.0
    nearest: float = 0.3
    farthest: float = 150.0


@dataclass
class SequenceResult:
    """What came out.

    Attributes:
        poses: (N, 4, 4) left camera to world, the first one the identity.
        dropped: Frames whose motion could not be computed; the last motion was taken to go on.
        unread: Frames that could not be read, with the reason.
        seconds: Of processor time, reading included.
        tracked: (N,) corners that agreed on the motion to each frame.
    """

    poses: Floats
    dropped: list[int] = field(default_factory=list)
    unread: dict[int, str] = field(default_factory=dict)
    seconds: float = 0.0
    tracked: list[int] = field(default_factory=list)


def follow(
    recording: StereoRecording,
    options: SequenceOptions = SequenceOptions(),
    seed: int = 0,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> SequenceResult:
    """Compute the trajectory of a recorded sequence.

    A frame that is missing, torn, or shows too little keeps the trajectory so far: the camera is taken to move on as
    before, and the frame is told of in the result.

    Args:
        recording: The sequence.
        options: How.
        seed: Of RANSAC's samples.
        progress: Called with how many frames are done, of how many.

    Raises:
        VisionError: The first frame cannot be read, or left and right are swapped.
    """
    begun = process_time()
    tracker = SequenceTracker(recording.camera, options, seed_stream(np.random.default_rng(seed)))
    first = recording.pair(0)
    recording.check_sides(first)
    tracker.add(first)
    result = SequenceResult(np.eye(4)[None], tracked=[len(tracker.points)])
    for number in range(1, len(recording.files)):
        try:
            fine = tracker.add(recording.pair(number))
        except VisionError as error:
            result.unread[number] = str(error)
            fine = tracker.skip()
        if not fine:
            result.dropped.append(number)
        result.tracked.append(tracker.agreeing)
        progress(number + 1, len(recording.files))
    result.poses, result.seconds = np.stack(tracker.poses), process_time() - begun
    return result


class SequenceTracker:
    """Follows corners through pairs that come one after the other.

    Args:
        camera: Of all pairs.
        options: How.
        stream: State (4,) of the random stream that RANSAC draws from.

    Attributes:
        poses: (4, 4) camera to world of each pair so far.
        points: (K, 3) of the tracked corners in the world [m].
        agreeing: Corners that agreed on the last motion.
    """

    def __init__(self, camera: StereoCamera, options: SequenceOptions, stream: NDArray[np.uint64]) -> None:
        self.camera, self.options, self._stream = camera, options, stream
        self.poses: list[Floats] = []
        self.points = np.empty((0, 3))
        self.agreeing = 0
        self._images: Pair | None = None
        self._motion = np.eye(4)
        self._history = np.empty((0, 0, 4))  # (frames of the window, corners, 4) pixels, NaN where not seen
        self._features = FeatureOptions(
            kind="tracks", nearest=options.nearest, farthest=options.farthest * camera.baseline
        )

    def add(self, images: Pair) -> bool:
        """Take the next pair; returns False where its motion could not be computed."""
        pair = even(images[0]), even(images[1])
        if self._images is None:
            self.poses.append(np.eye(4))
            self._history = np.empty((1, 0, 4))
            self._replenish(pair)
            return True
        fine = self._move(pair)
        self._replenish(pair)
        return fine

    def skip(self) -> bool:
        """Go on as before without a pair; returns False."""
        self.poses.append(self.poses[-1] @ inverse(self._motion))
        self.agreeing = 0
        return False

    def _move(self, pair: Pair) -> bool:
        pixels, fits = self._follow(pair)
        here = self._history[-1]
        found = np.flatnonzero(fits)
        matches = Matches(found, found, here[found], pixels[found], np.ones(len(found)))
        try:
            estimate = estimate_motion(matches, self.camera, MotionOptions(limit=2.0), self._stream)
        except VisionError:
            self.skip()
            self._history, self.points = np.empty((1, 0, 4)), np.empty((0, 3))
            return False
        kept = matches.first[estimate.agree]
        self._motion, self.agreeing = estimate.motion, len(kept)
        self.poses.append(self.poses[-1] @ inverse(estimate.motion))
        latest = np.concatenate([self._history[:, kept], pixels[kept][None]])
        self._history, self.points = latest[-self.options.window :], self.points[kept]
        self._adjust()
        return True

    def _follow(self, pair: Pair) -> tuple[Floats, NDArray[np.bool_]]:
        """Where the corners are in the next pair (K, 4), and which were found."""
        assert self._images is not None
        here = self._history[-1].astype(np.float32)
        ahead = self._motion @ inverse(self.poses[-1])
        expected = self.camera.project(moved(ahead, self.points))
        aim = np.where(np.isfinite(expected), expected, here).astype(np.float32)
        left, fits = track(self._images[0], pair[0], here[:, :2], aim[:, :2])
        back, returned = track(pair[0], self._images[0], left, here[:, :2], levels=1)
        fits &= returned & (np.abs(back - here[:, :2]).max(axis=1, initial=0.0) < _SAME)
        start = left - (aim[:, :2] - aim[:, 2:])
        right, also = track(pair[0], pair[1], left, start, levels=1)
        pixels = np.hstack([left, right]).astype(np.float64)
        return pixels, fits & also & self._plausible(pixels)

    def _plausible(self, pixels: Floats) -> NDArray[np.bool_]:
        reach, disparity = self.camera.focal * self.camera.baseline, pixels[:, 0] - pixels[:, 2]
        near = (disparity >= reach / self._features.farthest) & (disparity <= reach / self._features.nearest)
        return np.asarray(near & (np.abs(pixels[:, 1] - pixels[:, 3]) <= self._features.row_error))

    def _adjust(self) -> None:
        """Fit the poses of the window and the points to all pixels in it."""
        frames = len(self._history)
        seen = np.isfinite(self._history[:, :, 0])
        often = np.flatnonzero(seen.sum(axis=0) >= 2)
        if len(often) < 10:
            return
        which, frame = np.nonzero(seen[:, often].T)
        first = np.searchsorted(which, np.arange(len(often) + 1)).astype(np.int64)
        pixels = self._history[frame, often[which]]
        observed = Observations(first, frame.astype(np.int64), pixels, np.full((len(pixels), 2), 0.3))
        begin = np.stack([inverse(pose) for pose in self.poses[-frames:]])
        fitted = adjust(self.camera, begin, self.points[often], observed, row_weight=0.0, huber=1.5)
        for number in range(frames):
            pose = inverse(fitted.poses[number])
            pose[:3, :3] = orthonormal(pose[:3, :3])
            self.poses[len(self.poses) - frames + number] = pose
        self.points[often] = fitted.points
        self._motion = inverse(self.poses[-1]) @ self.poses[-2]

    def _replenish(self, pair: Pair) -> None:
        """Look for new corners where there are none."""
        self._images = pair
        wanted = self.options.count - self._history.shape[1]
        if wanted < 0.15 * self.options.count:
            return
        found = self._new_corners(pair[0], wanted)
        if not len(found):
            return
        right, fits = track(pair[0], pair[1], found, guessed_right(pair, found), levels=2)
        pixels = np.hstack([found, right]).astype(np.float64)
        pixels = pixels[fits & self._plausible(pixels)]
        added = np.full((len(self._history), len(pixels), 4), np.nan)
        added[-1] = pixels
        self._history = np.concatenate([self._history, added], axis=1)
        self.points = np.vstack([self.points, moved(self.poses[-1], self.camera.triangulate(pixels))])

    def _new_corners(self, image: Image, wanted: int) -> NDArray[np.float32]:
        free = np.full(image.shape, 255, np.uint8)
        for x, y in np.rint(self._history[-1, :, :2]).astype(int).tolist():
            cv2.circle(free, (x, y), int(self.options.spacing), 0, -1)
        corners = cv2.goodFeaturesToTrack(image, wanted, 0.003, self.options.spacing, mask=free)
        return np.empty((0, 2), np.float32) if corners is None else np.asarray(corners, np.float32).reshape(-1, 2)
