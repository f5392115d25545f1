"""The exploration robot as a baseline sees it: its commands, its beams and the action space they stand for."""

import math
from collections.abc import Mapping
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.jit import kernel
from lidarena.envs.exploration.observations import SECTORS
from lidarena.planning.grid.steering import Commands
from lidarena.world.floorplan import START_CLEARANCE

FULL_SPEED, TURN_SPEED, TURN_RATE = 0.5, 0.05, 0.3
"""DA-SLAM's actions: forward at 0.5 m/s; left and right at 0.05 m/s and 0.3 rad/s."""
_STEERED = [(FULL_SPEED, 0.0), (0.0, 1.0), (0.0, -1.0), (FULL_SPEED, 0.5), (FULL_SPEED, -0.5)]
_BEAM_ANGLES = np.array([0.0, math.pi / 4, math.pi / 2, -math.pi / 4, -math.pi / 2])
_MAX_RANGE = 3.5
_TOUCH = 0.12  # a beam shorter than this ends the episode (m)
_BEAM_SLACK = 0.03  # three sigma of the lidar (m)


class Robot:
    """Translates between an environment's actions and observations and what planning works with.

    Attributes:
        commands: What the robot can do. With discrete actions these are the three actions in their order, otherwise
            forward, turning on the spot and wide arcs.
        period: Seconds between two actions.
    """

    def __init__(self, env: Any) -> None:
        """Read the action space and the decision period of an exploration environment.

        Raises:
            ConfigError: if its actions are neither ``Discrete(3)`` nor a box of two numbers.
        """
        space = getattr(env, "single_action_space", env.action_space)
        self.period = _decision_period(env)
        self._discrete = isinstance(space, gym.spaces.Discrete)
        if isinstance(space, gym.spaces.Discrete) and space.n == 3:
            rows = [(FULL_SPEED, 0.0), (TURN_SPEED, TURN_RATE), (TURN_SPEED, -TURN_RATE)]
        elif isinstance(space, gym.spaces.Box) and space.shape == (2,):
            rows = _STEERED
        else:
            raise ConfigError(f"an action space {space}, allowed are Discrete(3) and a Box of shape (2,)")
        self.commands = Commands.of(rows, self.period)

    def action(self, command: int) -> Any:
        """Return the environment's action for a command."""
        return command if self._discrete else self._box(*self.commands.velocities[command])

    @staticmethod
    def _box(v: float, w: float) -> NDArray[np.float32]:
        # the environment's mapping: v = 0.25 (a0 + 1) m/s, w = a1 rad/s
        return np.array([v / (0.5 * FULL_SPEED) - 1.0, w], dtype=np.float32)

    def would_touch(self, command: int, observation: Any) -> bool:
        """Return whether the beams that were observed say that a command ends in a collision.

        A command that takes the robot away from what a beam has hit is never held against that beam.
        """
        return bool(_touches(*_beams(observation), *self.commands.moves[command, :2]))

    @staticmethod
    def hits(observation: Any, pose: NDArray[np.float64], reach: float) -> NDArray[np.float64]:
        """Return where the observed beams hit something, (n, 2) x, y (m).

        Args:
            observation: The environment's.
            pose: (3,) of the robot.
            reach: Hits farther away than this are left out (m).
        """
        scan, angles = _beams(observation)
        near = (scan > 0.0) & (scan * _MAX_RANGE < reach)
        away, heading = scan[near] * _MAX_RANGE, angles[near] + pose[2]
        points: NDArray[np.float64] = pose[:2] + np.column_stack([away * np.cos(heading), away * np.sin(heading)])
        return points


def _beams(observation: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ranges over the largest one, and angles [rad], of the beams that an observation holds, (n,) each."""
    if isinstance(observation, Mapping):
        scan = np.asarray(observation["scan"], np.float64)
        return scan, np.linspace(0.0, 2.0 * math.pi, len(scan), endpoint=False)
    numbers = np.asarray(observation, np.float64)
    if len(numbers) > SECTORS:
        ranges = numbers[:SECTORS]
        if len(numbers) > 2 * SECTORS:  # the compass: nearness; rounded, as a free beam is to have the range 1
            ranges = np.round(START_CLEARANCE / _MAX_RANGE / ranges, 5)
        return ranges, np.linspace(0.0, 2.0 * math.pi, SECTORS, endpoint=False)
    return numbers[: len(_BEAM_ANGLES)], _BEAM_ANGLES


def _decision_period(env: Any) -> float:
    inner = getattr(env, "unwrapped", env)
    period = getattr(inner, "decision_period", None)
    if period is None:
        spec = getattr(env, "spec", None)
        period = spec.kwargs.get("decision_period", 0.2) if spec is not None else 0.2
    return float(period)


@kernel
def _touches(scan: NDArray[np.float64], angles: NDArray[np.float64], dx: float, dy: float) -> bool:
    """Whether (dx, dy) lies too near to what a beam of ``scan`` (n,) at ``angles`` (n,) hit, and nearer than before."""
    for i in range(scan.shape[0]):
        before = scan[i] * _MAX_RANGE
        if 0.0 < scan[i] < 1.0:
            after = math.hypot(before * math.cos(angles[i]) - dx, before * math.sin(angles[i]) - dy)
            if after < _TOUCH + _BEAM_SLACK and after < before:
                return True
    return False
