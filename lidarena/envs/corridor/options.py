"""Keywords of the multi-robot environments, checked at the border."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from lidarena.base.earlier_keywords import nest_earlier
from lidarena.base.errors import ConfigError, suggest
from lidarena.base.keyword_checks import Limits, check_range, options_of, plain
from lidarena.envs.common_keywords import CommonKeywords
from lidarena.envs.corridor.rewards import REWARDS
from lidarena.envs.observers import ObservationSpec, choose_observer
from lidarena.envs.rewards import RewardSpec, choose_reward, reward_of_weights
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import LidarSpec
from lidarena.world.lidars import make_lidar
from lidarena.world.load import MapSpec
from lidarena.world.robots import RobotSpec, make_robot

Points = Sequence[Sequence[float]]

MOST_ROBOTS = 64
OBSERVATIONS = ("ranges",)
LIFELONG = "lifelong"
_WEIGHTS = {f"{term}_weight": term for term in REWARDS.names}
"""Keywords of version 0.1, and the terms that they weigh."""
ROBOT = RobotSpec(max_turn_rate=2.0, substep=0.07, reverse=True)
"""TurtleBot3 Burgers, at up to 0.5 m/s forwards and backwards and 2 rad/s; two of them come at most 7 cm nearer to each
other in a step of the physics."""
LIDAR = LidarSpec(beams=36)
"""36 beams of 3.5 m all around, noise of 1 cm."""
_LARGEST_RADIUS = 1.0
_LIDAR_RANGES = (0.5, 100.0)
_EARLIER = {
    "radius": ("robot", "radius"),
    "beams": ("lidar", "beams"),
    "lidar_range": ("lidar", "max_range"),
    "lidar_noise": ("lidar", "noise"),
}
_LIMITS = Limits(
    choices={"action": ("continuous", "discrete"), "render_mode": (None, "rgb_array", "human")},
    ranges={
        "motion_noise": (0.0, 10.0),
        "localization_noise": (0.0, 1.0),
        "stall_rate": (0.0, 1.0),
        "decision_period": (0.02, 1.0),
        "goal_tolerance": (0.02, 1.0),
    },
    whole={"robots": (1, MOST_ROBOTS), "neighbours": (0, MOST_ROBOTS)},
    switches=("collision_ends", "guard", "expose_truth"),
)


class CorridorKeywords(CommonKeywords, total=False):
    """The keywords of ``CorridorOptions`` with their types, for editors and type checkers."""

    map: MapSpec
    robots: int
    places: str | None
    starts: Points | None
    goals: Points | str | None
    action: str
    robot: RobotSpec | Mapping[str, Any] | str | None
    lidar: LidarSpec | Mapping[str, Any] | str | None
    neighbours: int
    guard: bool
    motion_noise: float
    localization_noise: float
    stall_rate: float
    decision_period: float
    goal_tolerance: float
    collision_ends: bool


@dataclass(frozen=True)
class CorridorOptions:
    """Keywords of ``corridor_v0.parallel_env``, ``corridor_v0.env`` and ``lidarena/CorridorCentral-v0``.

    Attributes:
        map: Floor plan: ``office``, ``unstructured``, ``passing``, ``blocked``, or any other (see ``load_floorplan``).
            A generator draws one when the environment is made, for all its worlds and episodes: the ways to every goal
            and the planners' graphs are laid out once, which takes longer than many an episode.
        robots: Size of the team.
        places: Where robots start and go: ``"predefined"`` (the map's own places; where there is a set of them, both
            are drawn from it), ``"random"`` (any places, such that the problem is solvable), the path of a MovingAI
            ``.scen`` file that belongs to a ``.map``, or None: predefined if the map has places, else random.
        starts: (robots, 2) x, y [m] in place of ``places``; with ``goals``.
        goals: (robots, 2) x, y [m], with ``starts``; or ``"lifelong"``: whoever reaches its goal gets another one,
            drawn by the episode's own generator, and nobody is finished but by a collision.
        action: ``"continuous"`` or ``"discrete"``.
        robot: Every robot: a preset of :data:`lidarena.world.robots.ROBOTS`, a mapping of changes (to a ``preset``)
            such as ``{"radius": 0.2, "max_speed": 0.3}``, a ``RobotSpec``, or ``"module:callable"`` that makes one;
            here the ``RobotSpec`` that it stands for. Without a ``collision_distance`` only contact is a collision,
            with one a beam shorter than that, too.
        lidar: Its lidar, the same with the presets of :data:`lidarena.world.lidars.LIDARS` and the ``LidarSpec`` that
            it stands for.
        neighbours: How many of the nearest robots tell each robot where they are and how they move.
        guard: Whether robots slow down and turn aside by themselves before what their lidar shows, see
            :func:`lidarena.envs.corridor.guard.guard_speeds`; they see all around then.
        motion_noise: Factor on the noise of the wheels (see ``corridor_kernels.apply_motion_noise``); 0 = they obey.
        localization_noise: Standard deviation of ``info["pose"]``: metres, and for the heading radians.
        stall_rate: How often a robot is held up for some 3 s, by nobody's fault [1/s].
        decision_period: Time between decisions [s].
        goal_tolerance: Distance from the goal at which a robot has arrived [m].
        collision_ends: Whether a robot that touches something is finished; else it drives on.
        max_episode_steps: Steps after which an episode is truncated; -1 never, None the usual 1000. PettingZoo calls it
            ``max_cycles``.
        observation: ``"ranges"``, or one's own of a robot, see ``lidarena.envs.observers``.
        reward: Of each robot: ``"default"``, ``{term: weight}``, ``{"preset": "default", term: weight}`` to change some
            weights of it, a function of a ``Step``, or ``"module:function"``; see ``lidarena.envs.rewards``. Terms and
            their weights in ``"default"``: ``progress`` 1, ``arrival`` 10, ``collision`` 10, ``time`` 0.1,
            ``closeness`` 0, ``turning`` 0.
        expose_truth: Give ``info["truth"]``, for evaluation.
        render_mode: None, ``"rgb_array"`` or ``"human"``.
    """

    map: MapSpec = "office"
    robots: int = 4
    places: str | None = None
    starts: Points | None = None
    goals: Points | str | None = None
    action: str = "continuous"
    robot: RobotSpec = ROBOT
    lidar: LidarSpec = LIDAR
    neighbours: int = 0
    guard: bool = False
    motion_noise: float = 1.0
    localization_noise: float = 0.02
    stall_rate: float = 0.0
    decision_period: float = 0.2
    goal_tolerance: float = 0.15
    collision_ends: bool = True
    max_episode_steps: int = 1000
    observation: ObservationSpec = "ranges"
    reward: RewardSpec = "default"
    expose_truth: bool = False
    render_mode: str | None = None

    @classmethod
    def checked(cls, keywords: Mapping[str, Any]) -> "CorridorOptions":
        """Check keywords and fill in the defaults.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type.
        """
        keywords = modern_keywords(keywords)
        options, given = options_of(cls, "a corridor environment", keywords, _LIMITS), plain(keywords)
        choose_reward(options.reward, REWARDS)
        choose_observer(options.observation, OBSERVATIONS, boxes_only=True)
        options._check_rest()
        robot = make_robot(given.get("robot"), ROBOT)
        check_range("robot.radius", robot.radius, 0.01, _LARGEST_RADIUS)
        lidar = make_lidar(given.get("lidar"), LIDAR, options.decision_period)
        check_range("lidar.max_range", lidar.max_range, *_LIDAR_RANGES)
        if options.guard and not lidar.sees_all_around:
            raise ConfigError(
                f"guard=True needs a lidar that sees all around, but lidar.field_of_view = {lidar.field_of_view:g} rad"
            )
        return replace(options, robot=robot, lidar=lidar)

    @property
    def lifelong(self) -> bool:
        """Whether robots get new goals when they reach theirs."""
        return isinstance(self.goals, str)

    def _check_rest(self) -> None:
        if not isinstance(self.map, str | Floorplan) and not callable(self.map):
            raise ConfigError(f"map = {self.map!r} must be a floor plan's name, file or generator")
        if self.places is not None and (
            not isinstance(self.places, str) or not (self.places in _PLACES or self.places.endswith(".scen"))
        ):
            allowed = suggest(str(self.places), [*_PLACES, "a path to a .scen file"])
            raise ConfigError(f"places = {self.places!r} is not known{allowed}")
        if isinstance(self.goals, str) and self.goals != LIFELONG:
            raise ConfigError(f"goals = {self.goals!r} is not known{suggest(self.goals, [LIFELONG])}")
        given = self.goals is not None and not self.lifelong
        if (self.starts is not None) != given or (self.starts is not None and self.places is not None):
            raise ConfigError("starts and goals are given together, and in place of places")


_PLACES = ("predefined", "random")


def modern_keywords(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return keywords in which those of version 0.1 have their names of today.

    Raises:
        ConfigError: Some are given under both.
    """
    return reward_of_weights(nest_earlier("a corridor environment", keywords, _EARLIER), _WEIGHTS, "default")
