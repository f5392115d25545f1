"""Keywords of the arena environment, checked at the border."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from lidarena.base.earlier_keywords import nest_earlier
from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import Limits, check_range, options_of, plain
from lidarena.envs.arena.moving import MovingSpec
from lidarena.envs.arena.rewards import REWARDS
from lidarena.envs.common_keywords import CommonKeywords
from lidarena.envs.observers import ObservationSpec, choose_observer
from lidarena.envs.rewards import RewardSpec, choose_reward, reward_of_weights
from lidarena.world.arenas import Arena, ArenaGenerator
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import LidarSpec
from lidarena.world.lidars import check_lidar, gives_range, make_lidar
from lidarena.world.random_arenas import DENSITY
from lidarena.world.robots import RobotSpec, gives_size, make_robot

ArenaSpec = str | Arena | Floorplan | ArenaGenerator
OBSERVATIONS = ("ranges", "proximity", "way")
_WEIGHTS = {f"{term}_weight": term for term in REWARDS.names}
"""Keywords of version 0.1, and the terms that they weigh."""
_EARLIER = {
    "beams": ("lidar", "beams"),
    "max_range": ("lidar", "max_range"),
    "lidar_noise": ("lidar", "noise"),
    "speed": ("robot", "max_speed"),
}
_LIMITS = Limits(
    choices={
        "pick": ("random", "by_seed"),
        "action": ("continuous", "discrete"),
        "knowledge": ("map", "lidar"),
        "field": ("robust", "paper", "traditional"),
        "render_mode": (None, "rgb_array"),
    },
    ranges={"decision_period": (1e-3, 100.0), "goal_radius": (1e-3, 100.0)},
    whole={"arenas": (1, 10**9)},
    switches=("expose_truth", "guard", "solvable"),
)


class ToScale(LidarSpec):
    """A lidar whose longest range is for a 100 m room, and to scale in others."""


@dataclass(frozen=True)
class OwnSize(RobotSpec):
    """A robot as large as each arena's own."""


NOTHING_MOVES = MovingSpec()
"""No moving obstacles."""
ROBOT = OwnSize(max_speed=1.0, substep=0.03)
"""Drives at 1 m/s; its size is each arena's own."""
LIDAR = ToScale(beams=36, max_range=30.0, noise=0.0)
"""36 exact beams all around, of 30 m in a 100 m room, and to scale in others."""


class ArenaKeywords(CommonKeywords, total=False):
    """The keywords of ``ArenaOptions`` with their types, for editors and type checkers."""

    arena: ArenaSpec | Sequence[ArenaSpec]
    density: float | Sequence[float]
    path: str | None
    moving: MovingSpec | Mapping[str, Any] | int | None
    start: Sequence[float] | None
    goal: Sequence[float] | None
    arenas: int
    pick: str
    solvable: bool
    action: str
    robot: RobotSpec | Mapping[str, Any] | str | None
    lidar: LidarSpec | Mapping[str, Any] | str | None
    guard: bool
    knowledge: str
    decision_period: float | None
    goal_radius: float | None
    field: str


