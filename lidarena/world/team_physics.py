"""Rigid-body motion of teams: robots that are near something move in pymunk, and who touches what is noted."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import pymunk
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.robots import RobotSpec
from lidarena.world.spaces import Spaces, add_robot, glide_one, turn_wheels

_WALL, _ROBOT = 0, 1  # pymunk's collision types


class TeamPhysics(Spaces):
    """Worlds in which each robot is near something or not, and tells what it touches.

    Args:
        worlds: How many; see ``Spaces``.
        robots: In each of them.
        spec: What they are.

    Attributes:
        touched_wall: ``(worlds, robots)`` whether a robot touched a wall in the last ``advance``.
        touched_robot: ``(worlds, robots)`` whether it touched another robot.
    """

    def __init__(self, worlds: int, robots: int, spec: RobotSpec) -> None:
        super().__init__(worlds, robots, spec)
        self.touched_wall = np.zeros((worlds, robots), np.bool_)
        self.touched_robot = np.zeros((worlds, robots), np.bool_)
        self._robots_of: dict[pymunk.Body, tuple[int, int]] = {}

    def place(self, world: int, plan: Floorplan, poses: Sequence[Pose], spec: RobotSpec | None = None) -> None:
        """Put one world's robots at rest, where they touch nothing yet; see ``Spaces.place``."""
        super().place(world, plan, poses, spec)
        self.touched_wall[world] = self.touched_robot[world] = False

    def _listen(self, world: int, space: pymunk.Space) -> None:
        space.on_collision(_ROBOT, _WALL, begin=self._note_wall)
        space.on_collision(_ROBOT, _ROBOT, begin=self._note_robots)

    def advance(self, commands: NDArray[np.float64], duration: float, near: NDArray[np.bool_]) -> None:
        """Drive every robot for ``duration`` seconds; update ``poses`` and what was touched.

        Args:
            commands: ``(worlds, robots, 2)`` forward speed [m/s] and turn rate [rad/s].
            duration: [s].
            near: ``(worlds, robots)`` whether a robot may touch something meanwhile. A robot that may touch a marked
                one must be marked, too; the others are moved along the chords of their arcs without asking pymunk.
        """
        self.touched_wall[:] = self.touched_robot[:] = False
        for world in np.logical_or.reduce(near, axis=1).nonzero()[0].tolist():
            self._push_some(world, near[world].nonzero()[0].tolist(), commands[world], duration)
        glide_apart(near, commands, duration, self.poses)

    def _push_some(self, world: int, robots: list[int], commands: NDArray[np.float64], duration: float) -> None:
        """As ``Physics._push``, for some robots of a world."""
        spec, space = self._specs[world], self._space(world)
        steps = math.ceil(duration / spec.substep - 1e-9)
        bodies = []
        for robot in robots:
            x, y, theta = self.poses[world, robot].tolist()
            speed, rate = commands[robot].tolist()
            body = add_robot(space, spec)
            for shape in body.shapes:
                shape.collision_type = _ROBOT
            body.position, body.angle = (x, y), theta
            body.velocity_func = partial(turn_wheels, speed, rate)
            self._robots_of[body] = (world, robot)
            bodies.append(body)
        for _ in range(steps + 1):
            space.step(duration / steps)
        for robot, body in zip(robots, bodies, strict=True):
            self.poses[world, robot] = (*body.position, math.remainder(body.angle, 2.0 * math.pi))
        space.remove(*bodies, *(shape for body in bodies for shape in body.shapes))
        self._robots_of.clear()

    def _note_wall(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        self.touched_wall[self._robots_of[arbiter.bodies[0]]] = True

    def _note_robots(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        for body in arbiter.bodies:
            self.touched_robot[self._robots_of[body]] = True


@leaf
def glide_apart(
    near: NDArray[np.bool_], commands: NDArray[np.float64], duration: float, poses: NDArray[np.float64]
) -> None:
    """Move the robots (worlds, robots) that are not ``near`` along the chords of their arcs; see ``advance``."""
    for world in range(poses.shape[0]):
        for robot in range(poses.shape[1]):
            if near[world, robot]:
                continue
            glide_one(commands[world, robot], duration, poses[world, robot])
