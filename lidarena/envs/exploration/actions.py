"""The exploration robot's actions and the commands they stand for."""

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.action_bounds import within_bounds

COMMANDS = np.array([(0.5, 0.0), (0.05, 0.3), (0.05, -0.3)])
"""DA-SLAM's forward, left and right: speed [m/s] and turn rate [rad/s]."""
TOP_SPEED = 0.5
"""Forward speed of the continuous action 1 [m/s]; -1 stands still."""
TOP_TURN_RATE = 1.0
"""Turn rate of the continuous action 1 [rad/s]."""


def action_space(kind: str) -> gym.Space[Any]:
    """``Discrete(3)``, or ``Box(-1, 1, (2,))`` of speed and turn rate."""
    if kind == "discrete":
        return gym.spaces.Discrete(len(COMMANDS))
    return gym.spaces.Box(-1.0, 1.0, (2,), np.float32)


def commands_of(kind: str, actions: Any, worlds: int) -> NDArray[np.float64]:
    """Commands ``(worlds, 2)``, speed [m/s] and turn rate [rad/s], of one action a world.

    Raises:
        ActionError: An action that is NaN, out of range, or of the wrong shape or type.
    """
    values = np.asarray(actions)
    if kind == "discrete":
        if values.shape != (worlds,) or values.dtype.kind not in "iu":
            whole = values.shape == (worlds,) and values.dtype.kind == "f" and np.array_equal(values, values.round())
            hint = "; convert it to an integer" if whole else ""
            raise ActionError(f"action {_show(actions, worlds)} is not one of the whole numbers 0, 1, 2{hint}")
        if ((values < 0) | (values >= len(COMMANDS))).any():
            raise ActionError(
                f"action {_show(actions, worlds)} is out of range; 0 (forward), 1 (left), 2 (right) are allowed"
            )
        commands: NDArray[np.float64] = COMMANDS[values]
        return commands
    if values.shape != (worlds, 2) or values.dtype.kind not in "iuf":
        raise ActionError(
            f"action {_show(actions, worlds)} is not a pair of numbers, speed and turn rate, from -1 to 1"
        )
    numbers = within_bounds(values.astype(np.float64))
    if numbers is None:
        raise ActionError(f"action {_show(actions, worlds)} is NaN or out of range; numbers from -1 to 1 are allowed")
    return np.stack([0.5 * TOP_SPEED * (numbers[:, 0] + 1.0), TOP_TURN_RATE * numbers[:, 1]], axis=1)


def _show(actions: Any, worlds: int) -> str:
    text = repr(actions[0]) if worlds == 1 and np.ndim(actions) >= 1 else repr(actions)
    text = " ".join(text.split())  # NumPy breaks the lines of long arrays
    return text if len(text) < 80 else text[:77] + "..."