@dataclass(frozen=True)
class ArenaOptions:
    """Keywords of ``lidarena/Arena-v0``.

    Attributes:
        arena: What :func:`lidarena.world.arenas.load_arena` takes (``"yang"``, ``"yang:arc"``, ``"yang:u"``,
            ``"gnron"``, ``"u_trap:SEED"``, ``"random:SEED"``, ``"barn:INDEX"``, a floor plan); a family without its
            number, ``"random"``, ``"u_trap"`` or ``"barn"``, of which every episode draws another; a generator of one's
            own or its ``"module:callable"``, a function of a ``numpy.random.Generator`` that draws an ``Arena`` or a
            ``Floorplan`` for every episode; or a list of these.
        density: Share of the room that the circles of ``"random"`` arenas cover, or a list of shares to draw from.
        path: The BARN file, for ``"barn"`` and ``"barn:INDEX"``.
        moving: Obstacles that move: how many, or a mapping of ``number``, ``speed``, ``radius`` and ``kind``, see
            :class:`lidarena.envs.arena.moving.MovingSpec`. The lidar sees them; with ``knowledge="map"``
            ``info["moving"]`` tells where they are and how they move.
        start: x, y instead of the arena's own [m].
        goal: x, y instead of the arena's own [m]; a floor plan has none and needs it.
        arenas: How many different ``"random"`` arenas, U traps and arenas of a generator the episodes draw from. Their
            numbers begin at 2³¹, beyond those that ``pick="by_seed"`` meets, so that what is trained on is not what is
            evaluated on.
        pick: Which arena a reset takes: ``"random"`` draws it, ``"by_seed"`` takes number s of a family or list after
            ``reset(seed=s)`` (of two or more entries number s // n of entry s mod n), and draws where no seed is given.
        solvable: Pass over ``"random"`` arenas, and a generator's, in which A* finds no path.
        action: ``"continuous"`` or ``"discrete"`` headings.
        observation: ``"ranges"`` shows the beams over the longest range, ``"proximity"`` the robot's radius over them,
            which tells near obstacles apart: 1 is contact; ``"way"`` adds to that the way through what the lidar has
            seen since the episode began, and how long each heading stays free; or one's own, see
            ``lidarena.envs.observers``.
        robot: A preset of :data:`lidarena.world.robots.ROBOTS`, a mapping of changes (to a ``preset``) such as
            ``{"radius": 0.2, "max_speed": 0.3}``, a ``RobotSpec``, or ``"module:callable"`` that makes one. It drives
            at ``max_speed``, 1 m/s by default, and turns on the spot before each step, so turn rate and reverse gear do
            not matter; its size is the arena's own unless given, and with a ``collision_distance`` it has collided
            before contact, too. Of an environment that was made: the ``RobotSpec`` that it stands for, where arenas'
            own sizes differ of the largest; ``info["radius"]`` has each.
        lidar: The same with the presets of :data:`lidarena.world.lidars.LIDARS` and a ``LidarSpec``; by default 36
            exact beams all around, of 30 m in a 100 m room and to scale in others.
        guard: Whether the robot takes the nearest heading that stays free, in place of one that leads to contact within
            a step as far as its lidar has shown, see :func:`lidarena.envs.arena.guard.guard_turns`; it keeps a map.
        knowledge: ``"map"`` gives the obstacles in ``info``, ``"lidar"`` only what the lidar sees.
        decision_period: Time between decisions [s]; None: 1 s in a 100 m room, and to scale in others.
        goal_radius: The goal is reached from this distance on [m]; None: 1 m in a 100 m room, and to scale in others.
        max_episode_steps: Steps after which an episode is truncated; -1 never, None the usual 500.
        reward: ``"default"``, ``{term: weight}``, ``{"preset": "default", term: weight}`` to change some weights of it,
            a function of a ``Step``, or ``"module:function"``; see ``lidarena.envs.rewards``. Terms and their weights
            in ``"default"``: ``progress`` 1, ``success`` 10, ``collision`` 10, ``time`` 0.1, ``clearance`` 0, ``turn``
            0, ``way`` 0; a weight of ``way`` lets the robot keep a map.
        expose_truth: Give ``info["truth"]``, for evaluation.
        field: Whose potential the picture shows, see :data:`lidarena.planning.potential_field.potential_field.PRESETS`.
        render_mode: None or ``"rgb_array"``.
    """

    arena: ArenaSpec | Sequence[ArenaSpec] = "random"
    density: float | Sequence[float] = DENSITY
    path: str | None = None
    moving: MovingSpec = NOTHING_MOVES
    start: Sequence[float] | None = None
    goal: Sequence[float] | None = None
    arenas: int = 4096
    pick: str = "random"
    solvable: bool = False
    action: str = "continuous"
    observation: ObservationSpec = "ranges"
    robot: RobotSpec = ROBOT
    lidar: LidarSpec = LIDAR
    guard: bool = False
    knowledge: str = "map"
    decision_period: float | None = None
    goal_radius: float | None = None
    max_episode_steps: int = 500
    reward: RewardSpec = "default"
    expose_truth: bool = False
    field: str = "robust"
    render_mode: str | None = None

    @classmethod
    def checked(cls, keywords: Mapping[str, Any]) -> "ArenaOptions":
        """Check keywords and fill in the defaults.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type.
        """
        keywords = modern_keywords(keywords)
        options, given = options_of(cls, "an arena environment", keywords, _LIMITS), plain(keywords)
        choose_reward(options.reward, REWARDS)
        choose_observer(options.observation, OBSERVATIONS)
        options._check_arenas()
        moving = MovingSpec.checked(given.get("moving"))
        return replace(options, moving=moving, robot=_robot_of(given.get("robot")), lidar=_lidar_of(given.get("lidar")))

    def at_scale(self, scale: float, radius: float) -> "ArenaOptions":
        """The same for arenas of a scale, with the lidar, periods and distances that were left to it.

        Args:
            scale: See :attr:`lidarena.world.arenas.Arena.scale`.
            radius: Of the robot, where it is left to the arenas [m].

        Raises:
            ConfigError: The lidar scans more often than there are decisions, or sees no farther than its least range.
        """
        period, lidar, robot = self.decision_period or scale, LidarSpec(*self.lidar), self.robot
        if isinstance(self.lidar, ToScale):
            lidar = lidar._replace(max_range=lidar.max_range * scale)
        if isinstance(robot, OwnSize):
            robot = replace(_as(RobotSpec, robot), radius=radius)
        check_lidar(lidar, period)
        self.moving.check_seen(lidar, period, robot.max_speed)
        return replace(self, robot=robot, lidar=lidar, decision_period=period, goal_radius=self.goal_radius or scale)

    def _check_arenas(self) -> None:
        specs = self.specs
        if not specs or not all(isinstance(spec, str | Arena | Floorplan) or callable(spec) for spec in specs):
            raise ConfigError(f"arena = {self.arena!r} must be an arena or its name, a generator, or a list of them")
        if not self.densities:
            raise ConfigError(f"density = {self.density!r} must be a number or a list of numbers")
        for share in self.densities:
            check_range("density", share, 0.0, 0.3)
        if self.path is not None and not isinstance(self.path, str):
            raise ConfigError(f"path = {self.path!r} must be the name of the BARN file")
        for name in ("start", "goal"):
            _check_point(name, getattr(self, name))
        self._check_meant()

    def _check_meant(self) -> None:
        """Refuse what none of the arenas would look at."""
        texts = [spec for spec in self.specs if isinstance(spec, str)]
        if self.path is not None and not any(text.partition(":")[0] == "barn" for text in texts):
            raise ConfigError(f"path = {self.path!r} is for 'barn' arenas only, not for arena = {self.arena!r}")
        drawn = any(text.partition(":")[0] == "random" and "density=" not in text for text in texts)
        if self.density != DENSITY and not drawn:
            raise ConfigError(
                f"density = {self.density!r} is for 'random' arenas without one of their own only, "
                f"not for arena = {self.arena!r}"
            )

    @property
    def keeps_map(self) -> bool:
        """Whether the robot keeps a map of what it sees, and its way through it."""
        if self.guard or self.observation == "way":
            return True
        reward = choose_reward(self.reward, REWARDS)
        return reward.function is None and reward.weights.get("way", 0.0) != 0.0

    @property
    def specs(self) -> list[ArenaSpec]:
        """The arenas and families to draw from."""
        return [self.arena] if isinstance(self.arena, str) or not isinstance(self.arena, Sequence) else list(self.arena)

    @property
    def densities(self) -> list[float]:
        """The densities to draw from."""
        return list(self.density) if isinstance(self.density, Sequence) else [self.density]


