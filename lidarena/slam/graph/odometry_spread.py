"""How far wheels are believed."""

import math

import numpy as np
from numpy.typing import NDArray


def motion_spread(motion: NDArray[np.float64]) -> tuple[float, float]:
    """Standard deviations of a motion (3,) that wheels tell, for shifts [m] and the turn [rad].

    Carpets, sills and slipping wheels make single motions wrong by tens of degrees, so the turn is hardly believed.
    """
    way, turn = math.hypot(motion[0], motion[1]), abs(float(motion[2]))
    return 0.03 + 0.2 * way + 0.1 * min(turn, 1.0), 0.05 + 0.05 * way + 0.4 * turn
