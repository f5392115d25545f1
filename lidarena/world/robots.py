"""Robots: what they are like, some by name, and the check of those that users describe."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import check_range, check_switch
from lidarena.world.lidar import NO_OUTLINE
from lidarena.world.outlines import checked_outline, convex_parts, edge_distances, extents
from lidarena.world.spec_reading import read_spec

Outline = tuple[tuple[float, float], ...]

BUMPER = 0.015
"""Room beside the robot within which a surface counts as touched by its bumper [m]: DA-SLAM's 0.12 m less 0.105 m."""
ROBOTS: dict[str, dict[str, Any]] = {
    "turtlebot3_burger": {"radius": 0.105, "max_speed": 0.5},
    "turtlebot3_waffle": {"radius": 0.22, "mass": 1.8, "max_speed": 0.26, "max_turn_rate": 1.82},
    "jackal": {
        "outline": ((0.254, 0.215), (-0.254, 0.215), (-0.254, -0.215), (0.254, -0.215)),
        "mass": 17.0, "max_speed": 2.0, "max_turn_rate": 4.0,
    },
}  # fmt: skip
"""Robots by name: the TurtleBot3 Burger of DA-SLAM's simulation, which drives at 0.5 m/s (a real one 0.22 m/s, 2.84
rad/s); the TurtleBot3 Waffle as the disc that Nav2 plans for; Clearpath's Jackal as its rectangle of 0.508 m × 0.43 m.

What a preset does not name, such as the Burger's turn rate, stays that of the family of environments."""

_RANGES = {
    "radius": (0.01, 10.0), "mass": (1e-3, 1e4), "max_speed": (1e-3, 100.0), "max_turn_rate": (1e-3, 100.0),
    "substep": (1e-4, 1.0),
}  # fmt: skip


@dataclass(frozen=True)
class RobotSpec:
    """A robot with a differential drive; the defaults are the TurtleBot3 Burger's.

    A robot with an outline collides with that polygon. Whatever else needs a size takes ``radius``, of the circle about
    the centre that holds the outline: planners, coverage and starts, which leave it room to turn wherever it is.

    Attributes:
        radius: Of the disc, or of the circle that holds the outline [m].
        mass: [kg].
        max_speed: Fastest forward speed that a command may ask for [m/s]; Yang et al. drives at 0.5.
        max_turn_rate: Fastest turn that a command may ask for [rad/s].
        substep: Longest time step of the physics while the robot is near something [s].
        reverse: Whether it drives backwards.
        collision_distance: Range of a beam, from the centre, below which the robot has collided [m]; with an outline
            what this exceeds ``radius`` by is the width of a rim around the outline. None: where the family says.
        outline: Corners x, y of its footprint, with the centre inside [m]; () for a disc.
        clearance: How far its centre keeps from every wall where it drives [m]. What can be reached by narrower ways
            alone counts as out of reach, for completeness and for the classical explorers alike; None: completeness
            counts what fits ``bumper``, and each driver keeps what it is made for.
    """

    radius: float = 0.105
    mass: float = 1.0
    max_speed: float = 0.5
    max_turn_rate: float = 1.0
    substep: float = 0.04
    reverse: bool = False
    collision_distance: float | None = None
    outline: Outline = ()
    clearance: float | None = None

    @property
    def contact_distance(self) -> float:
        """Range of a beam at which its bumper touches something [m], whatever ``collision_distance`` is."""
        return self.radius + BUMPER

    @property
    def bumper(self) -> float:
        """Range of a beam below which a robot with a bumper has collided [m]."""
        return self.contact_distance if self.collision_distance is None else self.collision_distance

    @cached_property
    def corners(self) -> NDArray[np.float64]:
        """The outline (n, 2), counter-clockwise [m]; (0, 2) for a disc."""
        return np.array(self.outline, np.float64).reshape(-1, 2) if self.outline else NO_OUTLINE

    @cached_property
    def inner_radius(self) -> float:
        """Radius of the circle about the centre that the robot holds [m]."""
        return self.radius if not self.outline else float(edge_distances(self.corners).min())

    @cached_property
    def parts(self) -> list[list[tuple[float, float]]]:
        """Convex polygons that make up the outline [m]."""
        return convex_parts(self.corners)

    def bumpers(self, angles: NDArray[np.float64]) -> NDArray[np.float64]:
        """Ranges in directions (n,) [rad] below which a robot with a bumper has collided, (n,) [m]."""
        rim = self.bumper - self.radius
        return np.full(len(angles), self.bumper) if not self.outline else rim + extents(self.corners, angles)


def make_robot(value: Any, default: RobotSpec) -> RobotSpec:
    """Make what the keyword ``robot`` says.

    Args:
        value: See :func:`lidarena.world.spec_reading.read_spec`; a ``radius`` makes a disc, an ``outline`` a polygon.
        default: What changes are made to.

    Raises:
        ConfigError: A value that cannot be.
    """
    names = [field.name for field in fields(RobotSpec)]
    found = read_spec("robot", value, RobotSpec, names, ROBOTS, either=("radius", "outline"))
    spec = _checked(found if isinstance(found, RobotSpec) else replace(default, **found))
    finest = 0.35 * spec.inner_radius / spec.max_speed  # no body passes through a wall between two steps
    return replace(spec, substep=min(spec.substep, finest))


def gives_size(value: Any) -> bool:
    """Whether what the keyword ``robot`` says, see ``make_robot``, tells how large the robot is."""
    names = [field.name for field in fields(RobotSpec)]
    found = read_spec("robot", value, RobotSpec, names, ROBOTS, either=("radius", "outline"))
    return isinstance(found, RobotSpec) or "radius" in found or "outline" in found


def _checked(spec: RobotSpec) -> RobotSpec:
    """A robot with its numbers checked, its outline counter-clockwise and its radius that of the outline."""
    if not isinstance(spec.outline, Sequence | np.ndarray):
        raise ConfigError(f"robot.outline = {spec.outline!r} must be the corners [[x, y], …] of a polygon")
    if len(spec.outline):
        corners = checked_outline(spec.outline)
        outline = tuple((float(x), float(y)) for x, y in corners)
        spec = replace(spec, outline=outline, radius=float(np.hypot(*corners.T).max()))
    for name, (low, high) in _RANGES.items():
        check_range(f"robot.{name}", getattr(spec, name), low, high)
    check_switch("robot.reverse", spec.reverse)
    numbers: dict[str, Any] = {name: float(getattr(spec, name)) for name in _RANGES}
    if spec.collision_distance is not None:
        least = round(spec.radius + 0.001, 9)  # touching bodies overlap by some tenths of a millimetre
        check_range("robot.collision_distance", spec.collision_distance, least, spec.radius + 1.0)
        numbers["collision_distance"] = float(spec.collision_distance)
    if spec.clearance is not None:
        check_range("robot.clearance", spec.clearance, round(spec.bumper, 9), 10.0)
        numbers["clearance"] = float(spec.clearance)
    return replace(spec, outline=tuple(spec.outline), **numbers)
