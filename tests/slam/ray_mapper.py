"""Estimators of one's own, for the tests: dead reckoning and a map of rays in plain NumPy; good and bad ones."""

from typing import Any

import numpy as np

from lidarena.slam.estimator import MapGrid


class RayMapper:
    """Adds up the odometry; what beams pass is free, where they end is occupied. Cannot be saved."""

    def __init__(self, lidar: Any, drift: float = 1e-3) -> None:
        self.lidar, self.drift = lidar, drift

    def reset(self, pose: np.ndarray, grid: MapGrid) -> None:
        self.pose, self.covariance, self.grid = pose, np.zeros((3, 3)), grid
        self.map = np.full(grid.shape, -1, np.int8)
        self.told: list[tuple[np.ndarray, np.ndarray, float]] = []

    def update(self, odometry: np.ndarray, scan: np.ndarray, time: float) -> None:
        self.told.append((odometry, scan, time))
        dx, dy, dtheta = odometry
        cos, sin = np.cos(self.pose[2]), np.sin(self.pose[2])
        self.pose = self.pose + np.array([cos * dx - sin * dy, sin * dx + cos * dy, dtheta])
        self.covariance = self.covariance + np.hypot(dx, dy) * self.drift * np.eye(3)
        away = np.arange(0.0, self.lidar.max_range, 0.5 * self.grid.resolution)[:, None]
        self.mark(*np.broadcast_arrays(away, self.lidar.angles), away < scan - self.grid.resolution, 0)
        self.mark(scan, self.lidar.angles, (scan > 0.0) & (scan < self.lidar.max_range), 100)

    def mark(self, ranges: np.ndarray, angles: np.ndarray, chosen: np.ndarray, value: int) -> None:
        heading = self.pose[2] + angles[chosen]
        points = self.pose[:2] + ranges[chosen][:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
        column, row = np.floor((points - self.grid.origin) / self.grid.resolution).astype(int).T
        inside = (row >= 0) & (column >= 0) & (row < self.map.shape[0]) & (column < self.map.shape[1])
        self.map[row[inside], column[inside]] = value


class SavedMapper(RayMapper):
    """One that can be saved, and that draws random numbers: it jitters its heading."""

    def reset(self, pose: np.ndarray, grid: MapGrid, rng: np.random.Generator) -> None:  # type: ignore[override]
        super().reset(pose, grid)
        self.rng = rng
        self.bias = rng.normal(0.0, 1e-3)

    def update(self, odometry: np.ndarray, scan: np.ndarray, time: float) -> None:
        super().update(odometry + np.array([0.0, 0.0, self.bias + self.rng.normal(0.0, 1e-3)]), scan, time)

    def get_state(self) -> dict[str, Any]:
        return {"pose": self.pose, "covariance": self.covariance, "map": self.map, "bias": self.bias}

    def set_state(self, state: dict[str, np.ndarray]) -> None:
        self.pose, self.covariance, self.map = state["pose"], state["covariance"], state["map"]
        self.bias = float(state["bias"])


def make_mapper(lidar: Any, drift: float = 1e-3) -> RayMapper:
    """A factory in place of a class."""
    return RayMapper(lidar, drift)
