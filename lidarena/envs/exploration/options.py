"""Keywords of the exploration environments, checked at the border."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any
from warnings import warn

import numpy as np

from lidarena.base.earlier_keywords import nest_earlier
from lidarena.base.errors import ConfigError, MapError
from lidarena.base.keyword_checks import Limits, check_range, options_of, plain
from lidarena.envs.common_keywords import CommonKeywords
from lidarena.envs.exploration.rewards import CERTAIN_ENOUGH, ETA, REWARDS
from lidarena.envs.observers import ObservationSpec, choose_observer
from lidarena.envs.rewards import RewardSpec, choose_reward
from lidarena.slam.registry import check_slam, estimator_name
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.lidar import LidarSpec
from lidarena.world.lidars import make_lidar
from lidarena.world.load import MapSpec
from lidarena.world.robots import RobotSpec, make_robot

SlamSpec = str | Callable[..., Any] | Mapping[str, Any]
OBSERVATIONS = (
    "da_slam",
    "da_slam_entropy",
    "sectors",
    "sectors_entropy",
    "frontier_histogram",
    "frontier_histogram_entropy",
    "frontier_arcs",
    "frontier_arcs_entropy",
    "map",
)
_RENAMED_OBSERVATIONS = {"compass": "frontier_histogram"}
_EXAMPLE = "reward = {'preset': 'combined', 'path': 2.0}"
ROBOT = RobotSpec()
"""DA-SLAM's TurtleBot3 Burger, at up to 0.5 m/s and 1 rad/s."""
LIDAR = LidarSpec()
"""Its lidar: 360 beams of 3.5 m all around, noise of 1 cm."""
_LEAST_SIGHT, _MOST_SIGHT = 0.3, 100.0
"""A lidar sees at least so much farther than a collision is, and no farther than the second [m]."""
_EARLIER = {"lidar_noise": ("lidar", "noise"), "collision_distance": ("robot", "collision_distance")}
_LIMITS = Limits(
    choices={"action": ("discrete", "continuous"), "render_mode": (None, "rgb_array")},
    ranges={
        "odometry_noise": (0.0, 100.0),
        "decision_period": (0.01, 2.0),
        "eta": (1e-12, 1e6),
        "certain_enough": (1e-12, 1e6),
        "patience": (0.01, 1e9),
    },
    switches=("expose_truth",),
)


class ExplorationKeywords(CommonKeywords, total=False):
    """The keywords of ``ExplorationOptions`` with their types, for editors and type checkers."""

    map: MapSpec | Sequence[MapSpec]
    action: str
    slam: SlamSpec
    particles: int
    robot: RobotSpec | Mapping[str, Any] | str | None
    lidar: LidarSpec | Mapping[str, Any] | str | None
    odometry_noise: float
    decision_period: float
    start: Pose | str | None
    stop_at: float | None
    patience: float | None
    eta: float
    certain_enough: float


