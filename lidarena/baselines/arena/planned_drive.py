"""A policy that plans once, in a world that it knows, and drives along its plan."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.chord_follower import NO_WALLS, ChordFollower
from lidarena.baselines.arena.robot_interface import HeadingController, KnownWorld, known_world
from lidarena.planning.potential_field.disc_clearance import segment_is_free

_NOWHERE = KnownWorld(np.empty((0, 3)), np.array([0.0, 0.0, 9.0, 9.0]), np.full(3, 1.0), np.full(2, 8.0), 0.1)

_REACHED = 1e-6
"""A path that ends this near to the goal ends there [m]."""


class PlannedDrive(ABC):
    """Plans at the first decision of an episode, then follows the path with a step of the robot's for a chord.

    Args:
        env: The arena, or what wraps it.

    Attributes:
        finished: The path ends short of the goal, and the robot is within a step of its end.
        path: (S, 2) what it follows [m]; empty before the first decision.
        before: (M, 2) the path before it was smoothed [m], for the picture; None if it was not.
    """

    name: ClassVar[str]
    guarded: ClassVar[bool] = True
    """Whether a step that would hit something turns aside."""
    before: NDArray[np.float64] | None = None

    def __init__(self, env: Any) -> None:
        self._heading = HeadingController(env)
        self.plan(_NOWHERE)  # loads compiled code, so that the first decision takes as long as all others
        self.reset()

    @abstractmethod
    def plan(self, world: KnownWorld) -> NDArray[np.float64]:
        """Return a path (S, 2) from the robot on; one point if there is none [m]."""

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self._follower: ChordFollower | None = None
        self.finished = self._ends_early = False
        self.path = np.empty((0, 2))

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: Not read.
            info: The environment's; ``circles``, ``bounds``, ``pose``, ``goal`` and ``radius`` are used.

        Raises:
            ConfigError: The environment does not tell the obstacles.
        """
        if self._follower is None:
            world = known_world(self.name, info)
            self.path = self.plan(world)
            self._heading.show(self.path, self.before)
            self._ends_early = self._stops_short(world)
            discs, walls = world.grown() if self.guarded else (np.empty((0, 3)), NO_WALLS)
            self._follower = ChordFollower(self.path, self._heading.step, discs, walls)
        pose = info["pose"]
        heading = self._follower.heading(pose)
        self.finished = self._ends_early and self._follower.at_end(pose)
        return self._heading.towards(heading, pose)

    def _stops_short(self, world: KnownWorld) -> bool:
        """Whether the path ends in a free place that is not the goal; one that ends in an obstacle is driven there."""
        discs, walls = world.grown()
        x, y = self.path[-1].tolist()
        free = segment_is_free(x, y, x, y, discs, walls, np.zeros(1, np.int64))
        return free and float(np.hypot(*(self.path[-1] - world.goal))) > _REACHED
