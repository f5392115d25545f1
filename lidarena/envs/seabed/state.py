"""Vehicles over the seabed: what they have computed so far, and what it has cost."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.envs.seabed.actions import longest_skip
from lidarena.envs.seabed.compute import detection_cost, effort_cost
from lidarena.envs.seabed.options import MODES, SeabedOptions
from lidarena.envs.seabed.scenes import RATE, Scene, frame_store, make_scene
from lidarena.vision.odometry import Effort, Instruments, StereoOdometry
from lidarena.vision.rigid_motion import inverse, motion_of, rotation_of, vector_of
from lidarena.vision.step_size import adaptive_step

Floats = NDArray[np.float64]

RADIUS = 0.4
"""Of the vehicle [m]."""
_UNSEEN = 2**31
"""Numbers of seabeds that are drawn begin here."""


class Vehicle:
    """One world: a vehicle on its flight, and its odometry.

    Args:
        options: The checked keywords.

    Attributes:
        kind: Of the scene.
        scene: The ground and the flight.
        odometry: What has been computed.
        frame: Number of the frame at the last computed position.
        cost: Of all computing so far [s].
        skip: Frames of the last step that was tried.
        refused: Whether the last step was refused.
        refused_from: Steps from this frame must be shorter than so many frames, since those were refused: without and
            with six clouds (2,) [frames].
        speed: Of the vehicle, as computed [m/s].
        drift: By how much the error has moved in the last step [m].
        spent: What the last step has cost [s].
        positions: Estimated x, y, z of each computed position, and of the truth there [m].
        frames: Number of the frame of each computed position.
    """

    def __init__(self, options: SeabedOptions) -> None:
        self.options, self.kinds, self.camera = options, options.kinds, options.camera
        self.kind = self.kinds[0]
        self.store = frame_store(self.camera, options.water, options.odometry.features)
        self.number = -1
        self.stream = np.ones(4, np.uint64)

    def begin(self, rng: np.random.Generator, seed: int | None) -> None:
        """Begin a new flight."""
        drawn = _UNSEEN + int(rng.integers(self.options.seabeds))
        self.number = seed if self.options.pick == "by_seed" and seed is not None else drawn
        if len(self.kinds) > 1:
            self.kind = self.kinds[int(rng.integers(len(self.kinds)))]
        self.stream[:] = seed_stream(rng)
        self.start()

    def start(self) -> None:
        """Begin flight ``number`` with the present random stream."""
        self.scene: Scene = make_scene(self.kind, self.number)
        self.odometry = StereoOdometry(self.camera, self.options.odometry, self.stream)
        self.frame, self.cost, self.skip, self.refused = 0, 0.0, 0, False
        self.drift = self.spent = 0.0
        self.refused_from = np.full(2, np.inf)
        self.speed = self.kind.speed
        self._seen: set[int] = set()
        self.path_lengths = np.zeros(2)
        self._motion = np.zeros(6)  # of a frame: rotation vector and displacement, in the camera's frame
        self._motion[4] = self.speed / RATE
        self.odometry.begin(self._look(0), self.scene.flight.poses[0])
        self.positions = [self._positions()]
        self.frames = [0]

    @property
    def last_frame(self) -> int:
        """Number of the last frame of the flight."""
        return len(self.scene.flight.poses) - 1

    def _look(self, frame: int) -> Any:
        """The features of a frame; it is paid for once."""
        if frame not in self._seen:
            self._seen.add(frame)
            self.cost += detection_cost(self.options.odometry.features, self.camera.width, self.camera.height)
        return self.store.look(self.kind, self.scene, frame)

    def skip_for(self, overlap: float) -> int:
        """The longest skip by which two views have so much in common, as far as is known [frames]."""
        frames = adaptive_step(self.camera, self.known_depth, max(self.speed, 0.02), RATE, overlap)
        return int(self.options.skips[longest_skip(self.options.skips, frames)])

    @property
    def known_depth(self) -> float:
        """Distance to the nearest ground that is seen, or nearly none while nothing is [m]."""
        return max(float(np.nan_to_num(self.odometry.depth)), 0.1)

    def _guess(self, frames: int) -> Floats:
        """About the motion over so many frames, if the vehicle goes on as before."""
        return motion_of(rotation_of(frames * self._motion[:3]), frames * self._motion[3:])

    def step(self, skip: int, mode: str) -> None:
        """Compute the position ``skip`` frames on, or as far as the flight goes; after its end nothing."""
        if self.frame == self.last_frame:
            self.drift = self.spent = 0.0
            return
        before, cost, self.odometry.effort = self._error(), self.cost, Effort()
        target = min(self.frame + self._shortened(skip, mode), self.last_frame)
        middle = self.frame + (target - self.frame) // 2
        arrived, to_middle = target, False
        if mode == MODES[0] or middle in (self.frame, target):
            fine = self.odometry.advance(
                self._look(target), self._guess(target - self.frame), self._instruments(target)
            )
        else:
            to_middle = mode == MODES[2] and target < self.last_frame
            arrived = middle if to_middle else target
            fine = self.odometry.advance_six(
                self._look(middle),
                self._look(target),
                (self._guess(middle - self.frame), self._guess(target - self.frame)),
                self._instruments(arrived),
                to_middle,
            )
        self.cost += effort_cost(self.options.odometry.features, self.odometry.effort)
        self.skip, self.refused = target - self.frame, not fine
        if fine:
            self._arrive(arrived)
        self._limit(fine, mode)
        self.drift, self.spent = float(np.linalg.norm(self._error() - before)), self.cost - cost

    def _shortened(self, skip: int, mode: str) -> int:
        """The skip, or the longest one of at most half of what was refused from here, as Bobkov et al. go on."""
        limit = self.refused_from[int(mode != MODES[0])]
        return skip if skip < limit else int(self.options.skips[longest_skip(self.options.skips, limit / 2)])

    def _limit(self, fine: bool, mode: str) -> None:
        """Note what is not to be tried again from here; where even the shortest step was refused, all may be."""
        if fine or self.skip <= self.options.skips[0]:
            self.refused_from[:] = np.inf
        else:
            self.refused_from[int(mode != MODES[0]) :] = self.skip

    def _arrive(self, frame: int) -> None:
        assert self.odometry.last is not None
        frames, motion = frame - self.frame, self.odometry.last.motion
        self._motion[:3], self._motion[3:] = vector_of(motion[:3, :3]) / frames, motion[:3, 3] / frames
        self.speed = float(np.linalg.norm(motion[:3, 3])) * RATE / frames
        self.frame = frame
        self.positions.append(self._positions())
        self.frames.append(frame)
        step = (self.positions[-1] - self.positions[-2]).reshape(2, 3)
        self.path_lengths += np.linalg.norm(step, axis=1)

    def _instruments(self, frame: int) -> Instruments:
        flight = self.scene.flight
        attitude = self.scene.attitude(frame, self.options.odometry.angle_sigma)
        if not self.options.velocity_log:
            return Instruments(attitude)
        between = inverse(flight.poses[self.frame]) @ flight.poses[frame]
        return Instruments(attitude, between[:3, 3])

    def _positions(self) -> Floats:
        return np.concatenate([self.odometry.pose[:3, 3], self.scene.flight.poses[self.frame][:3, 3]])

    def _error(self) -> Floats:
        return np.asarray(self.odometry.pose[:3, 3] - self.scene.flight.poses[self.frame][:3, 3])

    @property
    def error(self) -> float:
        """How far the last computed position is off [m]."""
        return float(np.linalg.norm(self._error()))

    @property
    def uncertainty(self) -> Floats:
        """Standard deviations of the position, and of the heading, as estimated [m, rad]."""
        here, covariance = self.odometry.pose[:3, 3], self.odometry.covariance
        x, y, z = here.tolist()
        lever = np.hstack([np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]), np.eye(3)])
        spread = lever @ covariance @ lever.T
        return np.sqrt(np.maximum([np.trace(spread), covariance[2, 2]], 0.0))

    @property
    def overlap(self) -> float:
        """Share of the view that the last two computed positions have in common."""
        footprint = self.odometry.depth * self.camera.height / self.camera.focal
        step = self.speed * self.skip / RATE
        return float(np.clip(1.0 - step / max(footprint, 1e-6), 0.0, 1.0))

    @property
    def turn_rate(self) -> float:
        """Of the vehicle, as computed [rad/s]."""
        return float(np.linalg.norm(self._motion[:3])) * RATE

    @property
    def planar(self) -> Floats:
        """The estimated pose x, y, heading (3,) [m, m, rad]."""
        ahead = -self.odometry.pose[:3, 1]
        return np.array([*self.odometry.pose[:2, 3], np.arctan2(ahead[1], ahead[0])])

    @property
    def nees(self) -> float:
        """Normalized squared error of the pose, 6 on the average if its covariance is right; NaN before a step."""
        if not self.odometry.steps:
            return float("nan")
        off = self.scene.flight.poses[self.frame] @ inverse(self.odometry.pose)
        error = np.concatenate([vector_of(off[:3, :3]), off[:3, 3]])
        return float(error @ np.linalg.solve(self.odometry.covariance + 1e-14 * np.eye(6), error))

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What later steps depend on, by name."""
        longest = max(kind.duration for kind in self.kinds)
        odometry, seen = self.odometry, np.zeros(round(longest * RATE) + 1, np.bool_)
        seen[list(self._seen)] = True
        return {
            "number": np.array([self.number, self.kinds.index(self.kind)]),
            "stream": self.stream.copy(),
            "pose": odometry.pose.copy(),
            "covariance": odometry.covariance.copy(),
            "counts": np.array([self.frame, self.skip, odometry.matches, odometry.refused, odometry.steps]),
            "refused": np.array(self.refused),
            "numbers": np.array(
                [self.cost, self.speed, self.drift, self.spent, *self.refused_from, *self.path_lengths]
            ),
            "motion": self._motion.copy(),
            "seen": seen,
        }

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from ``arrays``; the picture's track begins anew."""
        self.number, self.kind = int(saved["number"][0]), self.kinds[int(saved["number"][1])]
        self.stream[:] = saved["stream"]
        stream = self.stream.copy()
        self.start()
        self.stream[:] = stream
        self.frame, self.skip, matches, refused, steps = (int(one) for one in saved["counts"])
        self.odometry.begin(self._look(self.frame), saved["pose"])
        self.odometry.covariance = saved["covariance"].copy()
        self.odometry.matches, self.odometry.refused, self.odometry.steps = matches, refused, steps
        self.refused = bool(saved["refused"])
        self.cost, self.speed, self.drift, self.spent = (float(one) for one in saved["numbers"][:4])
        self.refused_from, self.path_lengths = saved["numbers"][4:6].copy(), saved["numbers"][6:].copy()
        self._motion[:] = saved["motion"]
        self._seen = set(np.flatnonzero(saved["seen"]).tolist())
        self.positions, self.frames = [self._positions()], [self.frame]
