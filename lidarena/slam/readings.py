"""What a robot's sensors say after a motion, and how its beams lie: what every kernel of SLAM is given."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class ScanGeometry(NamedTuple):
    """How scans and grids are laid out.

    Attributes:
        directions: (2, beams) cos and sin of the beams' angles.
        max_range: Ranges from here on are no returns [m].
        resolution: Side of a grid's cell [m].
    """

    directions: NDArray[np.float64]
    max_range: float
    resolution: float


class Reading(NamedTuple):
    """What is measured after a motion.

    Attributes:
        duration: Of the motion [s].
        motion: (3,) odometry in the robot's frame before the motion.
        scan: (beams,) ranges after it [m].
        fresh: Whether the scan was taken now; an older one is not looked at.
    """

    duration: float
    motion: NDArray[np.float64]
    scan: NDArray[np.float32]
    fresh: bool
