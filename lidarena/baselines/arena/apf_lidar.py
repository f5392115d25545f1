"""The traditional potential field of a robot that knows only what its lidar sees now."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.robot_interface import HeadingController
from lidarena.baselines.arena.seen_obstacles import nearest_of_each
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.potential_field import plan_path

_SMALL_STEPS = 10
"""Steps of the walk down the potential in one of the robot."""
_NET = 0.5
"""Trapped: two steps' walk leads less than this share of a step away."""
_CLOSE = 0.999
"""A hit counts as no nearer than this share of the robot's radius allows: noise may put one inside of the robot."""


@register("apf_lidar", family="arena")
class TraditionalLidarField:
    """Walks down Khatib's potential of the points nearest to it, one for each obstacle in the scan.

    Attributes:
        finished: Whether it is trapped.
    """

    def __init__(self, env: Any) -> None:
        """Make it for an arena environment."""
        self._heading = HeadingController(env)
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self.finished = False

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: Not read.
            info: The environment's; ``scan``, ``pose``, ``goal`` and ``radius`` are used.
        """
        pose, goal, step = info["pose"], info["goal"], self._heading.step
        points = nearest_of_each(info, self._heading.lidar)
        away = np.hypot(*(points - pose[:2]).T)
        radii = np.minimum(float(info["radius"]), _CLOSE * away)  # obstacles, grown by the robot's radius
        walk = self._downhill(np.column_stack([points, radii]), pose[:2], goal)
        self._heading.show(walk)
        net = float(np.hypot(*(walk[-1] - pose[:2])))
        stuck = len(walk) == 2 * _SMALL_STEPS + 1 and net < _NET * step
        self.finished = stuck and float(np.hypot(*(goal - pose[:2]))) > 2.0 * step
        dx, dy = walk[min(_SMALL_STEPS, len(walk) - 1)] - pose[:2]
        return self._heading.towards(math.atan2(dy, dx), pose)

    def _downhill(
        self, discs: NDArray[np.float64], place: NDArray[np.float64], goal: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Where a walk down the potential (n, 2) leads within two steps of the robot [m]."""
        step = self._heading.step  # 1 m in Yang et al.'s room, where a step of the walk is 0.1 m
        lengths = {"gamma": step / _SMALL_STEPS, "rho_0": 8.0 * step, "d_0": 8.0 * step, "arrival_radius": 0.1 * step}
        steps = 2 * _SMALL_STEPS
        return plan_path(discs, place, goal, "traditional", max_steps=steps, trap_test="none", **lengths).path