@dataclass(frozen=True)
class ExplorationOptions:
    """Keywords of ``lidarena/Exploration-v0`` and ``lidarena/Env1-v0`` … ``Env4-v0``.

    Attributes:
        map: Floor plan: a built-in name, a map_server YAML, a MovingAI ``.map``, ``"maze:SEED"``; a generator of one's
            own or its ``"module:callable"``, which draws a new plan for every episode (see
            ``lidarena.world.plan_generators.PlanGenerator``); or a list of these, from which every reset draws one.
        reward: ``"completeness"`` (DA-SLAM's eq. 2), ``"d_optimality"`` (eq. 3), or ``"combined"``: the whole map on
            a short path with a certain pose; ``{term: weight}`` of ``completeness``, ``d_optimality``, ``path``,
            ``uncertainty``, ``collision``; ``{"preset": name, term: weight}`` to change some weights of one of the
            three; a function of a ``Step``, or ``"module:function"``; see ``lidarena.envs.rewards``.
        observation: ``"da_slam"`` (DA-SLAM's), ``"sectors"`` (the same with the nearest hit in 36 sectors for its
            five beams), ``"frontier_histogram"`` (that, and which way the edge of the known map lies),
            ``"frontier_arcs"`` (which way on ways that keep clear of things, and how far the robot can drive and turn
            before it touches one), each of them with ``"_entropy"`` behind its name for the entropy of the particles'
            weights in place of the completeness, or ``"map"`` (a dictionary with an egocentric picture of the map); or
            one's own, see ``lidarena.envs.observers``.
        action: ``"discrete"`` (DA-SLAM's three) or ``"continuous"``.
        slam: ``"rbpf"`` runs the particle filter, ``"graph"`` fits a graph of poses (see
            ``lidarena.slam.graph.estimator``), ``"odometry"`` maps with the pose that the odometry adds up to,
            ``"truth"`` with the true one. Or an estimator of one's own: ``"module:callable"``, a class or function (see
            ``lidarena.slam.estimator``). With options: a dictionary of them and of ``name``.
        particles: Of the particle filter.
        robot: A preset of :data:`lidarena.world.robots.ROBOTS`, a mapping of changes (to a ``preset``) such as
            ``{"radius": 0.2, "max_speed": 0.3}``, a ``RobotSpec``, or ``"module:callable"`` that makes one; here the
            ``RobotSpec`` that it stands for. ``collision_distance`` is the range of a beam below which it is a
            collision, 0.015 m more than the radius by default; a larger one in training teaches a margin.
        lidar: The same with the presets of :data:`lidarena.world.lidars.LIDARS` and the ``LidarSpec`` that it stands
            for. Whatever it sees, a bumper all around tells of collisions.
        odometry_noise: Factor on gmapping's motion noise; 0 is perfect odometry.
        decision_period: Time between decisions [s].
        max_episode_steps: Steps after which an episode is truncated; -1 never, None the usual 1000.
        start: (x, y, theta) in the map's frame, ``"random"``, or None for the map's own.
        stop_at: Completeness that ends an episode as done; None never.
        patience: Time without 0.1% more completeness after which an episode is truncated [s]; None never.
        expose_truth: Give ``info["truth"]``, for evaluation.
        render_mode: None or ``"rgb_array"``.
        eta: η of the term ``d_optimality`` [m^(4/3) rad^(2/3)].
        certain_enough: D-optimality from which on down the term ``uncertainty`` pays for no more certainty
            [m^(4/3) rad^(2/3)].
    """

    map: MapSpec | Sequence[MapSpec] = "willow_lobby"
    reward: RewardSpec = "completeness"
    observation: ObservationSpec = "da_slam"
    action: str = "discrete"
    slam: SlamSpec = "rbpf"
    particles: int = 30
    robot: RobotSpec = ROBOT
    lidar: LidarSpec = LIDAR
    odometry_noise: float = 1.0
    decision_period: float = 0.2
    max_episode_steps: int = 1000
    start: Pose | str | None = None
    stop_at: float | None = 0.995
    patience: float | None = None
    expose_truth: bool = False
    render_mode: str | None = None
    eta: float = ETA
    certain_enough: float = CERTAIN_ENOUGH

    @classmethod
    def checked(cls, keywords: Mapping[str, Any]) -> "ExplorationOptions":
        """Check keywords and fill in the defaults.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type.
            MapError: A start that is neither a pose, ``"random"`` nor None.
        """
        keywords = modern_keywords(keywords)
        start = keywords.get("start")
        if start is not None and not isinstance(start, str):
            keywords["start"] = _pose_of(start)
        if keywords.get("reward") == "d_optimality" and "observation" not in keywords:
            words = "observation = 'da_slam' tells the completeness whatever the reward; name it, or 'da_slam_entropy'"
            warn(f"{words}, which reward = 'd_optimality' used to give", DeprecationWarning, stacklevel=3)
        options, given = options_of(cls, "an exploration environment", keywords, _LIMITS), plain(keywords)
        options._check_rest()
        robot, lidar = (
            make_robot(given.get("robot"), ROBOT),
            make_lidar(given.get("lidar"), LIDAR, options.decision_period),
        )
        check_range("lidar.max_range", lidar.max_range, robot.bumper + _LEAST_SIGHT, _MOST_SIGHT)
        return replace(options, robot=robot, lidar=lidar)

    def _check_rest(self) -> None:
        if self.stop_at is not None:
            check_range("stop_at", self.stop_at, 0.0, 1.0)
        self._check_slam()
        choose_reward(self.reward, REWARDS)
        choose_observer(self.observation, OBSERVATIONS)
        if isinstance(self.start, str) and self.start != "random":
            raise MapError(f"start = {self.start!r} must be a pose (x, y, theta), 'random' or None")
        single = isinstance(self.map, str | Floorplan) or callable(self.map)
        if not single and (not isinstance(self.map, Sequence) or not len(self.map)):
            raise ConfigError(f"map = {self.map!r} must be a floor plan's name, file or generator, or a list of them")

    def _check_slam(self) -> None:
        check_slam(self.slam)
        name, given = estimator_name(self.slam), self.particles != type(self).particles
        if given and name == "truth":
            message = f"particles = {self.particles} are for slam='rbpf'; they will be refused with slam='truth'"
            warnings.warn(message, DeprecationWarning, stacklevel=2)
        elif given and name != "rbpf":
            raise ConfigError(f"particles = {self.particles} are for slam='rbpf', not {name!r}")
        elif given and isinstance(self.slam, Mapping) and self.slam.get("particles", self.particles) != self.particles:
            raise ConfigError(f"particles = {self.particles} contradict slam = {dict(self.slam)!r}")

    @property
    def estimator(self) -> SlamSpec:
        """``slam`` with the particles of the particle filter among its options."""
        if estimator_name(self.slam) != "rbpf":
            return self.slam
        given = self.slam if isinstance(self.slam, Mapping) else {}
        return {"name": "rbpf", "particles": self.particles, **given}

    @property
    def maps(self) -> list[MapSpec]:
        """The floor plans to draw from."""
        return list(self.map) if isinstance(self.map, Sequence) and not isinstance(self.map, str) else [self.map]


