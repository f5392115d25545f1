"""What a robot's sensors say after a motion, and how its beams lie: what every kernel of SLAM is given."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import merged, take_next
from lidarena.world.sensors import Sensing


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


class Share(NamedTuple):
    """The worlds that a thread works through, each of them once whatever the other threads do.

    Attributes:
        counter: (1,) the next world; threads share it, see ``lidarena.base.jit.take_next``.
        last: World after the last.
        thread: Number of the thread.
        active: (worlds,) bool: the others are passed over.
    """

    counter: NDArray[np.int64]
    last: int
    thread: int
    active: NDArray[np.bool_]


@merged
def next_world(share: Share) -> int:
    """The next world of a share that is active; ``share.last`` or more once there is none."""
    w = take_next(share.counter)
    while w < share.last and not share.active[w]:
        w = take_next(share.counter)
    return w


@merged
def reading_of(w: int, sensing: Sensing) -> Reading:
    """What world w's sensors have measured."""
    sensors = sensing.sensors
    return Reading(sensing.period, sensors.readings[w, 0], sensors.scans[w, 0], sensors.fresh[w])
