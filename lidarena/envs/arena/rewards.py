"""What a step in an arena is worth."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.rewards import Floats, RewardTerms

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from lidarena.envs.arena.state import ArenaCore

REWARDS = RewardTerms(
    ("progress", "success", "collision", "time", "clearance", "turn", "way"),
    {
        "default": {
            "progress": 1.0,
            "success": 10.0,
            "collision": 10.0,
            "time": 0.1,
            "clearance": 0.0,
            "turn": 0.0,
            "way": 0.0,
        }
    },
)
"""``progress`` is the approach to the goal over the length of a step, ``success`` 1 once, ``collision`` -1 once,
``time`` -1 each step, ``clearance`` from 0 at two steps' length from the nearest surface to -1 at contact, ``turn`` -1
for half a turn, ``way`` the approach, over the length of a step, to the lookahead point of the way through what the
robot had seen before the step: on an unchanged map never more than what the way gets shorter by, so that neither
driving in circles nor finding out that the way is longer pays anything."""


def weigh_terms(
    core: "ArenaCore", weights: "Mapping[str, float]", before: Floats, success: NDArray[np.bool_]
) -> dict[str, Floats]:
    """Return the terms of the last step, each times its weight, (worlds,).

    Only additions and products, which no vector unit rounds otherwise.

    Args:
        core: The worlds.
        weights: By term.
        before: (worlds,) distances to the goal before the step [m].
        success: (worlds,) whether the goal is reached.
    """
    values: dict[str, Callable[[], Floats]] = {
        "progress": lambda: (before - core.measurements.distance) / core.step_length,
        "success": lambda: success.astype(np.float64),
        "collision": lambda: -core.physics.touched.astype(np.float64),
        "time": lambda: -np.ones(core.worlds),
        "clearance": lambda: (core.measurements.gap / core.approach).clip(0.0, 1.0) - 1.0,
        "turn": lambda: -np.abs(core.turns - 2.0 * np.pi * np.rint(core.turns / (2.0 * np.pi))) / np.pi,
        "way": lambda: core.approaches / core.step_length,
    }
    return {term: weight * values[term]() if weight else np.zeros(core.worlds) for term, weight in weights.items()}
