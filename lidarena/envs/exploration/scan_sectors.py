"""What observations take of a scan, whatever the lidar: single beams ahead and aside, or the nearest hit by sector."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.world.lidar import LidarSpec

SECTORS = 36
"""Sectors of equal width, the first one centred straight ahead, counter-clockwise."""
FRONT_ANGLES = (0.0, math.pi / 4, math.pi / 2, -math.pi / 4, -math.pi / 2)
"""Where the beams of DA-SLAM's observation point [rad]."""
_ASTRAY = math.pi / 8
"""A beam farther than this from where it should point is none of DA-SLAM's five [rad]."""


def front_beams(lidar: LidarSpec) -> tuple[int, ...]:
    """Numbers of the beams nearest to ``FRONT_ANGLES``.

    Raises:
        ConfigError: The lidar does not see there, or has too few beams.
    """
    beams = tuple(lidar.nearest_beam(angle) for angle in FRONT_ANGLES)
    for beam, angle in zip(beams, FRONT_ANGLES, strict=True):
        if abs((lidar.angles[beam] - angle + math.pi) % (2.0 * math.pi) - math.pi) > _ASTRAY:
            raise ConfigError(
                f"observation 'da_slam' shows a beam at {math.degrees(angle):.0f} degrees, where {_described(lidar)} "
                "has none; take observation='sectors' or 'map'"
            )
    return beams


def sector_angles() -> NDArray[np.float64]:
    """Middles of the sectors (SECTORS,) [rad]."""
    return np.linspace(0.0, 2.0 * math.pi, SECTORS, endpoint=False)


class ScanSectors:
    """Finds the nearest hit of each sector.

    Args:
        lidar: Whose scans they are.

    Raises:
        ConfigError: Its beams are so far apart that sectors would be empty which it sees.
    """

    def __init__(self, lidar: LidarSpec) -> None:
        if lidar.increment > (1.0 + 1e-9) * 2.0 * math.pi / SECTORS:
            raise ConfigError(
                f"observations by sectors of {360 // SECTORS} degrees need a beam in each, but those of "
                f"{_described(lidar)} are {math.degrees(lidar.increment):.1f} degrees apart; take more beams, or "
                "observation='da_slam' or 'map'"
            )
        self._width = lidar.beams // SECTORS if lidar.sees_all_around and lidar.beams % SECTORS == 0 else 0
        degrees = np.round(np.degrees(lidar.angles), 9)  # a beam on the border of two sectors belongs to the left one
        sectors = np.floor((degrees * SECTORS / 360.0) + 0.5).astype(np.int64) % SECTORS
        self._order = np.argsort(sectors, kind="stable")
        self._seen, self._starts = np.unique(sectors[self._order], return_index=True)
        self._far = np.float32(lidar.max_range)

    def nearest_hits(self, scans: NDArray[np.float32]) -> NDArray[np.float32]:
        """The nearest hit of each sector [m], (worlds, SECTORS), in scans (worlds, beams).

        Sectors out of the lidar's view are as a beam without return, at the longest range.
        """
        if self._width:  # beams in equal numbers: a few times faster
            around = np.roll(scans, self._width // 2, axis=1).reshape(len(scans), SECTORS, self._width)
            nearest: NDArray[np.float32] = around.min(axis=2)
            return nearest
        hits = np.full((len(scans), SECTORS), self._far, np.float32)
        hits[:, self._seen] = np.minimum.reduceat(scans[:, self._order], self._starts, axis=1)
        return hits


def _described(lidar: LidarSpec) -> str:
    view = "all around" if lidar.sees_all_around else f"over {math.degrees(lidar.field_of_view):.0f} degrees"
    return f"a lidar of {lidar.beams} beams {view}"
