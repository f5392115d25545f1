"""The exploration robot as a baseline sees it: its commands, its beams and the action space they stand for."""

from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.exploration.actions import box_action, discrete_commands
from lidarena.envs.exploration.observations import ENTROPY
from lidarena.envs.exploration.options import ROBOT, ExplorationOptions
from lidarena.envs.exploration.room import least_distance, sees_what_is_near
from lidarena.envs.exploration.scan_sectors import FRONT_ANGLES, SECTORS, sector_angles
from lidarena.envs.registration import owner_of
from lidarena.planning.grid.steering import Commands

_SPEED, _TURN_RATE = 0.5, 1.0
"""With continuous actions the robot is driven no faster than DA-SLAM's [m/s, rad/s]."""
_STEERED = np.array([(1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 0.5), (1.0, -0.5)])
_NEARNESS = ("frontier_histogram", "frontier_arcs")
"""Observations that begin with how near the nearest hit in each sector is."""
_KNOWN = ("da_slam", "sectors", *_NEARNESS, "map")
"""Observations that hold beams."""


class Robot:
    """Translates between an environment's actions and observations and what planning works with.

    Attributes:
        commands: What the robot can do. With discrete actions these are the three actions in their order, otherwise
            forward, turning on the spot and wide arcs.
        period: Seconds between two actions.
        spec: Its size and limits.
        options: Of the environment.
    """

    def __init__(self, env: Any) -> None:
        """Read the options of an exploration environment, wrapped or not.

        Raises:
            ConfigError: if its actions are neither ``Discrete(3)`` nor a box of two numbers.
        """
        space = getattr(env, "single_action_space", env.action_space)
        owner = owner_of(env, "options")
        options = self.options = ExplorationOptions() if owner is None else owner.options
        self.spec, self.period, self._lidar = options.robot, options.decision_period, options.lidar
        self._observation = str(options.observation).removesuffix(ENTROPY)
        self._discrete = isinstance(space, gym.spaces.Discrete)
        if isinstance(space, gym.spaces.Discrete) and space.n == 3:
            rows = discrete_commands(self.spec)
        elif isinstance(space, gym.spaces.Box) and space.shape == (2,):
            rows = _STEERED * (min(self.spec.max_speed, _SPEED), min(self.spec.max_turn_rate, _TURN_RATE))
        else:
            raise ConfigError(f"an action space {space}, allowed are Discrete(3) and a Box of shape (2,)")
        self.commands = Commands.of(rows, self.period)

    @property
    def extra_room(self) -> float:
        """How much more room than DA-SLAM's robot it needs beside it (m)."""
        return self.spec.bumper - ROBOT.bumper

    @property
    def least_distance(self) -> float:
        """Distance to what a beam has hit below which commands are not given (m)."""
        return least_distance(self.options)

    def sees_what_is_near(self, observation: Any) -> bool:
        """Return whether the beams that an observation holds hit all that is near."""
        return isinstance(observation, Mapping) and "scan" in observation and sees_what_is_near(self.options)

    def sum_of_beams(self, observation: Any) -> float:
        """Return the sum of the beams that an observation holds: it tells whether they are those of before."""
        return float(self._beams(observation)[0].sum())

    @property
    def sight(self) -> float:
        """Range of its lidar (m)."""
        return self._lidar.max_range

    def action(self, command: int) -> Any:
        """Return the environment's action for a command."""
        return command if self._discrete else box_action(self.spec, *self.commands.velocities[command].tolist())

    def beams_in(self, observation: Any, info: Mapping[str, Any]) -> Any:
        """Return an observation that holds beams: the whole scan in ``info``, else the environment's own.

        DA-SLAM's five beams would miss a chair's leg between two of them.
        """
        if "scan" not in info:
            return observation
        return {"scan": np.asarray(info["scan"], np.float64) / self._lidar.max_range}

    def ranges(self, observation: Any) -> NDArray[np.float32]:
        """Return the ranges of the beams that an observation holds, (beams,) [m]."""
        return (self._beams(observation)[0] * self._lidar.max_range).astype(np.float32)

    def angles(self, observation: Any) -> NDArray[np.float64]:
        """Return the angles of the beams that an observation holds, (beams,) [rad]."""
        return np.array(self._beams(observation)[1], np.float64)  # a copy: kernels are compiled for writable ones

    def hits(self, observation: Any, pose: NDArray[np.float64], reach: float) -> NDArray[np.float64]:
        """Return where the observed beams hit something, (n, 2) x, y (m).

        Args:
            observation: The environment's.
            pose: (3,) of the robot.
            reach: Hits farther away than this are left out (m).
        """
        scan, angles = self._beams(observation)
        longest = self._lidar.max_range
        near = (scan > 0.0) & (scan < 1.0) & (scan * longest < reach)
        away, heading = scan[near] * longest, angles[near] + pose[2]
        points: NDArray[np.float64] = pose[:2] + np.column_stack([away * np.cos(heading), away * np.sin(heading)])
        return points

    def _beams(self, observation: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Ranges over the largest one, and angles [rad], of the beams that an observation holds, (n,) each.

        None of an observation that is not the environment's own.
        """
        if isinstance(observation, Mapping) and "scan" in observation:
            scan = np.asarray(observation["scan"], np.float64)
            return scan, self._lidar.angles
        if self._observation not in _KNOWN:
            return np.empty(0), np.empty(0)
        numbers = np.asarray(observation, np.float64)
        if self._observation == "sectors":
            return numbers[:SECTORS], sector_angles()
        if self._observation in _NEARNESS:  # rounded, as a free beam is to have the range 1
            touch = self.spec.contact_distance / self._lidar.max_range
            return np.round(touch / numbers[:SECTORS], 5), sector_angles()
        return numbers[: len(FRONT_ANGLES)], np.array(FRONT_ANGLES)
