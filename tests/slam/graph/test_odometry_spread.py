"""How far wheels are believed."""

import numpy as np

from lidarena.slam.graph.odometry_spread import motion_spread


def test_longer_motions_are_believed_less() -> None:
    still, short, long, turned = (
        motion_spread(np.array(m)) for m in ([0, 0, 0], [0.1, 0, 0], [1.0, 0, 0], [0, 0, 0.5])
    )
    assert still[0] < short[0] < long[0] and still[1] < turned[1] > 0.2
