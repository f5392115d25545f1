"""Actions as users give them, read into arrays or refused in one sentence."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ActionError
from lidarena.envs.action_bounds import within_bounds

_LONGEST = 80
"""Characters of an action in a message."""


def choices_of(actions: Any, count: int, known: int, names: Sequence[str] = ()) -> NDArray[np.int64]:
    """The numbers of discrete actions, (count,).

    Args:
        actions: One for each of ``count`` robots.
        count: How many robots act.
        known: How many actions there are.
        names: What they are called, if they have names.

    Raises:
        ActionError: Something else than whole numbers from 0 to ``known`` - 1.
    """
    values = _array_of(actions)
    if values.shape != (count,) or values.dtype.kind not in "iu":
        whole = values.shape == (count,) and values.dtype.kind == "f" and np.array_equal(values, values.round())
        hint = "; convert it to an integer" if whole else ""
        raise ActionError(f"action {_shown(actions, count)} is not one of the whole numbers 0 to {known - 1}{hint}")
    numbers = values.astype(np.int64, copy=False)
    if numbers.view(np.uint64).max() >= known:  # as which negative ones are large
        words = ", ".join(f"{number} ({name})" for number, name in enumerate(names[:known])) or f"0 to {known - 1}"
        raise ActionError(f"action {_shown(actions, count)} is out of range; {words} are allowed")
    return numbers


def shares_of(actions: Any, count: int, parts: Sequence[str]) -> NDArray[np.float64]:
    """The numbers from -1 to 1 of continuous actions, (count, parts).

    Args:
        actions: One for each of ``count`` robots.
        count: How many robots act.
        parts: What each number of an action stands for.

    Raises:
        ActionError: Another shape or type, NaN, or a number out of range.
    """
    values = _array_of(actions)
    if values.shape != (count, len(parts)) or values.dtype.kind not in "iuf":
        what = {1: "an array of one number", 2: "a pair of numbers"}.get(
            len(parts), f"an array of {len(parts)} numbers"
        )
        raise ActionError(f"action {_shown(actions, count)} is not {what}, {' and '.join(parts)}, from -1 to 1")
    numbers = within_bounds(values.astype(np.float64))
    if numbers is None:
        allowed = "a number from -1 to 1 is" if len(parts) == 1 else "numbers from -1 to 1 are"
        raise ActionError(f"action {_shown(actions, count)} is NaN or out of range; {allowed} allowed")
    return numbers


def _array_of(actions: Any) -> NDArray[Any]:
    try:
        return np.asarray(actions)
    except ValueError:  # rows of different lengths
        return np.empty(0, object)


def _shown(actions: Any, count: int) -> str:
    """The action, or all of them, in one line."""
    text = repr(actions[0]) if count == 1 and np.ndim(actions) >= 1 else repr(actions)
    text = " ".join(text.split())  # NumPy breaks the lines of long arrays
    return text if len(text) < _LONGEST else text[: _LONGEST - 3] + "..."
