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
    """

    usable_range: float = 20.0
    keyframe_distance: float = 0.25
    keyframe_turn: float = 0.15
    references: int = 6
    low_score: float = 0.65
    lost_score: float = 0.3


@dataclass
class FrontEnd:
    """Poses from scan to scan, in one frame that drifts slowly.

    Attributes:
        fan: The beams.
        parameters: Settings.
        store: All scans.
        count: How many.
        poses: Of all scans, as matched.
        odometry: Of all scans, as the wheels tell.
        keyframes: Which scans are keyframes.
        scores: How well each scan fitted, 0 to 1.
        held: Whether a scan's match was not believed, so that the wheels alone tell its pose.
    """

    fan: BeamFan
    parameters: FrontEndParameters = field(default_factory=FrontEndParameters)
    count: int = 0
    poses: list[Floats] = field(default_factory=list)
    odometry: list[Floats] = field(default_factory=list)
    keyframes: list[int] = field(default_factory=list)
    scores: list[float] = field(default_factory=list)
    held: list[bool] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.store: SurfacePoints = empty_points(256, self.fan.beams)
        self.grid = empty_grid()
        self.drawn: list[int] = []

    def add(self, odometry: Floats, ranges: NDArray[np.float32]) -> bool:
        """Match a scan.

        Args:
            odometry: (3,) where the laser is by the wheels.
            ranges: (B,) [m]; 0 is no return.

        Returns:
            Whether it has become a keyframe.
        """
        k = self.count
        if k == len(self.store.points):
            self.store = enlarged_points(self.store)
        points = enter_scan(self.store, k, ranges, self.fan, self.parameters.usable_range)
        self.count += 1
        self.odometry.append(odometry)
        if k == 0:
            pose, score = odometry.copy(), 1.0
        else:
            pose, score = self._match(k, between(self.odometry[k - 1], odometry), points)
        pose[2] = wrapped(pose[2])
        self.poses.append(pose)
        self.scores.append(score)
        self.held.append(score < self.parameters.lost_score)
        return self._keep(k, points)

    def _match(self, k: int, motion: Floats, points: int) -> tuple[Floats, float]:
        """Pose and score of scan k after a motion told by the wheels."""
        guess = compose(self.poses[-1], motion)
        still = math.hypot(motion[0], motion[1]) < 1e-3 and abs(motion[2]) < 1e-3
        if points < 10 or not self.keyframes:
            return guess, 0.0
        shift, turn = motion_spread(motion)
        spread = np.array([shift, turn])
        window = np.array([max(0.1, min(2.0 * shift, 0.3)), max(0.03, min(2.0 * turn, 0.6))])
        if still:
            window = np.array([0.05, 0.02])
        found = self._search(k, guess, window, spread)
        if found[3] < self.parameters.low_score:
            wide = self._search(k, guess, np.array([max(0.5, 2 * shift), max(0.6, 3.0 * turn)]), spread)
            found = wide if wide[3] > found[3] + 0.03 else found
        if found[3] < self.parameters.lost_score:
            return guess, float(found[3])
        others = self._references(found[:3])
        pose, system = found[:3].copy(), np.zeros(16)
        poses = np.array([self.poses[o] for o in others])
        prior = np.array([4.0 / shift**2, 4.0 / shift**2, 1.0 / turn**2])
        stride = max(self.fan.beams // _ALIGNED, 1)
        align(self.store, self.fan, k, others, poses, pose, prior, _ROUNDS, stride, system)
        moved = between(found[:3], pose)
        if math.hypot(moved[0], moved[1]) > 0.3 or abs(moved[2]) > 0.2:
            return found[:3].copy(), float(found[3])
        return pose, float(found[3])

    def _search(self, k: int, guess: Floats, window: Floats, spread: Floats) -> Floats:
        """Best pose in a window, coarsely, then finely."""
        coarse = np.array([0.1, 0.035]) if window[0] > 0.05 else np.array([0.05, 0.02])
        found = best_in_window(self.grid, self.store, k, guess, window, coarse, spread, _POINTS)
        fine = np.array([0.05, 0.02]), np.array([0.05, 0.01])
        return best_in_window(self.grid, self.store, k, found[:3], *fine, np.array([10.0, 10.0]), _POINTS)

    def _references(self, pose: Floats) -> NDArray[np.int64]:
        """The keyframes that see best what is seen from a pose, among the last ones."""
        recent = self.keyframes[-_DRAWN:]
        others = np.array([self.poses[k] for k in recent])
        away = np.hypot(others[:, 0] - pose[0], others[:, 1] - pose[1])
        cost = away + 1.0 * np.abs(wrapped(others[:, 2] - pose[2])) + 0.01 * np.arange(len(recent))[::-1]
        order = np.argsort(cost, kind="stable")[: self.parameters.references]
        return np.array(recent, np.int64)[np.sort(order)]

    def _keep(self, k: int, points: int) -> bool:
        """Make a scan a keyframe if it is far enough from the last one."""
        if self.keyframes:
            motion = between(self.poses[self.keyframes[-1]], self.poses[k])
            near = math.hypot(motion[0], motion[1]) < self.parameters.keyframe_distance
            if points < 10 or (near and abs(motion[2]) < self.parameters.keyframe_turn):
                return False
        self.keyframes.append(k)
        self.drawn.append(k)
        draw_scan(self.grid, self.store, k, self.poses[k], 1)
        if len(self.drawn) > _DRAWN:
            self._forget()
        return True

    def _forget(self) -> None:
        """Wipe the oldest keyframes out of the grid, and draw again what they shared with others."""
        half = len(self.drawn) // 2
        for old in self.drawn[:half]:
            draw_scan(self.grid, self.store, old, self.poses[old], -1)
        self.drawn = self.drawn[half:]
        for kept in self.drawn:
            draw_scan(self.grid, self.store, kept, self.poses[kept], 1)
