"""Where a robot starts on a floor plan that does not say so: the roomiest place of its largest connected part."""

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.world.raster import CLEARANCE_CAP, Raster

_A_ROOM = 1.0
"""Parts of less free space are nooks that nobody misses [m²]."""


class DefaultStart(NamedTuple):
    """A start that was looked for.

    Attributes:
        place: (2,) x, y [m].
        clearance: Of it, from the nearest surface [m]; 0 where nothing is free.
        parts: Areas of the connected parts that a robot could stand in, the largest first [m²].
    """

    place: NDArray[np.float64]
    clearance: float
    parts: tuple[float, ...]


def find_start(raster: Raster, inside: NDArray[np.bool_], margin: float) -> DefaultStart:
    """Find the place farthest from every surface in the largest connected part of a floor plan.

    Args:
        raster: The plan's.
        inside: (rows, columns) cells where a start may be.
        margin: Clearance that a robot needs [m]: what is connected only by narrower places are two parts.

    Returns:
        The place; of equally roomy ones the first row's first.
    """
    room = inside & ~raster.solid & (raster.clearance >= margin)
    count, labels, statistics, _ = cv2.connectedComponentsWithStats(room.astype(np.uint8), connectivity=4)
    if count < 2:
        return DefaultStart(np.array(raster.origin), 0.0, ())
    cells = statistics[1:, cv2.CC_STAT_AREA]
    clearance = np.where(labels == 1 + int(np.argmax(cells)), _uncapped(raster), 0.0)
    row, column = np.unravel_index(int(np.argmax(clearance)), clearance.shape)
    areas = sorted((float(n) * raster.resolution**2 for n in cells), reverse=True)
    parts = tuple(area for k, area in enumerate(areas) if k == 0 or area >= _A_ROOM)
    place = raster.origin + (np.array([column, row]) + 0.5) * raster.resolution
    return DefaultStart(place, float(clearance[row, column]), parts)


def _uncapped(raster: Raster) -> NDArray[np.float64]:
    """Clearances (rows, columns) that go on where the raster's are cut off; free of steps up to there [m]."""
    roomy = ~raster.solid & (raster.clearance >= CLEARANCE_CAP)
    # beyond the cap what counts is how far the nearest cell below it is; the grid's border is no surface
    framed = np.pad(roomy.astype(np.uint8), 1, constant_values=0 if not roomy.all() else 1)
    beyond = cv2.distanceTransform(framed, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1] * raster.resolution
    return np.where(roomy, CLEARANCE_CAP + beyond, raster.clearance).astype(np.float64)
