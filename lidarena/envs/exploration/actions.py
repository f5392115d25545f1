"""The exploration robot's actions and the commands they stand for."""

from functools import lru_cache
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.action_parsing import choices_of, shares_of
from lidarena.envs.exploration.options import ROBOT
from lidarena.world.robots import RobotSpec

NAMES = ("forward", "left", "right")
SHARES = np.array([(1.0, 0.0), (0.1, 0.3), (0.1, -0.3)])
"""DA-SLAM's forward, left and right, over the fastest speed and turn rate: 0.5 m/s; 0.05 m/s and 0.3 rad/s."""


@lru_cache(maxsize=64)
def discrete_commands(robot: RobotSpec) -> NDArray[np.float64]:
    """Speeds [m/s] and turn rates [rad/s] (3, 2) of a robot's discrete actions: DA-SLAM's, to its limits; read-only."""
    commands: NDArray[np.float64] = SHARES * (robot.max_speed, robot.max_turn_rate)
    commands.flags.writeable = False
    return commands


def turning_radius(robot: RobotSpec) -> float:
    """Radius of the circle on which a robot drives that keeps turning left, or right [m]."""
    speed, rate = discrete_commands(robot)[NAMES.index("left")]
    return float(speed / rate)


def action_space(kind: str) -> gym.Space[Any]:
    """``Discrete(3)``, or ``Box(-1, 1, (2,))`` of speed and turn rate."""
    if kind == "discrete":
        return gym.spaces.Discrete(len(SHARES))
    return gym.spaces.Box(-1.0, 1.0, (2,), np.float32)


def commands_of(kind: str, actions: Any, worlds: int, robot: RobotSpec = ROBOT) -> NDArray[np.float64]:
    """Commands ``(worlds, 2)``, speed [m/s] and turn rate [rad/s], of one action a world.

    Raises:
        ActionError: An action that is NaN, out of range, or of the wrong shape or type.
    """
    if kind == "discrete":
        return discrete_commands(robot).take(choices_of(actions, worlds, len(SHARES), NAMES), axis=0)
    numbers = shares_of(actions, worlds, ("speed", "turn rate"))
    speeds = robot.max_speed * numbers[:, 0] if robot.reverse else 0.5 * robot.max_speed * (numbers[:, 0] + 1.0)
    return np.stack([speeds, robot.max_turn_rate * numbers[:, 1]], axis=1)


def box_action(robot: RobotSpec, speed: float, rate: float) -> NDArray[np.float32]:
    """The continuous action of a command: speed [m/s] and turn rate [rad/s] within the robot's limits."""
    ahead = speed / robot.max_speed if robot.reverse else speed / (0.5 * robot.max_speed) - 1.0
    return np.array([ahead, rate / robot.max_turn_rate], dtype=np.float32)
