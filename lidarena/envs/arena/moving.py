"""Obstacles that move: discs that drive straight, cross the robot's way, go from point to point, or walk like people.

They turn back from walls and obstacles and pass through each other, except that people keep clear of each other and of
the robot. Everything is drawn by the episode's own generator, so that an episode can be repeated.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.jit import inlined, leaf
from lidarena.base.keyword_checks import check_choice, check_names, check_range
from lidarena.base.random_streams import uniform
from lidarena.envs.arena.kernels import way_gap
from lidarena.world.lidar import LidarSpec
from lidarena.world.map_geometry import MapGeometry

KINDS = ("straight", "crossing", "waypoints", "people", "mixed")
_MOST = 200
_TRIES = 60  # draws for a free place or direction
_COMFORT = 0.6  # people: range of the push between two, as a share of the sum of their radii
_PUSH = 1.5  # people: push at contact, as a share of their speed


@dataclass(frozen=True)
class MovingSpec:
    """The keyword ``moving`` of an arena.

    Attributes:
        number: Of obstacles; or (least, greatest), of which every episode draws one.
        speed: One for all, or (least, greatest) to draw from [m/s].
        radius: Of each; None: 0.3 m in a 10 m room, and to scale [m].
        kind: ``"straight"`` drives on until something is in the way, and turns back; ``"crossing"`` goes to and fro
            across the way from start to goal; ``"waypoints"`` goes straight to random points, one after the other;
            ``"people"`` does so too, but makes room for others and for the robot; ``"mixed"`` draws a kind for each.
    """

    number: int | tuple[int, int] = 0
    speed: float | tuple[float, float] = 0.5
    radius: float | None = None
    kind: str = "straight"

    @classmethod
    def checked(cls, value: Any) -> "MovingSpec":
        """Check what was given: None, a number of obstacles, a mapping, or a spec.

        Raises:
            ConfigError: A key that is unknown, or a value out of range.
        """
        if value is None:
            return cls()
        if isinstance(value, int) and not isinstance(value, bool):
            value = {"number": value}
        if isinstance(value, cls):
            value = {field.name: getattr(value, field.name) for field in fields(cls)}
        if not isinstance(value, Mapping):
            raise ConfigError(f"moving = {value!r} must be a number of obstacles, or a mapping of number, speed, kind")
        check_names("moving obstacles", value, [field.name for field in fields(cls)])
        given = dict(value)
        given["number"] = _one_or_two("moving.number", given.get("number", cls.number), 0, _MOST, whole=True)
        given["speed"] = _one_or_two("moving.speed", given.get("speed", cls.speed), 0.0, 100.0)
        if given.get("radius") is not None:
            check_range("moving.radius", given["radius"], 0.01, 100.0)
        check_choice("moving.kind", given.get("kind", "straight"), KINDS)
        return cls(**given)

    @property
    def numbers(self) -> tuple[int, int]:
        """The least and the greatest number."""
        return self.number if isinstance(self.number, tuple) else (self.number, self.number)

    @property
    def speeds(self) -> tuple[float, float]:
        """The least and the greatest speed [m/s]."""
        return self.speed if isinstance(self.speed, tuple) else (float(self.speed), float(self.speed))

    def check_seen(self, lidar: LidarSpec, period: float, robot_speed: float) -> None:
        """Refuse obstacles that come from out of sight to the robot between two scans.

        Args:
            lidar: Of the robot.
            period: Between two decisions [s].
            robot_speed: [m/s].

        Raises:
            ConfigError: They are too fast for it.
        """
        between = max(1.0 / lidar.rate, period)
        most = lidar.max_range / between - robot_speed
        if self.numbers[1] and self.speeds[1] > most:
            raise ConfigError(
                f"moving.speed = {self.speed!r} m/s is more than this lidar can see coming: with a scan every "
                f"{between:g} s, a range of {lidar.max_range:g} m and a robot at {robot_speed:g} m/s at most "
                f"{max(most, 0.0):.3g} m/s is allowed"
            )


def _one_or_two(name: str, value: Any, low: float, high: float, whole: bool = False) -> Any:
    """Check a number, or the least and the greatest; returns it, or the two as a tuple.

    Raises:
        ConfigError: It is neither, or out of range.
    """
    if not isinstance(value, Sequence | np.ndarray):
        check_range(name, value, low, high, whole=whole)
        return value
    if isinstance(value, str | bytes) or len(value) != 2:
        raise ConfigError(f"{name} = {value!r} must be a number, or the least and the greatest")
    for one in value:
        check_range(name, one, low, high, whole=whole)
    if value[0] > value[1]:
        raise ConfigError(f"{name} = {value!r} must be the least and the greatest, in this order")
    kind = int if whole else float
    return kind(value[0]), kind(value[1])


class MovingObstacles(NamedTuple):
    """The moving obstacles of ``W`` worlds, at most ``M`` each.

    Attributes:
        states: (W, M, 4) x, y [m], velocity [m/s].
        targets: (W, M, 2) way points [m].
        speeds: (W, M) [m/s].
        kinds: (W, M) int64 index in ``KINDS``.
        streams: (W, 4) random streams.
        radius: () of all [m].
        counts: (W,) how many there are; the rest of a row means nothing.
    """

    states: NDArray[np.float64]
    targets: NDArray[np.float64]
    speeds: NDArray[np.float64]
    kinds: NDArray[np.int64]
    streams: NDArray[np.uint64]
    radius: NDArray[np.float64]
    counts: NDArray[np.int64]

    @property
    def number(self) -> int:
        """The most obstacles in a world."""
        return int(self.states.shape[1])

    def discs(self, world: int) -> NDArray[np.float64]:
        """x, y, velocity [m/s] and radius of one world's (n, 5)."""
        count = int(self.counts[world])
        radii = np.full((count, 1), float(self.radius[0]))
        return np.concatenate([self.states[world, :count], radii], axis=1)


