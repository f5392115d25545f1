"""The improved potential field of a robot that knows only what its lidar has seen so far."""

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.baselines.arena.chord_follower import ChordFollower
from lidarena.baselines.arena.robot_interface import HeadingController
from lidarena.baselines.arena.seen_obstacles import SeenObstacles, hits_of
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.field_parameters import FieldWarning
from lidarena.planning.potential_field.potential_field import plan_path

_CELL = 0.5
"""Side of the cells in which hits are remembered, over a step."""
_CLOSE = 0.999
"""A hit counts as no nearer than this share of the robot's radius allows: noise may put one inside of the robot."""


@register("apf_improved_lidar", family="arena")
class ImprovedLidarField:
    """Plans as ``apf_improved`` among the hits that it remembers, and again when one of them is in the way.

    Attributes:
        plans: How often it has planned in this episode.
    """

    def __init__(self, env: Any, *, spare: float = 0.1, ways: int = 1) -> None:
        """Make it for an arena environment.

        Args:
            env: The environment.
            spare: A hit nearer to the path than this, beside the robot's radius and over it, makes it plan again.
            ways: See ``FieldParameters``; one is enough where the plan will not last.

        Raises:
            ConfigError: An option out of range.
        """
        if not 0.0 <= spare < 1.0:
            raise ConfigError(f"spare = {spare!r}, allowed are numbers from 0 to 1")
        if ways not in (1, 2, 3):
            raise ConfigError(f"ways = {ways!r}, allowed are 1, 2 and 3")
        self._heading, self._spare, self._ways = HeadingController(env), spare, ways
        self._search(np.empty((0, 3)), np.zeros(2), np.full(2, 3.0))  # loads compiled code before anything is timed
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self._seen = SeenObstacles(_CELL * self._heading.step)
        self._follower: ChordFollower | None = None
        self.plans = 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: Not read.
            info: The environment's; ``scan``, ``pose``, ``goal`` and ``radius`` are used.
        """
        pose, radius = info["pose"], float(info["radius"])
        new = self._seen.add(hits_of(info, self._heading.lidar)[0])
        points = self._seen.points()
        away = np.hypot(*(points - pose[:2]).T)
        wide = np.column_stack([points, np.full(len(points), radius * (1.0 + self._spare))])
        if self._follower is None or (new and self._follower.is_blocked(wide)):
            discs = np.column_stack([points, np.minimum(radius, _CLOSE * away)])
            path = self._search(discs, pose[:2], info["goal"])
            self._heading.show(path)
            self._follower = ChordFollower(path, self._heading.step, discs)
            self.plans += 1
        return self._heading.towards(self._follower.heading(pose), pose)

    def _search(
        self, discs: NDArray[np.float64], place: NDArray[np.float64], goal: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """A path to the goal among discs that have grown by the robot's radius, or straight to it if there is none."""
        step = self._heading.step
        lengths = {"rho_0": 8.0, "d_0": 8.0, "gamma": 0.1, "arrival_radius": 0.05, "rho_1": 8.0, "h_0": 1.5}
        clear = np.hypot(*(discs[:, :2] - goal).T) > discs[:, 2]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FieldWarning)
            found = plan_path(
                discs[clear],
                place,
                goal,
                "robust",
                fit_scale=False,
                ways=self._ways,
                **{name: value * step for name, value in lengths.items()},
            )
        return found.smoothed if found.success and math.isfinite(found.smoothed[-1, 0]) else np.vstack([place, goal])
