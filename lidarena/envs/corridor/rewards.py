"""What a step of a robot in a team is worth."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.rewards import Floats, RewardTerms

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from lidarena.envs.corridor.state import CorridorCore

REWARDS = RewardTerms(
    ("progress", "arrival", "collision", "time", "closeness", "turning"),
    {
        "default": {
            "progress": 1.0,
            "arrival": 10.0,
            "collision": 10.0,
            "time": 0.1,
            "closeness": 0.0,
            "turning": 0.0,
        }
    },
)
"""Of a robot on its way: ``progress`` by how many metres the way to its goal became shorter, ``arrival`` 1 on arrival,
``collision`` -1 when it touches something, ``time`` minus the seconds, ``closeness`` minus the seconds times
max(0, 1 - gap / 2 radii) for the gap to the nearest thing that a beam meets, ``turning`` minus the radians turned."""


def weigh_terms(
    core: "CorridorCore",
    weights: "Mapping[str, float]",
    before: Floats,
    active: NDArray[np.bool_],
    touching: NDArray[np.bool_],
    arriving: NDArray[np.bool_],
) -> dict[str, Floats]:
    """Return the terms of the last step, each times its weight, (worlds, robots); zeros of robots that were finished.

    Args:
        core: The worlds.
        weights: By term.
        before: (worlds, robots) lengths of the ways before the step [m].
        active: (worlds, robots) whether a robot was on its way.
        touching: Whether it touches something.
        arriving: Whether it arrives.
    """
    measurements, period = core.measurements, core.options.decision_period
    raw: dict[str, Callable[[], NDArray[Any]]] = {
        "progress": lambda: before - measurements.remaining,
        "arrival": lambda: arriving,
        "collision": lambda: -1.0 * touching,
        "time": lambda: -period * active,
        "closeness": lambda: -period * measurements.closeness,
        "turning": lambda: -period * np.abs(measurements.velocity[..., 1]),
    }
    return {
        name: weight * (raw[name]() * active) if weight else np.zeros(active.shape) for name, weight in weights.items()
    }
