"""The pymunk space of each world of a batch, with its walls, and the bodies of the robots in it."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.base.jit import inlined
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.robots import RobotSpec

_SLOP = 1e-3
"""Overlap that contacts tolerate [m]; pymunk's default of 0.1 is meant for pixels."""


class Spaces(ABC):
    """The pymunk spaces of a batch of worlds, and where their robots are.

    Args:
        worlds: Number of worlds.
        robots: Number of robots in each.
        spec: The robots' body.

    Attributes:
        spec: The robots' body.
        poses: ``(worlds, robots, 3)`` true poses, x, y, theta [m, m, rad].
    """

    def __init__(self, worlds: int, robots: int = 1, spec: RobotSpec | None = None) -> None:
        self.spec = spec or RobotSpec()
        self.poses = np.zeros((worlds, robots, 3))
        self._plans: list[Floorplan | None] = [None] * worlds
        self._specs = [self.spec] * worlds
        self._spaces: list[pymunk.Space | None] = [None] * worlds

    def furnish(self, world: int, plan: Floorplan) -> None:
        """Give a world its walls and pillars; pymunk gets them when a robot first comes near something."""
        if self._plans[world] is not plan:
            self._plans[world], self._spaces[world] = plan, None

    def place(self, world: int, plan: Floorplan, poses: Sequence[Pose], spec: RobotSpec | None = None) -> None:
        """Put one world's robots at rest at the given poses in a floor plan.

        Args:
            world: Which one.
            plan: See ``furnish``.
            poses: One a robot.
            spec: The body of this world's robots, if it is not the batch's.
        """
        self.furnish(world, plan)
        self._specs[world] = spec or self.spec
        self.poses[world] = poses

    @abstractmethod
    def _listen(self, world: int, space: pymunk.Space) -> None:
        """Ask a new space to tell of collisions."""

    def _space(self, world: int) -> pymunk.Space:
        """One world's space, built when it is first needed."""
        space = self._spaces[world]
        if space is None:
            plan = self._plans[world]
            assert plan is not None, "furnish() or place() comes first"
            space = self._spaces[world] = build_space(plan)
            self._listen(world, space)
        return space


@inlined
def chord(heading: float, speed: float, rate: float, dt: float) -> tuple[float, float]:
    """Velocity along the chord of the arc that a robot describes from ``heading`` in ``dt``."""
    half = 0.5 * rate * dt
    along = speed * (math.sin(half) / half if half != 0.0 else 1.0)
    return along * math.cos(heading + half), along * math.sin(heading + half)


@inlined
def glide_one(command: NDArray[np.float64], duration: float, pose: NDArray[np.float64]) -> None:
    """Move a robot's pose (3,) along the chord of the arc that a command (2,) describes, as ``turn_wheels`` would."""
    vx, vy = chord(pose[2], command[0], command[1], duration)
    theta = pose[2] + command[1] * duration
    theta -= 2.0 * math.pi * math.floor(theta / (2.0 * math.pi) + 0.5)
    pose[0] += vx * duration
    pose[1] += vy * duration
    pose[2] = theta


def turn_wheels(speed: float, rate: float, body: pymunk.Body, gravity: object, damping: float, dt: float) -> None:
    """Velocity callback of pymunk: what the wheels do, before contacts have their say."""
    body.velocity = chord(body.angle, speed, rate, dt)
    body.angular_velocity = rate


def add_robot(space: pymunk.Space, spec: RobotSpec) -> pymunk.Body:
    """Put a new body in a space: a disc, or the robot's outline."""
    if spec.outline:
        body = pymunk.Body(spec.mass, pymunk.moment_for_poly(spec.mass, list(spec.outline)))
        shapes: list[pymunk.Shape] = [pymunk.Poly(body, part) for part in spec.parts]
    else:
        body = pymunk.Body(spec.mass, pymunk.moment_for_circle(spec.mass, 0.0, spec.radius))
        shapes = [pymunk.Circle(body, spec.radius)]
    for shape in shapes:
        shape.friction = 0.0  # the wheels, not the shell, decide how the robot turns
    space.add(body, *shapes)
    return body


def add_mover(space: pymunk.Space, x: float, y: float, vx: float, vy: float, radius: float) -> pymunk.Body:
    """Put a disc in a space that moves on at its velocity, whatever it meets; as a robot, from the second step on."""

    def keep_on(body: pymunk.Body, gravity: object, damping: float, dt: float) -> None:
        body.velocity = vx, vy

    body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    body.position, body.velocity_func = (x, y), keep_on
    shape = pymunk.Circle(body, radius)
    shape.friction = 0.0
    space.add(body, shape)
    return body


def build_space(plan: Floorplan) -> pymunk.Space:
    """A space with the walls and pillars of a floor plan."""
    space = pymunk.Space()
    space.collision_slop = _SLOP
    walls: list[pymunk.Shape] = [
        pymunk.Segment(space.static_body, (x1, y1), (x2, y2), 0.0) for x1, y1, x2, y2 in plan.edges.tolist()
    ]
    walls += [pymunk.Circle(space.static_body, radius, (x, y)) for x, y, radius in plan.circles.tolist()]
    space.add(*walls)
    return space
