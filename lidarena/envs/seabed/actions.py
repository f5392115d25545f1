"""The decisions over the seabed: how many frames to skip, and what to spend."""

from collections.abc import Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.seabed.options import MODES


def decision_space(skips: Sequence[int]) -> gym.spaces.MultiDiscrete:
    """``MultiDiscrete([len(skips), 3])``: number of the skip, and of the mode."""
    return gym.spaces.MultiDiscrete(np.array([len(skips), len(MODES)]))


def decisions_of(actions: Any, worlds: int, skips: Sequence[int]) -> list[tuple[int, str]]:
    """The skip [frames] and the mode of one action a world.

    Raises:
        ActionError: An action that is out of range, or of the wrong shape or type.
    """
    try:
        numbers = np.asarray(actions)
    except ValueError:  # rows of different lengths
        numbers = np.empty(0, object)
    if numbers.shape != (worlds, 2) or numbers.dtype.kind not in "iu":
        shown = repr(actions[0] if worlds == 1 and isinstance(actions, list) and actions else actions)[:80]
        raise ActionError(f"action {shown} is not a pair of whole numbers, of the skip and of the mode")
    most = len(skips), len(MODES)
    for number, mode in numbers.tolist():
        if not (0 <= number < most[0] and 0 <= mode < most[1]):
            raise ActionError(
                f"action {[number, mode]} is out of range; 0 to {most[0] - 1} for the skip and 0 to {most[1] - 1} for "
                "the mode are allowed"
            )
    return [(int(skips[number]), MODES[mode]) for number, mode in numbers.tolist()]


def action_of(skips: Sequence[int], frames: float, mode: str = MODES[0]) -> NDArray[np.int64]:
    """The action with the longest skip of at most so many frames; the shortest there is, if all are longer."""
    fitting = [number for number, skip in enumerate(skips) if skip <= frames]
    return np.array([fitting[-1] if fitting else 0, MODES.index(mode)], np.int64)
