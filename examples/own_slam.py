"""A SLAM estimator of one's own in NumPy: dead reckoning and a map of rays, on which frontier exploration drives."""

import gymnasium as gym
import numpy as np

import lidarena
from lidarena.evaluation import run_episode


class RayMapper:
    """Adds up the odometry; what beams pass is free, where they end is occupied."""

    def __init__(self, lidar):
        self.lidar = lidar

    def reset(self, pose, grid):
        self.pose, self.covariance, self.grid = pose, np.zeros((3, 3)), grid
        self.map = np.full(grid.shape, -1, np.int8)

    def update(self, odometry, scan, time):
        dx, dy, dtheta = odometry
        cos, sin = np.cos(self.pose[2]), np.sin(self.pose[2])
        self.pose = self.pose + np.array([cos * dx - sin * dy, sin * dx + cos * dy, dtheta])
        self.covariance = self.covariance + np.hypot(dx, dy) * np.diag([1e-3, 1e-3, 4e-3])
        away = np.arange(0.0, self.lidar.max_range, 0.5 * self.grid.resolution)[:, None]
        self.mark(*np.broadcast_arrays(away, self.lidar.angles), away < scan - self.grid.resolution, 0)
        self.mark(scan, self.lidar.angles, (scan > 0.0) & (scan < self.lidar.max_range), 100)

    def mark(self, ranges, angles, chosen, value):
        heading = self.pose[2] + angles[chosen]
        points = self.pose[:2] + ranges[chosen][:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
        column, row = np.floor((points - self.grid.origin) / self.grid.resolution).astype(int).T
        inside = (row >= 0) & (column >= 0) & (row < self.map.shape[0]) & (column < self.map.shape[1])
        self.map[row[inside], column[inside]] = value


if __name__ == "__main__":
    env = gym.make("lidarena/Env1-v0", slam=RayMapper, odometry_noise=0.2, max_episode_steps=600)
    episode = run_episode(env, lidarena.baselines.make("frontier", env), seed=0)
    print(f"frontier explored {episode.measures['completeness']:.0%} on the map of RayMapper")
