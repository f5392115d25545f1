"""Rigid-body motion: one pymunk space a world, disc robots with a differential drive among static walls."""

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.world.floorplan import Floorplan, Pose

_SLOP = 1e-3
"""Overlap that contacts tolerate [m]; pymunk's default of 0.1 is meant for pixels."""
_MARGIN = 0.02
"""Added to what a robot may travel when asking whether it can touch anything [m]."""


class RobotSpec(NamedTuple):
    """A disc robot; the defaults are the TurtleBot3 Burger's.

    Attributes:
        radius: Of the disc [m].
        mass: [kg].
        max_speed: Fastest forward speed that a command may ask for [m/s]; the paper drives at 0.5.
        max_turn_rate: Fastest turn that a command may ask for [rad/s].
        substep: Longest time step of the physics while the robot is near something [s].
    """

    radius: float = 0.105
    mass: float = 1.0
    max_speed: float = 0.5
    max_turn_rate: float = 1.0
    substep: float = 0.04


class Physics:
    """The pymunk spaces of a batch of worlds.

    Args:
        worlds: Number of worlds.
        robots: Number of robots in each.
        spec: The robots' body.

    Attributes:
        poses: ``(worlds, robots, 3)`` true poses, x, y, theta [m, m, rad].
    """

    def __init__(self, worlds: int, robots: int = 1, spec: RobotSpec | None = None) -> None:
        self.spec = spec or RobotSpec()
        self.poses = np.zeros((worlds, robots, 3))
        self._plans: list[Floorplan | None] = [None] * worlds
        self._spaces: list[pymunk.Space] = [pymunk.Space() for _ in range(worlds)]
        self._bodies: list[list[pymunk.Body]] = [[] for _ in range(worlds)]

    def place(self, world: int, plan: Floorplan, poses: Sequence[Pose]) -> None:
        """Put one world's robots at rest at the given poses in a floor plan."""
        if self._plans[world] is not plan:
            self._plans[world] = plan
            self._spaces[world] = _build_space(plan)
        else:
            for body in self._bodies[world]:
                self._spaces[world].remove(body, *body.shapes)
        self._bodies[world] = [self._add_robot(self._spaces[world], pose) for pose in poses]
        self.poses[world] = poses

    def advance(self, commands: NDArray[np.float64], duration: float, clearance: NDArray[np.float64]) -> None:
        """Drive every robot for ``duration`` seconds and update ``poses``.

        Each step moves a body along the chord of the arc that the wheels describe, so a step of any length ends where
        the arc ends; robots that can touch nothing meanwhile take a single one.

        Args:
            commands: ``(worlds, robots, 2)`` forward speed [m/s] and turn rate [rad/s].
            duration: [s].
            clearance: ``(worlds, robots)`` distance from each robot's centre to the nearest surface [m].
        """
        closing = 1.0 if self.poses.shape[1] == 1 else 2.0  # another robot may come the other way
        travel = closing * duration * np.abs(commands[:, :, 0]).max(axis=1)
        near = (clearance.min(axis=1) < self.spec.radius + travel + _MARGIN).tolist()
        rows: list[list[list[float]]] = commands.tolist()
        headings: list[list[list[float]]] = self.poses.tolist()
        for world, space in enumerate(self._spaces):
            bodies = self._bodies[world]
            if near[world]:
                self._push(space, bodies, rows[world], duration)
            else:
                for body, (speed, rate), pose in zip(bodies, rows[world], headings[world], strict=True):
                    _set_chord(body, pose[2], speed, rate, duration)
                space.step(duration)
            headings[world] = [_pose_of(body) for body in bodies]
        self.poses[:] = headings

    def _push(
        self, space: pymunk.Space, bodies: list[pymunk.Body], commands: list[list[float]], duration: float
    ) -> None:
        """Drive among obstacles, in short steps.

        A step of the solver moves the bodies first, then takes up velocities and clips them at contacts. The wheels'
        velocity therefore goes in between, through pymunk's callback, and one step more than there are moves is needed.
        """
        steps = math.ceil(duration / self.spec.substep - 1e-9)
        for body, (speed, rate) in zip(bodies, commands, strict=True):
            body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
            body.velocity_func = partial(_turn_wheels, speed, rate)
        for _ in range(steps + 1):
            space.step(duration / steps)
        for body in bodies:
            body.velocity_func = pymunk.Body.update_velocity

    def _add_robot(self, space: pymunk.Space, pose: Pose) -> pymunk.Body:
        body = pymunk.Body(self.spec.mass, pymunk.moment_for_circle(self.spec.mass, 0.0, self.spec.radius))
        body.position = (float(pose[0]), float(pose[1]))
        body.angle = float(pose[2])
        shape = pymunk.Circle(body, self.spec.radius)
        shape.friction = 0.0  # the wheels, not the shell, decide how the robot turns
        space.add(body, shape)
        return body


def _pose_of(body: pymunk.Body) -> list[float]:
    x, y = body.position
    angle = body.angle
    if abs(angle) > math.pi:  # a restored body starts from the wrapped heading: keep the same bits
        body.angle = angle = math.remainder(angle, 2.0 * math.pi)
    return [x, y, angle]


def _set_chord(body: pymunk.Body, heading: float, speed: float, rate: float, dt: float) -> None:
    """Give a body the velocity that leads along the chord of its next arc from ``heading``."""
    half = 0.5 * rate * dt
    chord = speed * (math.sin(half) / half if half != 0.0 else 1.0)
    heading += half
    body.velocity = (chord * math.cos(heading), chord * math.sin(heading))
    body.angular_velocity = rate


def _turn_wheels(speed: float, rate: float, body: pymunk.Body, gravity: object, damping: float, dt: float) -> None:
    """Velocity callback of pymunk: what the wheels do, before contacts have their say."""
    _set_chord(body, body.angle, speed, rate, dt)


def _build_space(plan: Floorplan) -> pymunk.Space:
    space = pymunk.Space()
    space.collision_slop = _SLOP
    walls: list[pymunk.Shape] = [
        pymunk.Segment(space.static_body, (x1, y1), (x2, y2), 0.0) for x1, y1, x2, y2 in plan.edges.tolist()
    ]
    walls += [pymunk.Circle(space.static_body, radius, (x, y)) for x, y, radius in plan.circles.tolist()]
    space.add(*walls)
    return space
