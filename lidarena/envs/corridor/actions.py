"""The actions of a team's robots and the commands they stand for."""

from functools import lru_cache
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.action_parsing import choices_of, shares_of
from lidarena.envs.corridor.options import ROBOT
from lidarena.world.robots import RobotSpec

NAMES = ("stop", "forward", "left", "right", "turn left", "turn right", "back")
SHARES = np.array([(0.0, 0.0), (1.0, 0.0), (0.8, 0.5), (0.8, -0.5), (0.0, 0.75), (0.0, -0.75), (-0.4, 0.0)])
"""The discrete actions' speed and turn rate over the fastest ones, in the order of ``NAMES``."""


@lru_cache(maxsize=64)
def discrete_commands(robot: RobotSpec = ROBOT) -> NDArray[np.float64]:
    """Speed [m/s] and turn rate [rad/s] of a robot's discrete actions, (7, 2); (6, 2) if it cannot drive back."""
    shares = SHARES if robot.reverse else SHARES[:-1]
    commands: NDArray[np.float64] = shares * (robot.max_speed, robot.max_turn_rate)
    commands.flags.writeable = False
    return commands


def action_space(kind: str, robot: RobotSpec = ROBOT) -> gym.Space[Any]:
    """Of one robot: ``Discrete(7)``, or ``Box(-1, 1, (2,))`` of speed and turn rate."""
    if kind == "discrete":
        return gym.spaces.Discrete(len(discrete_commands(robot)))
    return gym.spaces.Box(-1.0, 1.0, (2,), np.float32)


def commands_of(kind: str, actions: Any, count: int, robot: RobotSpec = ROBOT) -> NDArray[np.float64]:
    """Commands (count, 2) of the actions of ``count`` robots.

    Raises:
        ActionError: An action that is NaN, out of range, or of the wrong shape or type.
    """
    if kind == "discrete":
        known = discrete_commands(robot)
        return known.take(choices_of(actions, count, len(known), NAMES), axis=0)
    numbers = shares_of(actions, count, ("speed", "turn rate"))
    if not robot.reverse:
        numbers[:, 0] = 0.5 * (numbers[:, 0] + 1.0)
    commands: NDArray[np.float64] = numbers * (robot.max_speed, robot.max_turn_rate)
    return commands


def action_for(kind: str, speed: float, rate: float, robot: RobotSpec = ROBOT) -> Any:
    """The action that comes nearest to a command; too fast a command becomes slower on the same arc.

    Args:
        kind: ``"continuous"`` or ``"discrete"``.
        speed: [m/s].
        rate: [rad/s].
        robot: Whose action.
    """
    top_speed, top_rate = robot.max_speed, robot.max_turn_rate
    if kind == "discrete":
        known = discrete_commands(robot)
        return int(np.argmin(np.hypot((known[:, 0] - speed) / top_speed, (known[:, 1] - rate) / top_rate)))
    excess = max(abs(speed) / top_speed, abs(rate) / top_rate, 1.0)
    ahead = speed / top_speed / excess
    ahead = ahead if robot.reverse else 2.0 * ahead - 1.0
    return np.array([ahead, rate / top_rate / excess], np.float32).clip(-1.0, 1.0)
