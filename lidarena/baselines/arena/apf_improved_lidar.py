"""The improved potential field of a robot that knows only what its lidar has seen so far."""

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.baselines.arena.chord_follower import ChordFollower
from lidarena.baselines.arena.robot_interface import HeadingController
from lidarena.baselines.arena.seen_obstacles import SeenObstacles, hidden_beside, hits_of
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.field_parameters import FieldWarning
from lidarena.planning.potential_field.potential_field import plan_path
from lidarena.planning.potential_field.regression_search import path_length

_REACH = 8.0
"""Reach of obstacles and fills in steps or radii of the robot, whichever are longer: Yang et al.'s, whose room of 100 m
a robot of 1 m crosses at 1 m a step. No obstacle reaches farther than the lidar."""
_CELL = 0.5
"""Side of the cells in which hits are remembered, over a step."""
_SHARES = (1.0, 0.5, 0.0)
"""Of what may be hidden beside hits, in the order in which a way is looked for."""
_DETOUR = 0.7
"""A path that trusts in less being hidden beside hits must be shorter by this factor."""
_CLOSE = 0.999
"""A hit counts as no nearer than this share of the robot's radius allows: noise may put one inside of the robot."""


@register("apf_improved_lidar", family="arena")
class ImprovedLidarField:
    """Plans as ``apf_improved`` among the hits that it remembers, and again when one of them is in the way.

    Attributes:
        plans: How often it has planned in this episode.
    """

    def __init__(self, env: Any, *, spare: float = 0.4, ways: int = 1) -> None:
        """Make it for an arena environment.

        Args:
            env: The environment.
            spare: Room kept beside a hit for what may be hidden between two beams, at most, over the robot's radius;
                less where there is no way else.
            ways: See ``FieldParameters``; one is enough where the plan will not last.

        Raises:
            ConfigError: An option out of range.
        """
        if not 0.0 <= spare < 1.0:
            raise ConfigError(f"spare = {spare!r}, allowed are numbers from 0 to 1")
        if ways not in (1, 2, 3):
            raise ConfigError(f"ways = {ways!r}, allowed are 1, 2 and 3")
        self._heading, self._spare, self._ways = HeadingController(env), spare, ways
        self._unit = self._heading.step
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
        pose = info["pose"]
        self._unit = min(max(self._heading.step, float(info["radius"])), self._heading.lidar.max_range / _REACH)
        points, hidden = hits_of(info, self._heading.lidar)[0], hidden_beside(info, self._heading.lidar)
        new = self._seen.add(points, hidden)
        hits = np.vstack([self._seen.hits(), np.column_stack([points, hidden])])  # memory has one a cell
        choices = self._grown(hits, pose, float(info["radius"]))
        follower = self._follower
        if follower is None or (new and follower.is_blocked(choices[0])):
            follower = self._plan(pose, info["goal"], choices)
        heading, free = follower.careful_heading(pose, choices)
        if not free:  # what has come into sight leaves no way on along this path
            heading, _ = self._plan(pose, info["goal"], choices).careful_heading(pose, choices)
        return self._heading.towards(heading, pose)

    def _grown(self, hits: NDArray[np.float64], pose: NDArray[np.float64], radius: float) -> list[NDArray[np.float64]]:
        """Discs (n, 3) about hits (n, 3) with all that may be hidden beside them, half of it, and nothing."""
        most = _CLOSE * np.hypot(*(hits[:, :2] - pose[:2]).T)
        hidden = np.minimum(hits[:, 2], self._spare * radius)
        radii = [np.minimum(radius + share * hidden, most) for share in _SHARES]
        return [np.column_stack([hits[:, :2], each]) for each in radii]

    def _plan(
        self, pose: NDArray[np.float64], goal: NDArray[np.float64], choices: list[NDArray[np.float64]]
    ) -> ChordFollower:
        """Plan among the first discs, or those with half as much hidden where that is far shorter."""
        path, least = np.vstack([pose[:2], goal]), math.inf
        for discs in choices:
            if discs is choices[-1] and math.isfinite(least):
                break  # only where there is no other way
            found = self._search(discs, pose[:2], goal)
            if found is not None and path_length(found) < _DETOUR * least:
                path, least = found, path_length(found)
        self._heading.show(path)
        self._follower = ChordFollower(path, self._heading.step, choices[-1])
        self.plans += 1
        return self._follower

    def _search(
        self, discs: NDArray[np.float64], place: NDArray[np.float64], goal: NDArray[np.float64]
    ) -> NDArray[np.float64] | None:
        """A path to the goal among discs that have grown by the robot's radius; None if none is found."""
        lengths = {"rho_0": _REACH, "d_0": _REACH, "gamma": 0.1, "arrival_radius": 0.05, "rho_1": _REACH, "h_0": 1.5}
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
                **{name: value * self._unit for name, value in lengths.items()},
            )
        return found.smoothed if found.success else None
