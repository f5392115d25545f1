"""Rigid-body motion: one pymunk space a world, robots with a differential drive among static walls."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.robots import RobotSpec

_SLOP = 1e-3
"""Overlap that contacts tolerate [m]; pymunk's default of 0.1 is meant for pixels."""
_MARGIN = 0.02
"""Room beside a robot's way within which it might touch what its beams see, or just miss [m]."""


class Physics:
    """The pymunk spaces of a batch of worlds.

    Args:
        worlds: Number of worlds.
        robots: Number of robots in each.
        spec: The robots' body.

    Attributes:
        poses: ``(worlds, robots, 3)`` true poses, x, y, theta [m, m, rad].
        touched: ``(worlds,)`` whether some robot of a world touched anything in the last ``advance``.
    """

    def __init__(self, worlds: int, robots: int = 1, spec: RobotSpec | None = None) -> None:
        self.spec = spec or RobotSpec()
        self.poses = np.zeros((worlds, robots, 3))
        self.touched = np.zeros(worlds, np.bool_)
        self._plans: list[Floorplan | None] = [None] * worlds
        self._specs = [self.spec] * worlds
        self._spaces: list[pymunk.Space | None] = [None] * worlds

    def place(self, world: int, plan: Floorplan, poses: Sequence[Pose], spec: RobotSpec | None = None) -> None:
        """Put one world's robots at rest at the given poses in a floor plan.

        Args:
            world: Which one.
            plan: Its walls and pillars; pymunk hears of them when a robot first comes near something.
            poses: One a robot.
            spec: The body of this world's robots, if it is not the batch's.
        """
        if self._plans[world] is not plan:
            self._plans[world], self._spaces[world] = plan, None
        self._specs[world] = spec or self.spec
        self.poses[world] = poses
        self.touched[world] = False

    def advance(self, commands: NDArray[np.float64], duration: float, near: NDArray[np.bool_]) -> None:
        """Drive every robot for ``duration`` seconds and update ``poses``.

        Each step moves a body along the chord of the arc that the wheels describe, so a step of any length ends where
        the arc ends. Robots that can touch nothing meanwhile take a single one, without asking pymunk: its solver would
        add velocity times duration to the pose and find no contact.

        Args:
            commands: ``(worlds, robots, 2)`` forward speed [m/s] and turn rate [rad/s].
            duration: [s].
            near: ``(worlds,)`` whether some robot of a world may touch something; see ``may_touch``.
        """
        self.touched[:] = False
        for world in np.flatnonzero(near).tolist():
            self._push(world, commands[world].tolist(), duration)
        glide(near, commands, duration, self.poses)

    def _push(self, world: int, commands: list[list[float]], duration: float) -> None:
        """Drive one world's robots among obstacles, in short steps.

        A step of the solver moves the bodies first, then takes up velocities and clips them at contacts. The wheels'
        velocity therefore goes in between, through pymunk's callback, and one step more than there are moves is needed.
        The bodies are new ones: an old one would still be pushed out of what it last touched, an episode ago perhaps,
        and a resumed training could not repeat that.
        """
        spec, space = self._specs[world], self._space(world)
        steps = math.ceil(duration / spec.substep - 1e-9)
        space.remove(*space.bodies, *(shape for body in space.bodies for shape in body.shapes))
        bodies = [add_robot(space, spec) for _ in commands]
        for body, (speed, rate), (x, y, theta) in zip(bodies, commands, self.poses[world].tolist(), strict=True):
            body.position, body.angle = (x, y), theta
            body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
            body.velocity_func = partial(turn_wheels, speed, rate)
        for _ in range(steps + 1):
            space.step(duration / steps)
        self.poses[world] = [(*body.position, math.remainder(body.angle, 2.0 * math.pi)) for body in bodies]

    def _space(self, world: int) -> pymunk.Space:
        """One world's space, built when it is first needed."""
        space = self._spaces[world]
        if space is None:
            plan = self._plans[world]
            assert plan is not None, "place() comes first"
            space = self._spaces[world] = build_space(plan)
            space.on_collision(begin=partial(self._touch, world))
        return space

    def _touch(self, world: int, arbiter: object, space: object, data: object) -> None:
        """Callback of pymunk: two shapes have met."""
        self.touched[world] = True


@leaf
def may_touch(
    commands: NDArray[np.float64],
    duration: float,
    radius: float,
    ranges: NDArray[np.float64],
    directions: NDArray[np.float64],
    near: NDArray[np.bool_],
) -> None:
    """Fill ``near`` (worlds,): whether a world's only robot may touch what its beams see, while it drives.

    Args:
        commands: (worlds, robots, 2) forward speed [m/s] and turn rate [rad/s].
        duration: [s].
        radius: Of the robot, or of the circle that holds it [m].
        ranges: (worlds, 1, beams) exact ranges [m].
        directions: (2, beams) cos and sin of the beams' angles.
        near: Output.
    """
    for world in range(near.shape[0]):
        half = 0.5 * commands[world, 0, 1] * duration
        travel = commands[world, 0, 0] * duration
        reach, keep = radius + abs(travel) + _MARGIN, radius + _MARGIN
        ahead, aside = travel * math.cos(half), travel * math.sin(half)
        near[world] = False
        for k in range(ranges.shape[2]):
            if ranges[world, 0, k] < reach:  # distance of the point from the line that the centre moves along
                x, y = ranges[world, 0, k] * directions[0, k], ranges[world, 0, k] * directions[1, k]
                share = (x * ahead + y * aside) / (travel * travel) if travel != 0.0 else 0.0
                share = min(max(share, 0.0), 1.0)
                dx, dy = x - share * ahead, y - share * aside
                if dx * dx + dy * dy < keep * keep:
                    near[world] = True
                    break


@leaf
def glide(near: NDArray[np.bool_], commands: NDArray[np.float64], duration: float, poses: NDArray[np.float64]) -> None:
    """Move the robots of all worlds that are not ``near`` (worlds,) along the chords of their arcs; see ``advance``."""
    for world in range(poses.shape[0]):
        if near[world]:
            continue
        for robot in range(poses.shape[1]):
            vx, vy = chord(poses[world, robot, 2], commands[world, robot, 0], commands[world, robot, 1], duration)
            theta = poses[world, robot, 2] + commands[world, robot, 1] * duration
            theta -= 2.0 * math.pi * math.floor(theta / (2.0 * math.pi) + 0.5)
            poses[world, robot, 0] += vx * duration
            poses[world, robot, 1] += vy * duration
            poses[world, robot, 2] = theta


@inlined
def chord(heading: float, speed: float, rate: float, dt: float) -> tuple[float, float]:
    """Velocity along the chord of the arc that a robot describes from ``heading`` in ``dt``."""
    half = 0.5 * rate * dt
    along = speed * (math.sin(half) / half if half != 0.0 else 1.0)
    return along * math.cos(heading + half), along * math.sin(heading + half)


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
