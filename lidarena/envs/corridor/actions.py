"""The actions of a team's robots and the commands they stand for."""

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.action_bounds import within_bounds
from lidarena.envs.corridor.options import ROBOT
from lidarena.world.robots import RobotSpec

NAMES = ("stop", "forward", "left", "right", "turn left", "turn right", "back")
SHARES = np.array([(0.0, 0.0), (1.0, 0.0), (0.8, 0.5), (0.8, -0.5), (0.0, 0.75), (0.0, -0.75), (-0.4, 0.0)])
"""The discrete actions' speed and turn rate over the fastest ones, in the order of ``NAMES``."""


def discrete_commands(robot: RobotSpec = ROBOT) -> NDArray[np.float64]:
    """Speed [m/s] and turn rate [rad/s] of a robot's discrete actions, (7, 2); (6, 2) if it cannot drive back."""
    shares = SHARES if robot.reverse else SHARES[:-1]
    commands: NDArray[np.float64] = shares * (robot.max_speed, robot.max_turn_rate)
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
    try:
        values = np.asarray(actions)
    except ValueError:
        values = np.empty(0, object)
    if kind == "discrete":
        known = discrete_commands(robot)
        if values.shape != (count,) or values.dtype.kind not in "iu":
            raise ActionError(f"{_show(actions, count)} not one of the whole numbers 0 to {len(known) - 1}")
        if ((values < 0) | (values >= len(known))).any():
            words = ", ".join(f"{number} ({name})" for number, name in enumerate(NAMES[: len(known)]))
            raise ActionError(f"{_show(actions, count)} out of range; {words} are allowed")
        chosen: NDArray[np.float64] = known[values]
        return chosen
    if values.shape != (count, 2) or values.dtype.kind not in "iuf":
        raise ActionError(f"{_show(actions, count)} not a pair of numbers, speed and turn rate, from -1 to 1")
    numbers = within_bounds(values.astype(np.float64))
    if numbers is None:
        raise ActionError(f"{_show(actions, count)} NaN or out of range; numbers from -1 to 1 are allowed")
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


def _show(actions: Any, count: int) -> str:
    """The begin of a refusal: which action is (or actions are) wrong."""
    one = count == 1 and np.ndim(actions) >= 1
    text = repr(actions[0] if one else actions)
    return f"action {text if len(text) < 80 else text[:77] + '...'} is"
