"""The decisions over the seabed: how many frames to skip, and what to spend."""

from collections.abc import Sequence
from typing import Any, TypeVar

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError, ConfigError
from lidarena.envs.seabed.options import MODES

Number = TypeVar("Number", int, float)


def decision_space(choices: Sequence[Number]) -> gym.spaces.MultiDiscrete:
    """``MultiDiscrete([len(choices), 3])``: number of the skip or overlap, and of the mode."""
    return gym.spaces.MultiDiscrete(np.array([len(choices), len(MODES)]))


def decisions_of(actions: Any, worlds: int, choices: Sequence[Number]) -> list[tuple[Number, str]]:
    """What was chosen, a skip [frames] or an overlap, and the mode of one action a world.

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
    most = len(choices), len(MODES)
    for number, mode in numbers.tolist():
        if not (0 <= number < most[0] and 0 <= mode < most[1]):
            raise ActionError(
                f"action {[number, mode]} is out of range; 0 to {most[0] - 1} for the skip and 0 to {most[1] - 1} for "
                "the mode are allowed"
            )
    return [(choices[number], MODES[mode]) for number, mode in numbers.tolist()]


def longest_skip(skips: Sequence[int], frames: float) -> int:
    """Number of the longest skip of at most so many frames; of the shortest there is, if all are longer."""
    fitting = [number for number, skip in enumerate(skips) if skip <= frames]
    return fitting[-1] if fitting else 0


def action_of(skips: Sequence[int], frames: float, mode: str = MODES[0]) -> NDArray[np.int64]:
    """The action with the longest skip of at most so many frames."""
    return np.array([longest_skip(skips, frames), MODES.index(mode)], np.int64)


def skips_to_choose(env: Any) -> Sequence[int]:
    """The skips among which an environment lets choose.

    Raises:
        ConfigError: Its actions are overlaps.
    """
    options = env.unwrapped.options
    if options.overlaps is not None:
        raise ConfigError("this policy chooses skips, but the environment's actions are overlaps; leave out 'overlaps'")
    skips: Sequence[int] = options.skips
    return skips
