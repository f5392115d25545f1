"""What a decision over the seabed is worth."""

from collections.abc import Mapping

import numpy as np

from lidarena.envs.rewards import Floats, RewardTerms

REWARDS = RewardTerms(
    ("drift", "compute", "refused", "progress"),
    {"default": {"drift": 4.0, "compute": 1.0, "refused": 0.05, "progress": 0.0}},
)
"""``drift`` is minus the square of how far the estimate's error has moved in the step [cm²]: errors of steps are
independent, so their squares add up to that of the end. ``compute`` is minus what the step has cost, in units of 0.1 s,
``refused`` -1 where a step was refused, ``progress`` the share of the flight that was covered."""
CENTIMETRES, TENTHS = 100.0, 10.0


def weigh_terms(
    weights: Mapping[str, float], drift: Floats, compute: Floats, refused: Floats, progress: Floats
) -> dict[str, Floats]:
    """Return the terms of the last step, each times its weight, (worlds,).

    Args:
        weights: By term.
        drift: (worlds,) by how much the error has moved [m].
        compute: (worlds,) what the step has cost [s].
        refused: (worlds,) 1 where it was refused.
        progress: (worlds,) share of the flight that was covered.
    """
    values = {
        "drift": -((CENTIMETRES * drift) ** 2),
        "compute": -TENTHS * compute,
        "refused": -refused,
        "progress": progress,
    }
    return {name: weight * values[name] if weight else np.zeros(len(drift)) for name, weight in weights.items()}
