"""The arena robot's actions, headings relative to the last one, and the turns they stand for."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.action_bounds import within_bounds

HEADINGS = 16
"""Of the discrete actions; number k turns by k · 22.5 degrees to the left."""


def heading_space(kind: str) -> gym.Space[Any]:
    """``Discrete(16)``, or ``Box(-1, 1, (1,))`` of the turn over π."""
    if kind == "discrete":
        return gym.spaces.Discrete(HEADINGS)
    return gym.spaces.Box(-1.0, 1.0, (1,), np.float32)


def turns_of(kind: str, actions: Any, worlds: int) -> NDArray[np.float64]:
    """Turns ``(worlds,)`` to the left [rad] of one action a world.

    Raises:
        ActionError: An action that is NaN, out of range, or of the wrong shape or type.
    """
    values = np.asarray(actions)
    if kind == "discrete":
        if values.shape != (worlds,) or values.dtype.kind not in "iu":
            raise ActionError(f"action {_show(actions, worlds)} is not one of the whole numbers 0 to {HEADINGS - 1}")
        if ((values < 0) | (values >= HEADINGS)).any():
            raise ActionError(f"action {_show(actions, worlds)} is out of range; 0 to {HEADINGS - 1} are allowed")
        return values * (2.0 * math.pi / HEADINGS)
    if values.shape != (worlds, 1) or values.dtype.kind not in "iuf":
        raise ActionError(
            f"action {_show(actions, worlds)} is not an array of one number, the turn over pi, from -1 to 1"
        )
    numbers = within_bounds(values[:, 0].astype(np.float64))
    if numbers is None:
        raise ActionError(f"action {_show(actions, worlds)} is NaN or out of range; a number from -1 to 1 is allowed")
    return math.pi * numbers


def action_of(space: gym.Space[Any], turn: float) -> Any:
    """The action whose turn is nearest to a wanted one.

    Args:
        space: Of ``heading_space``.
        turn: To the left [rad], any multiple of a full turn more or less.
    """
    if isinstance(space, gym.spaces.Discrete):
        return round(turn * HEADINGS / (2.0 * math.pi)) % HEADINGS
    return np.array([math.remainder(turn, 2.0 * math.pi) / math.pi], np.float32).clip(-1.0, 1.0)


def _show(actions: Any, worlds: int) -> str:
    text = repr(actions[0]) if worlds == 1 and np.ndim(actions) >= 1 else repr(actions)
    return text if len(text) < 80 else text[:77] + "..."
