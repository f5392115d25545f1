"""What keeps a robot from driving into what its lidar has shown it: it takes the nearest heading that stays free."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.envs.arena.actions import HEADINGS

SOON = 1.0
"""A heading that leads to contact within so many steps is not driven [steps]: a turn comes with the next one."""
_EXACT = 1e-6
"""A turn so near to a discrete one is that one [headings]."""


@leaf
def guard_turns(free: NDArray[np.float64], turns: NDArray[np.float64]) -> None:
    """Change, in place, turns that lead to contact within ``SOON`` steps into the nearest one that does not.

    Contact is reckoned with what the map has and how discs move, see ``lidarena.envs.arena.known_way``. A turn between
    two of the 16 headings counts as free where both are. Where no heading is free the freest is taken.

    Args:
        free: (W, headings) steps for which each heading stays free, from straight ahead counter-clockwise.
        turns: (W,) to the left [rad], changed.
    """
    width = 2.0 * math.pi / HEADINGS
    for w in range(turns.shape[0]):
        wanted = turns[w] / width
        low, high = math.floor(wanted + _EXACT), math.ceil(wanted - _EXACT)
        if min(free[w, low % HEADINGS], free[w, high % HEADINGS]) >= SOON:
            continue
        best, nearest, freest = 0, math.inf, -1.0
        for k in range(HEADINGS):
            away = abs((k - wanted + 1.5 * HEADINGS) % HEADINGS - 0.5 * HEADINGS)
            room = min(free[w, k], SOON)
            if room > freest or (room == freest and away < nearest):
                best, nearest, freest = k, away, room
        turns[w] = best * width
