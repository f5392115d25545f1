"""What an arena environment tells a policy, and the turn that brings it on a heading."""

import math
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.arena.actions import action_of
from lidarena.envs.registration import owner_of


class KnownWorld(NamedTuple):
    """An arena whose obstacles are known.

    Attributes:
        circles: (K, 3) x, y, radius [m].
        bounds: (4,) of the room [m].
        pose: (3,) of the robot [m, m, rad].
        goal: (2,) [m].
        radius: Of the robot [m].
    """

    circles: NDArray[np.float64]
    bounds: NDArray[np.float64]
    pose: NDArray[np.float64]
    goal: NDArray[np.float64]
    radius: float

    @property
    def scene(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Circles, start and goal, as the planners take them."""
        return self.circles, self.pose[:2], self.goal

    def grown(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Obstacles (K, 3) and room (4,) for a robot that is a point."""
        discs = self.circles + np.array([0.0, 0.0, self.radius])
        return discs, self.bounds + self.radius * np.array([1.0, 1.0, -1.0, -1.0])


def known_world(name: str, info: dict[str, Any]) -> KnownWorld:
    """Read the obstacles out of an ``info``.

    Raises:
        ConfigError: The environment does not tell them.
    """
    if "circles" not in info:
        raise ConfigError(
            f"baseline {name!r} plans with the obstacles known; make the environment with knowledge='map', or take "
            "'apf_lidar' or 'apf_improved_lidar'"
        )
    circles = np.asarray(info["circles"], np.float64)
    return KnownWorld(circles, info["bounds"], info["pose"], info["goal"], float(info["radius"]))


class HeadingController:
    """Turns headings into an environment's actions.

    Args:
        env: An arena environment, or a vector of which one world is driven.

    Attributes:
        step: What the robot drives in a decision [m].
        lidar: What its scans are of.
    """

    def __init__(self, env: Any) -> None:
        inner = owner_of(env, "step_length")
        self._space: gym.Space[Any] = getattr(env, "single_action_space", env.action_space)
        self.step, self.lidar = float(inner.step_length), inner.options.lidar
        self._show = getattr(inner, "show", None)

    def show(self, plan: NDArray[np.float64], before: NDArray[np.float64] | None = None) -> None:
        """Let a plan be seen in the picture of a single environment, see ``ArenaEnv.show``."""
        if self._show is not None:
            self._show(plan, before)

    def towards(self, heading: float, pose: NDArray[np.float64]) -> Any:
        """The action after which the robot drives on a heading [rad], from its pose (3,)."""
        turn = math.remainder(heading - float(pose[2]), 2.0 * math.pi)
        return action_of(self._space, turn)