def modern_keywords(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return keywords in which those of version 0.1 have their names and values of today.

    Raises:
        ConfigError: Some are given under both.
    """
    modern = nest_earlier("an exploration environment", keywords, _EARLIER)
    weights = modern.pop("weights", None)
    if weights is not None:
        if modern.get("reward") != "combined" or not isinstance(weights, Mapping):
            raise ConfigError(f"weights = {weights!r} is given as {_EXAMPLE} now; it went with reward = 'combined'")
        modern["reward"] = {"preset": "combined", **weights}
        warn(f"weights is given as reward = {modern['reward']!r} now", DeprecationWarning, stacklevel=3)
    old = modern.get("observation")
    if isinstance(old, str) and old in _RENAMED_OBSERVATIONS:
        modern["observation"] = now = _RENAMED_OBSERVATIONS[old]
        warn(f"observation = {old!r} is called {now!r} now", DeprecationWarning, stacklevel=3)
    return modern


def keywords_of_0_1(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return keywords that are known to have been given to version 0.1, so that they mean today what they meant.

    There ``reward="d_optimality"`` put the entropy in the last place of the observation, which is one of its own now.
    """
    modern = modern_keywords(keywords)
    seen = modern.get("observation", "da_slam")
    if modern.get("reward") == "d_optimality" and f"{seen}_entropy" in OBSERVATIONS:
        modern["observation"] = f"{seen}_entropy"
        words = f"what reward = 'd_optimality' made of observation = {seen!r} is observation = '{seen}_entropy' now"
        warn(words, DeprecationWarning, stacklevel=2)
    return modern


def _pose_of(start: Any) -> Pose:
    """A start as plain numbers, given as any sequence of three, NumPy's arrays too.

    Raises:
        MapError: It is no pose.
    """
    if isinstance(start, Sequence | np.ndarray) and len(start) == 3:
        x, y, theta = start
        if all(isinstance(v, int | float | np.integer | np.floating) for v in (x, y, theta)):
            return float(x), float(y), float(theta)
    count = f"; it has {len(start)} numbers" if isinstance(start, Sequence | np.ndarray) else ""
    raise MapError(f"start = {start!r} must be a pose (x, y, theta), 'random' or None{count}")
