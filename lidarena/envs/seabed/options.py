"""Keywords of the seabed environment, checked at the border."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import Limits, check_range, options_of
from lidarena.envs.common_keywords import CommonKeywords
from lidarena.envs.observers import ObservationSpec, choose_observer
from lidarena.envs.rewards import RewardSpec, choose_reward
from lidarena.envs.seabed.rewards import REWARDS
from lidarena.envs.seabed.scenes import SCENES, SceneKind
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import KINDS, FeatureOptions
from lidarena.vision.motion import OBJECTIVES, MotionOptions
from lidarena.vision.odometry import ANGLES, OdometryOptions
from lidarena.vision.water import Water

OBSERVATIONS = ("navigation",)
RESOLUTIONS = {"600x400": (600, 400), "800x600": (800, 600)}
BOTH = "both"
"""Instead of a scene: drawn for every episode."""
SKIPS = (1, 2, 3, 4, 6, 8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96)
"""Frames from one computed position to the next."""
MODES = ("plain", "six_clouds", "six_clouds_to_middle")
"""What a step may spend: a motion; the 6-cloud fit; the same, ending in the middle."""
VIEW, BASELINE = math.radians(60.0), 0.4
"""The camera's angle of view, which Bobkov et al. do not print, and its baseline [m], which they do."""
_LIMITS = Limits(
    choices={
        "scene": (*SCENES, BOTH),
        "pick": ("random", "by_seed"),
        "resolution": tuple(RESOLUTIONS),
        "features": KINDS,
        "objective": OBJECTIVES,
        "angles": ANGLES,
        "render_mode": (None, "rgb_array"),
    },
    ranges={
        "duration": (2.0, 3600.0),
        "speed": (0.05, 5.0),
        "compass_noise": (1e-4, 20.0),
        "haze": (0.0, 5.0),
        "noise": (0.0, 50.0),
    },
    whole={"seabeds": (1, 10**9), "count": (30, 5000), "least_matches": (6, 5000)},
    switches=("clip", "velocity_log", "expose_truth"),
)


class SeabedKeywords(CommonKeywords, total=False):
    """The keywords of ``SeabedOptions`` with their types, for editors and type checkers."""

    scene: str
    duration: float | None
    speed: float | None
    clearance: Sequence[float] | None
    seabeds: int
    pick: str
    resolution: str
    haze: float
    noise: float
    features: str
    count: int
    objective: str
    least_matches: int
    clip: bool
    angles: str | None
    compass_noise: float
    velocity_log: bool
    skips: Sequence[int]
    overlaps: Sequence[float] | None


