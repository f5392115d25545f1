"""What an odometry's work costs, in seconds of the machine on which it was measured once.

Clocks would make episodes differ from run to run; what is counted instead is what was done. The prices are of
``python benchmarks/seabed_compute.py``.
"""

from lidarena.vision.features import FeatureOptions
from lidarena.vision.odometry import Effort

DETECT_PIXEL = {"tracks": 3.3e-8, "sift": 3.2e-7, "orb": 1.3e-7}
"""Of a pixel of a pair that is looked through for features [s]."""
MATCH_FEATURE = {"tracks": 2.2e-5, "sift": 8.6e-5, "orb": 4.7e-5}
"""Of a feature that is looked for in another pair [s]."""
FIT_MATCH, FIT_MOTION = 5.0e-6, 3.0e-4
"""Of a match that a motion is fitted to, and of each fit besides [s]."""


def detection_cost(features: FeatureOptions, width: int, height: int) -> float:
    """What it costs to find the features of a pair [s].

    Args:
        features: How.
        width: Of each image [pixels].
        height: Of each image [pixels].
    """
    return DETECT_PIXEL[features.kind] * 2 * width * height


def effort_cost(features: FeatureOptions, effort: Effort) -> float:
    """What matching and fitting cost [s]."""
    matching = MATCH_FEATURE[features.kind] * effort.matched
    return matching + FIT_MATCH * effort.fitted + FIT_MOTION * effort.motions