def moving_obstacles(worlds: int, spec: MovingSpec, scale: float) -> MovingObstacles:
    """Room for the obstacles of a batch of worlds in rooms of 100 m times ``scale``."""
    radius = 3.0 * scale if spec.radius is None else spec.radius
    shape = (worlds, spec.numbers[1])
    return MovingObstacles(
        np.zeros((*shape, 4)),
        np.zeros((*shape, 2)),
        np.zeros(shape),
        np.zeros(shape, np.int64),
        np.zeros((worlds, 4), np.uint64),
        np.array([radius]),
        np.full(worlds, spec.numbers[0]),
    )


@inlined
def _between(stream: NDArray[np.uint64], low: float, high: float) -> float:
    return low + uniform(stream) * (high - low)


@leaf
def _aim(obstacle: int, world: int, speed: float, moving: MovingObstacles) -> None:
    """Turn an obstacle towards its way point."""
    state, target = moving.states[world, obstacle], moving.targets[world, obstacle]
    dx, dy = target[0] - state[0], target[1] - state[1]
    away = max(math.sqrt(dx * dx + dy * dy), 1e-12)
    state[2], state[3] = speed * dx / away, speed * dy / away


@leaf
def _draw_target(
    obstacle: int, world: int, bounds: NDArray[np.float64], geometry: MapGeometry, moving: MovingObstacles
) -> None:
    """Draw a way point that an obstacle can go to in a straight line; without one it stays where it is."""
    state, radius = moving.states[world, obstacle], moving.radius[0]
    target, stream = moving.targets[world, obstacle], moving.streams[world]
    for _ in range(_TRIES):
        target[0], target[1] = _between(stream, bounds[0], bounds[2]), _between(stream, bounds[1], bounds[3])
        if way_gap(state[0], state[1], target[0], target[1], world, geometry) > radius:
            return
    target[0], target[1] = state[0], state[1]


