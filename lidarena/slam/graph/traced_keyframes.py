"""An occupancy grid of keyframes that move: a scan is taken back and traced anew where its pose has changed."""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.estimator import MapGrid, ScanSpec
from lidarena.slam.occupancy import empty_maps, trace_scan
from lidarena.slam.scan_outline import empty_outlines

Floats = NDArray[np.float64]

_ENTER, _TAKE_BACK = np.int64(1), np.int64(-1)
_MOVED = np.array([0.01, 0.01, 0.003])
"""A scan is traced anew if its pose has changed by more [m, m, rad]."""


class TracedKeyframes:
    """A grid and the scans that are traced into it.

    Args:
        grid: The grid.
        lidar: What the scans are.

    Attributes:
        occupancy: (rows, columns) int8, -1 unknown, 0 free, 100 occupied; changed in place.
    """

    def __init__(self, grid: MapGrid, lidar: ScanSpec) -> None:
        self._maps = empty_maps(1, np.zeros((1, *grid.shape), np.uint8))
        self._maps.origin[0] = grid.origin
        self._directions = np.stack([np.cos(lidar.angles), np.sin(lidar.angles)])
        self._reach, self._resolution = lidar.max_range, grid.resolution
        self._outlines = empty_outlines(1, grid.shape[0], len(lidar.angles), lidar.max_range, grid.resolution)
        self._scans: list[NDArray[np.float32]] = []
        self._poses: list[Floats] = []
        self.occupancy = self._maps.occupancy[0]

    def add(self, scan: NDArray[np.float32], pose: Floats) -> None:
        """Trace a new scan (beams,) taken at a pose (3,)."""
        self._scans.append(np.array(scan, np.float32))
        self._poses.append(np.array(pose))
        self._trace(len(self._scans) - 1, _ENTER)

    def move(self, poses: Floats) -> None:
        """Trace anew what lies elsewhere; ``poses`` (K, 3) are those of all scans."""
        for k in np.flatnonzero(np.any(np.abs(poses - np.array(self._poses)) > _MOVED, axis=1)).tolist():
            self._trace(k, _TAKE_BACK)
            self._poses[k] = poses[k].copy()
            self._trace(k, _ENTER)

    def _trace(self, k: int, sign: np.int64) -> None:
        trace_scan(
            self._maps, 0, self._resolution, self._poses[k], self._scans[k], self._directions, self._reach, sign,
            self._outlines, 0,
        )  # fmt: skip
