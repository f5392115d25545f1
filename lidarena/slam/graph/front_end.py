"""The front end: every scan is matched against the keyframes before it."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.graph.correlation import best_in_window, draw_scan, empty_grid
from lidarena.slam.graph.odometry_spread import motion_spread
from lidarena.slam.graph.point_to_line import align
from lidarena.slam.graph.surface_points import BeamFan, SurfacePoints, empty_points, enlarged_points, enter_scan
from lidarena.slam.planar import between, compose, wrapped

Floats = NDArray[np.float64]

_ROUNDS = np.array([0.3, 0.25, 0.2, 0.15, 0.12, 0.1, 0.1, 0.1])
"""Distance within which points belong together, round by round [m]."""
_DRAWN = 40
"""Keyframes in the grid for the correlative search."""
_POINTS = 60
"""Points of a scan in the correlative search."""
_ALIGNED = 180
"""Points of a scan that are aligned, about."""
_STILL_WINDOW, _STANDS_STILL = 0.05, 0.85
"""Where the wheels stand still, a match is looked for within the first [m]; below the second it is no proof of it."""
_FEWEST_POINTS = 10
"""Scans of fewer points are not matched."""


@dataclass(frozen=True)
class FrontEndParameters:
    """Settings of the front end.

    Attributes:
        usable_range: Longer ranges are left out [m].
        keyframe_distance: A keyframe is taken after so much way [m],
        keyframe_turn: or so much turn [rad].
        references: Keyframes that a scan is aligned with.
        low_score: A match below this is searched in a wider window.
        lost_score: A match below this is not believed.
        low_share: Where a smaller share of the points lies on known surfaces, the scan is searched farther away, too.
    """

    usable_range: float = 20.0
    keyframe_distance: float = 0.25
    keyframe_turn: float = 0.15
    references: int = 6
    low_score: float = 0.65
    lost_score: float = 0.3
    low_share: float = 0.5


@dataclass
class FrontEnd:
    """Poses from scan to scan, in one frame that drifts slowly.

    Attributes:
        fan: The beams.
        parameters: Settings.
        store: The keyframes' scans in their order, and the last scan behind them.
        poses: Of all scans, as matched.
        keyframes: Which scans are keyframes.
        information: Of each keyframe, how surely its match holds it where it is: upper triangle (6,) of the normal
            equations, in the frame of the poses.
        scores: How well each scan fitted, 0 to 1.
        views: Of each keyframe, the middle (2,) of what it saw, in the laser's frame [m].
        held: Whether a scan's match was not believed, so that the wheels alone tell its pose.
        shares: Share of each scan's points that lie on known surfaces.
    """

    fan: BeamFan
    parameters: FrontEndParameters = field(default_factory=FrontEndParameters)
    poses: list[Floats] = field(default_factory=list)
    keyframes: list[int] = field(default_factory=list)
    information: list[Floats] = field(default_factory=list)
    scores: list[float] = field(default_factory=list)
    views: list[Floats] = field(default_factory=list)
    held: list[bool] = field(default_factory=list)
    shares: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.store: SurfacePoints = empty_points(256, self.fan.beams)
        self.grid = empty_grid()
        self.drawn = 0
        self.odometry, self.system = np.zeros(3), np.zeros(16)
        self._slots, self._free = np.zeros(256, np.int64), list[int]()
        self._next = 0

    @property
    def count(self) -> int:
        """Scans so far."""
        return len(self.poses)

    def node(self, keyframe: int) -> Floats:
        """(3,) pose of a keyframe, by its place in their order."""
        return self.poses[self.keyframes[keyframe]]

    def slots(self, keyframes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Where the scans of keyframes are in the store."""
        return self._slots[keyframes]

    def slot(self, keyframe: int) -> int:
        """Where the scan of a keyframe is in the store."""
        return int(self._slots[keyframe])

    def release(self, keyframe: int) -> None:
        """Give the room of a keyframe that nothing is compared with any more to a later one."""
        self._free.append(self.slot(keyframe))

    def spare_slot(self) -> int:
        """A slot of the store that holds no keyframe; the next scan goes there."""
        if self._free:
            return self._free[-1]
        if self._next == len(self.store.points):
            self.store = enlarged_points(self.store)
        return self._next

    def _occupy(self, slot: int) -> None:
        """The scan in a slot has become the last keyframe."""
        if self._free:
            self._free.pop()
        else:
            self._next += 1
        if len(self.keyframes) > len(self._slots):
            self._slots = np.concatenate([self._slots, np.zeros_like(self._slots)])
        self._slots[len(self.keyframes) - 1] = slot

    def add(self, odometry: Floats, ranges: NDArray[np.float32], unsure: bool = False) -> bool:
        """Match a scan.

        Args:
            odometry: (3,) where the laser is by the wheels.
            ranges: (B,) [m]; 0 is no return.
            unsure: The wheels do not tell how the laser came here from the scan before.

        Returns:
            Whether it has become a keyframe.
        """
        slot = self.spare_slot()
        points = enter_scan(self.store, slot, ranges, self.fan, self.parameters.usable_range)
        self.system[:] = 0.0
        if not self.poses:
            pose, score = odometry.copy(), 1.0
        else:
            pose, score = self._match(slot, self._told(odometry, unsure), points, unsure)
        pose[2] = wrapped(pose[2])
        self.odometry = odometry
        self.poses.append(pose)
        self.scores.append(score)
        self.shares.append(float(self.system[10] / max(self.system[11], 1.0)))
        self.held.append(score < self.parameters.lost_score)
        return self._keep(slot, points)

    def _told(self, odometry: Floats, unsure: bool) -> Floats:
        """The motion since the last scan: by the wheels, or going on as before."""
        if not unsure:
            return between(self.odometry, odometry)
        return between(self.poses[-2], self.poses[-1]) if len(self.poses) > 1 else np.zeros(3)

    def _match(self, slot: int, motion: Floats, points: int, unsure: bool) -> tuple[Floats, float]:
        """Pose and score of the scan in a slot after a motion."""
        guess = compose(self.poses[-1], motion)
        if points < _FEWEST_POINTS or not self.keyframes:
            return guess, 0.0
        spread, window = _believed(motion, unsure)
        found = self._search(slot, guess, window, spread)
        if window[0] <= _STILL_WINDOW and found[3] < _STANDS_STILL:  # wheels that hang tell that nothing moves
            loose, around = _believed(motion, unsure=True)
            moved = self._search(slot, compose(self.poses[-1], self._told(self.odometry, unsure=True)), around, loose)
            if moved[3] > found[3] + 0.03:
                found, spread = moved, loose
        far = np.array([max(0.5, 2.0 * spread[0], 2.5 * math.hypot(motion[0], motion[1])), max(0.6, 3.0 * spread[1])])
        if found[3] < self.parameters.low_score:
            wide = self._search(slot, guess, far, spread)
            found = wide if wide[3] > found[3] + 0.03 else found
        if found[3] < self.parameters.lost_score:
            return guess, float(found[3])
        pose, share = self._aligned(slot, found[:3], spread)
        if share < self.parameters.low_share:
            # wheels that count backwards as forwards, and the like
            wide, system = self._search(slot, guess, far, 3.0 * spread), self.system.copy()
            other, better = self._aligned(slot, wide[:3], spread)
            if better > share + 0.1:
                return other, float(wide[3])
            self.system[:] = system
        return pose, float(found[3])

    def _aligned(self, slot: int, found: Floats, spread: Floats) -> tuple[Floats, float]:
        """The pose near a found one where the surfaces lie together, and the share of the points that fit there."""
        others = self._references(found)
        pose, poses = found.copy(), np.array([self.node(int(o)) for o in others])
        prior = np.array([4.0, 4.0, 1.0]) / spread[[0, 0, 1]] ** 2
        stride = max(self.fan.beams // _ALIGNED, 1)
        align(self.store, self.fan, slot, self.slots(others), poses, pose, prior, _ROUNDS, stride, self.system)
        moved = between(found, pose)
        strayed = math.hypot(moved[0], moved[1]) > 0.3 or abs(moved[2]) > 0.2
        return found.copy() if strayed else pose, float(self.system[10] / max(self.system[11], 1.0))

    def _search(self, slot: int, guess: Floats, window: Floats, spread: Floats) -> Floats:
        """Best pose in a window, coarsely, then finely."""
        coarse = np.array([0.1, 0.035]) if window[0] > 0.05 else np.array([0.05, 0.02])
        found = best_in_window(self.grid, self.store, slot, guess, window, coarse, spread, _POINTS)
        fine = np.array([0.05, 0.02]), np.array([0.05, 0.01])
        return best_in_window(self.grid, self.store, slot, found[:3], *fine, np.array([10.0, 10.0]), _POINTS)

    def _references(self, pose: Floats) -> NDArray[np.int64]:
        """The keyframes that see best what is seen from a pose, among the last ones, by their order."""
        recent = np.arange(max(len(self.keyframes) - _DRAWN, 0), len(self.keyframes))
        others = np.array([self.node(int(k)) for k in recent])
        away = np.hypot(others[:, 0] - pose[0], others[:, 1] - pose[1])
        cost = away + 1.0 * np.abs(wrapped(others[:, 2] - pose[2])) + 0.01 * np.arange(len(recent))[::-1]
        order = np.argsort(cost, kind="stable")[: self.parameters.references]
        return np.asarray(recent[np.sort(order)], np.int64)

    def _keep(self, slot: int, points: int) -> bool:
        """Make the last scan a keyframe if it is far enough from the keyframe before."""
        if self.keyframes:
            motion = between(self.node(-1), self.poses[-1])
            near = math.hypot(motion[0], motion[1]) < self.parameters.keyframe_distance
            if points < _FEWEST_POINTS or (near and abs(motion[2]) < self.parameters.keyframe_turn):
                return False
        self.keyframes.append(len(self.poses) - 1)
        self._occupy(slot)
        self.information.append(self.system[:6].copy())
        seen = self.store.points[slot][self.store.weights[slot] > 0.0]
        self.views.append(np.asarray(seen.mean(axis=0), np.float64) if len(seen) else np.zeros(2))
        draw_scan(self.grid, self.store, slot, self.poses[-1], 1)
        if len(self.keyframes) - self.drawn > _DRAWN:
            self._forget()
        return True

    def _forget(self) -> None:
        """Wipe the oldest keyframes out of the grid, and draw again what they shared with others."""
        last = len(self.keyframes)
        middle = (self.drawn + last) // 2
        for old in range(self.drawn, middle):
            draw_scan(self.grid, self.store, self.slot(old), self.node(old), -1)
        for kept in range(middle, last):
            draw_scan(self.grid, self.store, self.slot(kept), self.node(kept), 1)
        self.drawn = middle


def viewed(poses: Floats, views: Floats) -> Floats:
    """(K, 2) the middle of what was seen from poses (K, 3), from ``views`` (K, 2) in the laser's frame."""
    return compose(poses, np.concatenate([views, np.zeros((len(views), 1))], axis=1))[:, :2]


def _believed(motion: Floats, unsure: bool) -> tuple[Floats, Floats]:
    """How far a motion is believed, and the window to search first: (2,) each [m, rad]."""
    if unsure:
        return np.array([0.2, 0.3]), np.array([0.5, 0.6])
    spread = np.array(motion_spread(motion))
    if math.hypot(motion[0], motion[1]) < 1e-3 and abs(motion[2]) < 1e-3:
        return spread, np.array([_STILL_WINDOW, 0.02])
    return spread, np.array([max(0.1, min(2.0 * spread[0], 0.3)), max(0.03, min(2.0 * spread[1], 0.6))])
