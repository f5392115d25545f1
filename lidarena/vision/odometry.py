"""Stereo visual odometry: positions chained from one pair of images to the next."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import VisionError
from lidarena.base.keyword_checks import check_choice, check_range, check_switch
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import FeatureOptions, Features
from lidarena.vision.matching import Matches, match_pairs
from lidarena.vision.motion import MotionEstimate, MotionOptions, estimate_motion
from lidarena.vision.navigation import adjoint, fuse_angles, replace_angles, replace_translation
from lidarena.vision.rigid_motion import inverse, orthonormal
from lidarena.vision.six_clouds import ThreeViews, fit_six_clouds
from lidarena.vision.step_size import common_view, nearest_depth

Floats = NDArray[np.float64]

ANGLES = (None, "fuse", "replace")
INFLATION = 2.0
"""By this the pixels' errors are larger than their residuals tell, since neighbours and the images of a pair err alike;
chosen so that the NEES of single steps, 17 without it, comes near 6. ``evaluate`` reports the NEES of whole flights."""


@dataclass(frozen=True)
class OdometryOptions:
    """What the odometry does with two pairs; each change of Bobkov et al. has its own switch.

    Attributes:
        features: How features are found and matched.
        motion: How a motion is found.
        least_matches: A step with fewer that agree is refused.
        clip: Look only at what two views have in common.
        angles: ``"replace"`` the attitude by the measured one, ``"fuse"`` both by their variances, or None.
        angle_sigma: Standard deviation of a measured angle [rad].
        velocity_log: Put the Doppler log's displacement in the place of the one that was seen.

    Raises:
        ConfigError: A value out of range.
    """

    features: FeatureOptions = field(default_factory=lambda: FeatureOptions(kind="tracks"))
    motion: MotionOptions = field(default_factory=MotionOptions)
    least_matches: int = 40
    clip: bool = False
    angles: str | None = None
    angle_sigma: float = 0.0017453
    velocity_log: bool = False

    def __post_init__(self) -> None:
        check_range("least_matches", self.least_matches, 6, 10000, whole=True)
        check_choice("angles", self.angles, ANGLES)
        check_range("angle_sigma", self.angle_sigma, 1e-6, 1.0)
        check_switch("clip", self.clip)
        check_switch("velocity_log", self.velocity_log)


@dataclass(frozen=True)
class Instruments:
    """What the other instruments measured at a position; None where there are none.

    Attributes:
        attitude: (3, 3) camera to world.
        displacement: (3,) since the last position, as its camera sees it [m].
    """

    attitude: Floats | None = None
    displacement: Floats | None = None


NO_INSTRUMENTS = Instruments()


@dataclass
class Effort:
    """What was done so far, in units that do not depend on the machine.

    Attributes:
        matched: Features that were compared or followed to another pair.
        fitted: Matches that motions were fitted to.
        motions: How many motions were.
    """

    matched: int = 0
    fitted: int = 0
    motions: int = 0


class StereoOdometry:
    """Chains positions; a step that cannot be computed is refused, and leaves everything as it was.

    Args:
        camera: Of all pairs.
        options: What is done.
        stream: State (4,) of the random stream that RANSAC draws from.

    Attributes:
        pose: (4, 4) camera to world.
        covariance: (6, 6) of rotation vector and translation before which the pose stands, ``exp(w) X + t``.
        features: Of the last position.
        matches: That agreed in the last step.
        refused: Steps that were refused.
        steps: Steps that were taken.
        effort: What was done.
        last: The last motion's estimate.
    """

    def __init__(self, camera: StereoCamera, options: OdometryOptions, stream: NDArray[np.uint64]) -> None:
        self.camera, self.options, self._stream = camera, options, stream
        self.pose, self.covariance = np.eye(4), np.zeros((6, 6))
        self.features: Features | None = None
        self.matches = self.refused = self.steps = 0
        self.effort = Effort()
        self.last: MotionEstimate | None = None

    def begin(self, features: Features, pose: Floats) -> None:
        """Begin at a known pose (4, 4), camera to world."""
        self.pose, self.covariance, self.features = pose.copy(), np.zeros((6, 6)), features
        self.matches = len(features.pixels)

    @property
    def depth(self) -> float:
        """Of the nearest ground at the last position [m]; NaN if nothing was seen."""
        assert self.features is not None
        return nearest_depth(self.camera.triangulate(self.features.pixels))

    def advance(
        self, features: Features, guess: Floats | None = None, instruments: Instruments = NO_INSTRUMENTS
    ) -> bool:
        """Compute the position of another pair; returns False where the step is refused.

        Args:
            features: Of that pair.
            guess: (4, 4) about the motion to it.
            instruments: What was measured there.
        """
        assert self.features is not None
        try:
            _, estimate = self._between(self.features, features, guess)
        except VisionError:
            self.refused += 1
            return False
        self._take(estimate, features, instruments)
        return True

    def advance_six(
        self,
        middle: Features,
        features: Features,
        guesses: tuple[Floats | None, Floats | None],
        instruments: Instruments = NO_INSTRUMENTS,
        to_middle: bool = False,
    ) -> bool:
        """The same with the 6-cloud fit of the last position, one in the middle, and another.

        Args:
            middle: Features of the pair in the middle.
            features: Of the other.
            guesses: About the motions (4, 4) to the middle and to the other.
            instruments: What was measured where the step ends.
            to_middle: End in the middle (Bobkov et al.'s first way) instead of at the other (their second).
        """
        assert self.features is not None
        onward = None if guesses[0] is None or guesses[1] is None else guesses[1] @ inverse(guesses[0])
        try:
            near = self._between(self.features, middle, guesses[0])
            whole = self._between(self.features, features, guesses[1])
            far = self._between(middle, features, onward)
        except VisionError:
            self.refused += 1
            return False
        fitted = fit_six_clouds(ThreeViews(near, far, whole), self.camera, self.options.motion)
        self.effort.fitted += sum(int(one[1].agree.sum()) for one in (near, far, whole))
        self._take(fitted.near if to_middle else fitted.whole, middle if to_middle else features, instruments)
        return True

    def _between(self, one: Features, two: Features, guess: Floats | None) -> tuple[Matches, MotionEstimate]:
        """The motion between two pairs; refuses where too few features agree on it."""
        kept = self._common(one, two, guess)
        self.effort.matched += len(kept[0]) + len(kept[1])
        found = match_pairs(one.taken(kept[0]), two.taken(kept[1]), self.camera, self.options.features, guess)
        second = np.where(found.second >= 0, kept[1][found.second], -1) if len(kept[1]) else found.second
        matches = found._replace(first=kept[0][found.first], second=second)
        self.effort.fitted += len(matches.first)
        self.effort.motions += 1
        estimate = estimate_motion(matches, self.camera, self.options.motion, self._stream)
        count = int(estimate.agree.sum())
        if count < self.options.least_matches:
            raise VisionError(f"{count} features agree on a motion; {self.options.least_matches} at least are needed")
        return matches, estimate

    def _common(
        self, one: Features, two: Features, guess: Floats | None
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Numbers of the features in what both views show, if that is asked for; else of all."""
        every = np.arange(len(one.pixels)), np.arange(len(two.pixels))
        if not self.options.clip or guess is None or not len(one.pixels):
            return every
        depths = self.camera.triangulate(one.pixels)[:, 2]
        low, high = np.nanquantile(depths, (0.05, 0.95))
        regions = common_view(self.camera, guess, (float(low), float(high)))
        return every if regions is None else (one.within(regions[0]), two.within(regions[1]))

    def _take(self, estimate: MotionEstimate, features: Features, instruments: Instruments) -> None:
        options = self.options
        if options.velocity_log and instruments.displacement is not None:
            estimate = estimate._replace(motion=replace_translation(estimate.motion, instruments.displacement))
        self.pose = self.pose @ inverse(estimate.motion)
        self.pose[:3, :3] = orthonormal(self.pose[:3, :3])
        turn = adjoint(self.pose)
        self.covariance = self.covariance + INFLATION**2 * turn @ estimate.covariance @ turn.T
        if options.angles == "replace" and instruments.attitude is not None:
            self.pose = replace_angles(self.pose, instruments.attitude)
        elif options.angles == "fuse" and instruments.attitude is not None:
            self.pose, self.covariance = fuse_angles(
                self.pose, self.covariance, instruments.attitude, options.angle_sigma
            )
        self.features, self.last, self.matches = features, estimate, int(estimate.agree.sum())
        self.steps += 1
