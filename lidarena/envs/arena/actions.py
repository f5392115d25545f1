"""The arena robot's actions, headings relative to the last one, and the turns they stand for."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.action_parsing import choices_of, shares_of

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
    if kind == "discrete":
        numbers = choices_of(actions, worlds, HEADINGS).astype(np.float64)
        return numbers * (2.0 * math.pi / HEADINGS)
    return math.pi * shares_of(actions, worlds, ("the turn over pi",))[:, 0]


def action_of(space: gym.Space[Any], turn: float) -> Any:
    """The action whose turn is nearest to a wanted one.

    Args:
        space: Of ``heading_space``.
        turn: To the left [rad], any multiple of a full turn more or less.
    """
    if isinstance(space, gym.spaces.Discrete):
        return round(turn * HEADINGS / (2.0 * math.pi)) % HEADINGS
    return np.array([math.remainder(turn, 2.0 * math.pi) / math.pi], np.float32).clip(-1.0, 1.0)