@leaf
def place_moving(
    world: int,
    start: NDArray[np.float64],
    goal: NDArray[np.float64],
    keep: float,
    low: float,
    high: float,
    bounds: NDArray[np.float64],
    geometry: MapGeometry,
    moving: MovingObstacles,
) -> None:
    """Draw where the obstacles of a world are and how they move.

    Args:
        world: Its number; ``kinds`` and ``streams`` are set.
        start: (2,) of the robot [m].
        goal: (2,) [m].
        keep: Nothing begins nearer than this to the start [m].
        low: Least speed [m/s].
        high: Greatest speed [m/s].
        bounds: (4,) of the room [m].
        geometry: What stands in it.
        moving: Output.
    """
    stream, radius = moving.streams[world], moving.radius[0]
    for k in range(moving.counts[world]):
        state, kind = moving.states[world, k], moving.kinds[world, k]
        speed = _between(stream, low, high)
        moving.speeds[world, k] = speed
        x, y = goal[0], goal[1]
        for _ in range(_TRIES):
            if kind == 1:  # beside the way to the goal
                along = _between(stream, 0.15, 0.85)
                aside = _between(stream, -0.25, 0.25)
                x = start[0] + along * (goal[0] - start[0]) - aside * (goal[1] - start[1])
                y = start[1] + along * (goal[1] - start[1]) + aside * (goal[0] - start[0])
            else:
                x, y = _between(stream, bounds[0], bounds[2]), _between(stream, bounds[1], bounds[3])
            inside = bounds[0] < x - radius and x + radius < bounds[2] and bounds[1] < y - radius
            away = math.sqrt((x - start[0]) ** 2 + (y - start[1]) ** 2)
            free = inside and y + radius < bounds[3] and way_gap(x, y, x, y, world, geometry) > radius
            if free and away > keep:
                break
        state[0], state[1] = x, y
        if kind >= 2:
            _draw_target(k, world, bounds, geometry, moving)
            _aim(k, world, speed, moving)
            continue
        angle = _between(stream, -math.pi, math.pi)
        if kind == 1:
            angle = math.atan2(goal[0] - start[0], start[1] - goal[1])  # across the way
            angle += math.pi if uniform(stream) < 0.5 else 0.0
        state[2], state[3] = speed * math.cos(angle), speed * math.sin(angle)


@leaf
def _walk(obstacle: int, world: int, robot: NDArray[np.float64], robot_radius: float, moving: MovingObstacles) -> None:
    """Let a person go towards its way point and make room for others and for the robot (social forces)."""
    states, radius = moving.states[world], moving.radius[0]
    speed = moving.speeds[world, obstacle]
    _aim(obstacle, world, speed, moving)
    vx, vy = states[obstacle, 2], states[obstacle, 3]
    count = moving.counts[world]
    for other in range(count + 1):
        if other == obstacle:
            continue
        at_robot = other == count
        x, y = (robot[0], robot[1]) if at_robot else (states[other, 0], states[other, 1])
        reach = radius + (robot_radius if at_robot else radius)
        dx, dy = states[obstacle, 0] - x, states[obstacle, 1] - y
        away = max(math.sqrt(dx * dx + dy * dy), 1e-9)
        push = _PUSH * speed * math.exp(-max(away - reach, 0.0) / (_COMFORT * reach))
        vx, vy = vx + push * dx / away, vy + push * dy / away
    size = math.sqrt(vx * vx + vy * vy)
    share = min(1.0, speed / max(size, 1e-12))
    states[obstacle, 2], states[obstacle, 3] = vx * share, vy * share


