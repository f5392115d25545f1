"""Rigid-body motion: one pymunk space a world, robots with a differential drive among static walls."""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.robots import RobotSpec
from lidarena.world.spaces import Spaces, add_mover, add_robot, glide_one, turn_wheels

_MARGIN = 0.02
"""Room beside a robot's way within which it might touch what its beams see, or just miss [m]."""


class Physics(Spaces):
    """Worlds in which robots move, each of them as a whole: all its robots are near something, or none is.

    Args:
        worlds: How many; see ``Spaces``.
        robots: In each of them.
        spec: What they are; None: the TurtleBot3 Burger.

    Attributes:
        movers: Of each world None, or discs that move past whatever the robots do (n, 5): x, y, velocity, radius.
        touched: ``(worlds,)`` whether some robot of a world touched anything in the last ``advance``.
    """

    def __init__(self, worlds: int, robots: int = 1, spec: RobotSpec | None = None) -> None:
        super().__init__(worlds, robots, spec)
        self.touched = np.zeros(worlds, np.bool_)
        self.movers: list[NDArray[np.float64] | None] = [None] * worlds

    def place(self, world: int, plan: Floorplan, poses: Sequence[Pose], spec: RobotSpec | None = None) -> None:
        """Put one world's robots at rest, where they touch nothing yet; see ``Spaces.place``."""
        super().place(world, plan, poses, spec)
        self.touched[world] = False

    def advance(
        self,
        commands: NDArray[np.float64],
        duration: float,
        near: NDArray[np.bool_],
        active: NDArray[np.bool_] | None = None,
    ) -> None:
        """Drive every robot for ``duration`` seconds and update ``poses``.

        Each step moves a body along the chord of the arc that the wheels describe, so a step of any length ends where
        the arc ends. Robots that can touch nothing meanwhile take a single one, without asking pymunk: its solver would
        add velocity times duration to the pose and find no contact.

        Args:
            commands: ``(worlds, robots, 2)`` forward speed [m/s] and turn rate [rad/s].
            duration: [s].
            near: ``(worlds,)`` whether some robot of a world may touch something; see ``may_touch``.
            active: ``(worlds,)`` the others stand still; None: all are.
        """
        self.touched[:] = False
        for world in np.flatnonzero(near if active is None else near & active).tolist():
            self._push(world, commands[world].tolist(), duration)
        glide(near if active is None else near | ~active, commands, duration, self.poses)

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
        for mover in () if self.movers[world] is None else np.asarray(self.movers[world]).tolist():
            add_mover(space, *mover)
        for _ in range(steps + 1):
            space.step(duration / steps)
        self.poses[world] = [(*body.position, math.remainder(body.angle, 2.0 * math.pi)) for body in bodies]

    def _listen(self, world: int, space: pymunk.Space) -> None:
        space.on_collision(begin=partial(self._touch, world))

    def _touch(self, world: int, arbiter: pymunk.Arbiter, space: object, data: object) -> None:
        """Callback of pymunk: two shapes have met; movers pass through each other, and through what stands."""
        if any(body.body_type == pymunk.Body.DYNAMIC for body in arbiter.bodies):
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
            glide_one(commands[world, robot], duration, poses[world, robot])
