"""A scene of circles for the potential field: checked, and grown by the robot's radius and by a clearance."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import MapError
from lidarena.planning.potential_field.field_kernels import Obstacles

_ROOM = 100.0
"""Side of Yang et al.'s room (m)."""
_RADII = 10.0
"""The scale is at most so many radii of the robot over 1 m (1/m): 1 in Yang et al.'s room for a robot of 0.1 m."""
_SHARE = 0.999
"""A start or goal nearer to an obstacle than the wanted clearance keeps this share of the clearance it has."""


@dataclass(frozen=True)
class FieldScene:
    """What a plan is made for; the robot is a point, since the obstacles have grown by its radius.

    Attributes:
        discs: (K, 3) x, y, radius plus the robot's (m).
        walls: (4,) x_min, y_min, x_max, y_max drawn in by the robot's radius (m); ±inf without a room.
        start: (2,) x, y (m).
        goal: (2,) x, y (m).
        radius: Of the robot, by which discs and walls have grown (m).
    """

    discs: NDArray[np.float64]
    walls: NDArray[np.float64]
    start: NDArray[np.float64]
    goal: NDArray[np.float64]
    radius: float = 0.0

    @cached_property
    def goal_gap(self) -> float:
        """Distance from the goal to the nearest surface (m)."""
        return float(self._gaps(self.goal).min())

    def _gaps(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """Distances (K + 4,) of a point to the discs, then to the walls."""
        away = np.hypot(self.discs[:, 0] - point[0], self.discs[:, 1] - point[1]) - self.discs[:, 2]
        return np.concatenate([away, point - self.walls[:2], self.walls[2:] - point])

    def keeping(self, clearance: float) -> Obstacles:
        """Return discs (K, 3) and walls (4,) grown by a clearance, each by less if start or goal is nearer to it.

        Args:
            clearance: What is wanted (m).
        """
        gaps = np.minimum(self._gaps(self.start), self._gaps(self.goal))
        kept = np.minimum(clearance, _SHARE * gaps)
        discs = self.discs.copy()
        discs[:, 2] += kept[:-4]
        return Obstacles(discs, self.walls + kept[-4:] * np.array([1.0, 1.0, -1.0, -1.0]))

    @property
    def obstacles(self) -> Obstacles:
        """The discs and walls as kernels take them."""
        return Obstacles(self.discs, self.walls)

    def narrowed(self, obstacles: Obstacles) -> "FieldScene":
        """Return the same scene with the obstacles of :meth:`keeping` in place of its own."""
        return FieldScene(*obstacles, self.start, self.goal, self.radius)

    @property
    def scale(self) -> float:
        """What lengths that were printed for Yang et al.'s room of 100 m are multiplied by in this scene.

        The longer side over 100 m of the room, or else of what lies about start and goal, no farther away than they are
        from each other. No more than 10 radii of the robot over 1 m, so that a small robot in a large hall does not
        keep away from obstacles as if it were large.
        """
        low, high = self.walls[:2], self.walls[2:]
        if np.isfinite(self.walls).all():
            low, high = low - self.radius, high + self.radius
        else:
            centres, ends = self.discs[:, :2], (self.start, self.goal)
            away = np.minimum(*(np.hypot(*(centres - end).T) for end in ends))
            points = np.vstack([centres[away <= math.dist(*ends)], *ends])
            low, high = points.min(axis=0), points.max(axis=0)
        side = float((high - low).max())
        scale = side / _ROOM if side > 0 else 1.0
        return min(scale, _RADII * self.radius) if self.radius > 0.0 else scale


def make_scene(
    circles: ArrayLike,
    start: ArrayLike,
    goal: ArrayLike,
    robot_radius: float = 0.0,
    bounds: ArrayLike | None = None,
) -> FieldScene:
    """Check a scene and grow its obstacles by the robot's radius.

    Args:
        circles: (K, 3) x, y, radius (m); K = 0 is allowed.
        start: x, y (m).
        goal: x, y (m).
        robot_radius: Radius of the robot (m).
        bounds: x_min, y_min, x_max, y_max of the room (m); None: there are no walls.

    Raises:
        MapError: A number is not finite or negative, a shape is wrong, or the start or the goal is in an obstacle or
            behind a wall.
    """
    discs = _circles(circles)
    radius = _number("robot_radius", robot_radius)
    if not (math.isfinite(radius) and radius >= 0.0):
        raise MapError(f"robot_radius = {robot_radius!r}; a finite number of metres from 0 on is needed")
    discs[:, 2] += radius
    scene = FieldScene(discs, _walls(bounds, radius), _point("start", start), _point("goal", goal), radius)
    for name, point in (("start", scene.start), ("goal", scene.goal)):
        _refuse_inside(name, point, scene, radius)
    return scene


def _number(name: str, value: object) -> float:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise MapError(f"{name} = {value!r}; a number is needed") from None


def _array(name: str, values: ArrayLike, wanted: str) -> NDArray[np.float64]:
    try:
        return np.array(values, dtype=np.float64, order="C")  # kernels would be compiled again for another order
    except (TypeError, ValueError):
        raise MapError(f"{name} {values!r} are not numbers; {wanted}") from None


def _circles(circles: ArrayLike) -> NDArray[np.float64]:
    wanted = "(K, 3) rows of x, y, radius in metres are needed"
    discs = _array("circles", circles, wanted)
    if discs.size == 0:
        return np.empty((0, 3))
    if discs.ndim != 2 or discs.shape[1] != 3:
        raise MapError(f"circles have shape {discs.shape}; {wanted}")
    bad = np.flatnonzero(~np.isfinite(discs).all(axis=1) | (discs[:, 2] < 0.0))
    if len(bad):
        raise MapError(f"circle {bad[0]} is {discs[bad[0]].tolist()}; finite x, y and a radius from 0 on are needed")
    return discs


def _point(name: str, value: ArrayLike) -> NDArray[np.float64]:
    wanted = "finite x, y in metres are needed"
    point = _array(name, value, wanted)
    if point.shape != (2,) or not np.isfinite(point).all():
        raise MapError(f"{name} is {point.tolist()}; {wanted}")
    return point


def _walls(bounds: ArrayLike | None, radius: float) -> NDArray[np.float64]:
    if bounds is None:
        return np.array([-np.inf, -np.inf, np.inf, np.inf])
    wanted = "x_min < x_max and y_min < y_max in metres are needed"
    walls = _array("bounds", bounds, wanted)
    if walls.shape != (4,) or not np.isfinite(walls).all() or not (walls[:2] < walls[2:]).all():
        raise MapError(f"bounds are {walls.tolist()}; {wanted}")
    return walls + radius * np.array([1.0, 1.0, -1.0, -1.0])


def _refuse_inside(name: str, point: NDArray[np.float64], scene: FieldScene, radius: float) -> None:
    gaps = scene._gaps(point)
    worst = int(np.argmin(gaps))
    if gaps[worst] > 0.0 or (gaps[worst] == 0.0 and worst >= len(scene.discs)):
        return  # a robot may stand at a wall: Yang et al.'s starts in the corner of its room
    where = "a wall of the room"
    if worst < len(scene.discs):
        x, y, reach = scene.discs[worst]
        where = f"the obstacle at ({x:g}, {y:g}) of radius {reach - radius:g} m"
    lies = f"lies {-gaps[worst]:.3g} m inside" if gaps[worst] < 0.0 else "touches"
    raise MapError(
        f"the {name} ({point[0]:g}, {point[1]:g}) {lies} {where} "
        f"(robot radius {radius:g} m); it must be outside of every obstacle"
    )