@dataclass(frozen=True)
class SeabedOptions:
    """Keywords of ``lidarena/Seabed-v0``.

    Attributes:
        scene: ``"scene1"`` (3.5 to 7 m above the ground, 180 s) or ``"scene2"`` (1 to 10 m, 134 s) of Bobkov et al.;
            ``"both"`` draws one for every episode.
        duration: Of the flight instead of the scene's own [s].
        speed: Instead of the scene's own [m/s].
        clearance: Least and greatest distance to the ground instead of the scene's own [m].
        seabeds: How many different ones the episodes draw from; their numbers begin at 2³¹, beyond those that
            ``pick="by_seed"`` meets.
        pick: ``"random"`` draws a seabed, ``"by_seed"`` takes number s after ``reset(seed=s)``.
        resolution: ``"600x400"`` or ``"800x600"``.
        haze: Of the water [1/m].
        noise: Standard deviation of a pixel's grey.
        features: ``"tracks"``, ``"sift"`` or ``"orb"``.
        count: Features that are looked for in an image.
        objective: ``"reprojection"``, or ``"clouds"`` as Bobkov et al. have it.
        least_matches: A step with fewer is refused.
        clip: Look only at what two views have in common.
        angles: None, ``"fuse"`` the measured attitude, or ``"replace"`` the estimate's by it (Bobkov et al.).
        compass_noise: Standard deviation of the attitude about each axis [degrees].
        velocity_log: Take the displacement of a (perfect) Doppler log.
        skips: Frames between computed positions that can be chosen.
        overlaps: Chosen instead of skips, if given: the longest of ``skips`` is taken by which, as far as is known,
            two views have so much in common.
        observation: ``"navigation"``, or one's own.
        reward: ``"default"``, weights of the terms ``drift``, ``compute``, ``refused``, ``progress``, or a function.
        max_episode_steps: Decisions after which an episode is truncated; -1 never, None the usual 5000.
        expose_truth: Give ``info["truth"]``, for evaluation.
        render_mode: None or ``"rgb_array"``.
    """

    scene: str = "scene1"
    duration: float | None = None
    speed: float | None = None
    clearance: Sequence[float] | None = None
    seabeds: int = 8
    pick: str = "random"
    resolution: str = "600x400"
    haze: float = 0.03
    noise: float = 1.0
    features: str = "tracks"
    count: int = 300
    objective: str = "reprojection"
    least_matches: int = 40
    clip: bool = False
    angles: str | None = None
    compass_noise: float = 0.1
    velocity_log: bool = False
    skips: Sequence[int] = SKIPS
    overlaps: Sequence[float] | None = None
    observation: ObservationSpec = "navigation"
    reward: RewardSpec = "default"
    max_episode_steps: int = 5000
    expose_truth: bool = False
    render_mode: str | None = None

    @classmethod
    def checked(cls, keywords: Mapping[str, Any]) -> "SeabedOptions":
        """Check keywords and fill in the defaults.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type.
        """
        options = options_of(cls, "a seabed environment", keywords, _LIMITS)
        choose_reward(options.reward, REWARDS)
        choose_observer(options.observation, OBSERVATIONS)
        options._check_clearance()
        options._check_skips()
        options._check_overlaps()
        return options

    def _check_clearance(self) -> None:
        if self.clearance is None:
            return
        if not isinstance(self.clearance, list | tuple) or len(self.clearance) != 2:
            raise ConfigError(f"clearance = {self.clearance!r} must be two numbers, the least and the greatest [m]")
        check_range("clearance[0]", self.clearance[0], 0.5, 40.0)
        check_range("clearance[1]", self.clearance[1], self.clearance[0], 40.0)

    def _check_skips(self) -> None:
        whole = isinstance(self.skips, list | tuple) and len(self.skips) > 0
        if not whole or not all(isinstance(one, int) and 1 <= one <= 10_000 for one in self.skips):
            raise ConfigError(f"skips = {self.skips!r} must be a list of whole numbers of frames from 1 to 10000")
        if list(self.skips) != sorted(set(self.skips)):
            raise ConfigError(f"skips = {self.skips!r} must rise")

    def _check_overlaps(self) -> None:
        if self.overlaps is None:
            return
        if not isinstance(self.overlaps, list | tuple) or len(self.overlaps) == 0:
            raise ConfigError(f"overlaps = {self.overlaps!r} must be a list of shares of the view")
        for number, overlap in enumerate(self.overlaps):
            check_range(f"overlaps[{number}]", overlap, 0.0, 0.99)

    @property
    def choices(self) -> Sequence[int] | Sequence[float]:
        """What the first number of an action counts: skips, or overlaps."""
        return self.skips if self.overlaps is None else self.overlaps

    @property
    def kinds(self) -> list[SceneKind]:
        """The scenes that episodes are of, each with what was given instead of its own."""
        names = list(SCENES) if self.scene == BOTH else [self.scene]
        return [self._kind(SCENES[name]) for name in names]

    def _kind(self, own: SceneKind) -> SceneKind:
        low, high = own.clearance if self.clearance is None else self.clearance
        return SceneKind((float(low), float(high)), own.longest, self.duration or own.duration, self.speed or own.speed)

    @property
    def camera(self) -> StereoCamera:
        """The stereo camera."""
        return StereoCamera.with_view(*RESOLUTIONS[self.resolution], VIEW, BASELINE)

    @property
    def water(self) -> Water:
        """What the pictures are taken through."""
        return Water(haze=self.haze, noise=self.noise)

    @property
    def odometry(self) -> OdometryOptions:
        """What is done with the pictures."""
        return OdometryOptions(
            features=FeatureOptions(kind=self.features, count=self.count),
            motion=MotionOptions(objective=self.objective),
            least_matches=self.least_matches,
            clip=self.clip,
            angles=self.angles,
            angle_sigma=math.radians(self.compass_noise),
            velocity_log=self.velocity_log,
        )