@leaf
def choose_velocities(  # noqa: C901 - one kind after the other
    period: float,
    poses: NDArray[np.float64],
    radii: NDArray[np.float64],
    bounds: NDArray[np.float64],
    geometry: MapGeometry,
    moving: MovingObstacles,
) -> None:
    """Choose the velocities for the next period, such that no obstacle drives into what stands.

    Args:
        period: [s].
        poses: (W, 1, 3) of the robots.
        radii: (W,) of the robots [m].
        bounds: (W, 4) of the rooms [m].
        geometry: What stands in them.
        moving: The obstacles; ``states`` get the velocities.
    """
    radius = moving.radius[0]
    for world in range(moving.states.shape[0]):
        for k in range(moving.counts[world]):
            state, kind, speed = moving.states[world, k], moving.kinds[world, k], moving.speeds[world, k]
            if kind >= 2:
                target = moving.targets[world, k]
                dx, dy = target[0] - state[0], target[1] - state[1]
                if dx * dx + dy * dy < max((speed * period) ** 2, 1e-12):
                    _draw_target(k, world, bounds[world], geometry, moving)
                if kind == 3:
                    _walk(k, world, poses[world, 0], radii[world], moving)
                else:
                    _aim(k, world, speed, moving)
            if _is_free(state, period, radius, world, bounds[world], geometry):
                continue
            if kind == 1:
                state[2], state[3] = -state[2], -state[3]
            else:
                for _ in range(_TRIES):
                    angle = _between(moving.streams[world], -math.pi, math.pi)
                    state[2], state[3] = speed * math.cos(angle), speed * math.sin(angle)
                    if _is_free(state, period, radius, world, bounds[world], geometry):
                        break
                if kind >= 2:
                    _draw_target(k, world, bounds[world], geometry, moving)
            if not _is_free(state, period, radius, world, bounds[world], geometry):
                state[2], state[3] = 0.0, 0.0


@leaf
def _is_free(
    state: NDArray[np.float64],
    period: float,
    radius: float,
    world: int,
    bounds: NDArray[np.float64],
    geometry: MapGeometry,
) -> bool:
    """Whether an obstacle touches nothing that stands in the next period."""
    x, y = state[0] + period * state[2], state[1] + period * state[3]
    if x - radius < bounds[0] or x + radius > bounds[2] or y - radius < bounds[1] or y + radius > bounds[3]:
        return False
    return way_gap(state[0], state[1], x, y, world, geometry) > radius


@leaf
def meet_moving(
    period: float,
    step: float,
    margin: float,
    poses: NDArray[np.float64],
    radii: NDArray[np.float64],
    moving: MovingObstacles,
    gaps: NDArray[np.float64],
    near: NDArray[np.bool_],
) -> None:
    """Lower ``gaps`` (W,) to the least distance between robot and moving obstacles in the next period.

    Args:
        period: [s].
        step: That the robots drive meanwhile, straight on [m].
        margin: Below it ``near`` (W,) becomes True [m].
        poses: (W, 1, 3) at its beginning.
        radii: (W,) of the robots [m].
        moving: The obstacles, with their velocities.
        gaps: Changed [m].
        near: Changed.
    """
    for world in range(moving.states.shape[0]):
        for k in range(moving.counts[world]):
            state = moving.states[world, k]
            x, y = poses[world, 0, 0] - state[0], poses[world, 0, 1] - state[1]
            dx = step * math.cos(poses[world, 0, 2]) - period * state[2]
            dy = step * math.sin(poses[world, 0, 2]) - period * state[3]
            squared = dx * dx + dy * dy
            when = min(max(-(x * dx + y * dy) / squared, 0.0), 1.0) if squared > 0.0 else 0.0
            away = math.sqrt((x + when * dx) ** 2 + (y + when * dy) ** 2)
            gaps[world] = min(gaps[world], away - radii[world] - moving.radius[0])
        near[world] = near[world] or gaps[world] < margin


@leaf
def drive_moving(period: float, moving: MovingObstacles) -> None:
    """Move all obstacles for ``period`` seconds."""
    for world in range(moving.states.shape[0]):
        for k in range(moving.counts[world]):
            moving.states[world, k, 0] += period * moving.states[world, k, 2]
            moving.states[world, k, 1] += period * moving.states[world, k, 3]
