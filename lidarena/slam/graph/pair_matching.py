"""Many pairs of scans matched at once."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.slam.graph.point_to_line import add_pair
from lidarena.slam.graph.surface_points import BeamFan, SurfacePoints

PAIR_COLUMNS = 12
"""Numbers that ``add_pair`` gives."""


@leaf
def match_pairs(
    store: SurfacePoints,
    fan: BeamFan,
    scans: NDArray[np.int64],
    motions: NDArray[np.float64],
    nearby: float,
    stride: int,
    systems: NDArray[np.float64],
) -> None:
    """Add for each pair what the second scan says about where it lies, seen from the first.

    Args:
        store: The scans.
        fan: Their beams.
        scans: (P, 2) the pairs.
        motions: (P, 3) pose of the second in the frame of the first.
        nearby: Points farther apart are none of one surface [m].
        stride: Every so manyth beam is used.
        systems: (P, 12) to which is added, as ``add_pair`` has it.
    """
    for p in range(scans.shape[0]):
        add_pair(store, fan, scans[p, 1], scans[p, 0], motions[p], nearby, stride, systems[p])
