"""The actions of a team's robots and the commands they stand for."""

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.action_bounds import within_bounds

TOP_SPEED = 0.5
"""Speed of the continuous action 1 [m/s]; -1 drives backwards."""
TOP_TURN_RATE = 2.0
"""Turn rate of the continuous action 1 [rad/s]."""
NAMES = ("stop", "forward", "left", "right", "turn left", "turn right", "back")
COMMANDS = np.array([(0.0, 0.0), (0.5, 0.0), (0.4, 1.0), (0.4, -1.0), (0.0, 1.5), (0.0, -1.5), (-0.2, 0.0)])
"""Speed [m/s] and turn rate [rad/s] of the discrete actions, in the order of ``NAMES``."""


def action_space(kind: str) -> gym.Space[Any]:
    """Of one robot: ``Discrete(7)``, or ``Box(-1, 1, (2,))`` of speed and turn rate."""
    if kind == "discrete":
        return gym.spaces.Discrete(len(COMMANDS))
    return gym.spaces.Box(-1.0, 1.0, (2,), np.float32)


def commands_of(kind: str, actions: Any, count: int) -> NDArray[np.float64]:
    """Commands (count, 2) of the actions of ``count`` robots.

    Raises:
        ActionError: An action that is NaN, out of range, or of the wrong shape or type.
    """
    try:
        values = np.asarray(actions)
    except ValueError:
        values = np.empty(0, object)
    if kind == "discrete":
        if values.shape != (count,) or values.dtype.kind not in "iu":
            raise ActionError(f"{_show(actions, count)} not one of the whole numbers 0 to {len(COMMANDS) - 1}")
        if ((values < 0) | (values >= len(COMMANDS))).any():
            words = ", ".join(f"{number} ({name})" for number, name in enumerate(NAMES))
            raise ActionError(f"{_show(actions, count)} out of range; {words} are allowed")
        commands: NDArray[np.float64] = COMMANDS[values]
        return commands
    if values.shape != (count, 2) or values.dtype.kind not in "iuf":
        raise ActionError(f"{_show(actions, count)} not a pair of numbers, speed and turn rate, from -1 to 1")
    numbers = within_bounds(values.astype(np.float64))
    if numbers is None:
        raise ActionError(f"{_show(actions, count)} NaN or out of range; numbers from -1 to 1 are allowed")
    return numbers * (TOP_SPEED, TOP_TURN_RATE)


def action_for(kind: str, speed: float, rate: float) -> Any:
    """The action that comes nearest to a command; too fast a command becomes slower on the same arc.

    Args:
        kind: ``"continuous"`` or ``"discrete"``.
        speed: [m/s].
        rate: [rad/s].
    """
    if kind == "discrete":
        return int(np.argmin(np.hypot((COMMANDS[:, 0] - speed) / TOP_SPEED, (COMMANDS[:, 1] - rate) / TOP_TURN_RATE)))
    excess = max(abs(speed) / TOP_SPEED, abs(rate) / TOP_TURN_RATE, 1.0)
    return np.array([speed / TOP_SPEED / excess, rate / TOP_TURN_RATE / excess], np.float32).clip(-1.0, 1.0)


def _show(actions: Any, count: int) -> str:
    """The begin of a refusal: which action is (or actions are) wrong."""
    one = count == 1 and np.ndim(actions) >= 1
    text = repr(actions[0] if one else actions)
    return f"action {text if len(text) < 80 else text[:77] + '...'} is"