def modern_keywords(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return keywords in which those of version 0.1 have their names of today.

    Raises:
        ConfigError: Some are given under both.
    """
    return reward_of_weights(nest_earlier("an arena environment", keywords, _EARLIER), _WEIGHTS, "default")


def _robot_of(value: Any) -> RobotSpec:
    """What the keyword says; an ``OwnSize`` where it says nothing of the size."""
    robot = make_robot(value, ROBOT)
    for name in ("max_turn_rate", "reverse"):
        if isinstance(value, Mapping) and name in value:
            raise ConfigError(
                f"robot.{name} = {value[name]!r} has no meaning in an arena, where the robot turns on the spot before "
                "it drives on; radius, outline, max_speed and collision_distance have"
            )
    return _as(RobotSpec if gives_size(value) else OwnSize, robot)


def _as(kind: type[RobotSpec], robot: RobotSpec) -> RobotSpec:
    return kind(**{field.name: getattr(robot, field.name) for field in fields(robot)})


def _lidar_of(value: Any) -> LidarSpec:
    """What the keyword says; one that is ``ToScale`` where it says nothing of the range."""
    lidar = make_lidar(value, LIDAR, 0.0)
    return (LidarSpec if gives_range(value) else ToScale)(*lidar)


def _check_point(name: str, value: Any) -> None:
    try:
        fits = value is None or np.asarray(value, np.float64).shape == (2,)
    except (TypeError, ValueError):
        fits = False
    if not fits:
        raise ConfigError(f"{name} = {value!r} must be two numbers, x, y in metres")
