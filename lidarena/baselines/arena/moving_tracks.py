"""Where obstacles are and how they move: told by the environment, or made out from one scan to the next."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.seen_obstacles import hits_of
from lidarena.world.lidar import LidarSpec

_SMALL = 0.8
"""What fills more of the view than this [rad] is no disc but a wall, or too near to tell."""
_SLOWEST = 0.15
"""An obstacle that seems slower than this share of the robot's speed stands: a new view of it moves its middle."""
_FASTEST = 2.5
"""Nothing is taken to move faster than so many times the robot's speed between two scans."""


class MovingTracks:
    """Keeps track of the obstacles about one robot.

    Args:
        lidar: Of the robot.
        step: What it drives in a decision [m].
        period: Between two decisions [s].
    """

    def __init__(self, lidar: LidarSpec, step: float, period: float) -> None:
        self._lidar, self._step, self._period = lidar, step, period
        self.forget()

    def forget(self) -> None:
        """Begin a new episode."""
        self._before = np.empty((0, 3))

    def read(self, info: dict[str, Any]) -> NDArray[np.float64]:
        """The obstacles (n, 5) in sight: x, y, what they move in a decision (2,), radius [m].

        Args:
            info: An arena environment's; ``moving`` is taken where it is told, in metres a second, else scans are
                compared. Walls come as the points that beams meet, with radius 0.
        """
        points, beams = hits_of(info, self._lidar)
        standing = np.column_stack([points, np.zeros((len(points), 3))])
        if "moving" in info:
            moving = np.asarray(info["moving"], np.float64).copy()
            moving[:, 2:4] *= self._period
            return np.concatenate([standing, moving])
        discs = self._discs(np.asarray(info["pose"], np.float64), points, beams)
        moving = self._matched(discs)
        self._before = discs
        return np.concatenate([standing, moving])

    def _discs(
        self, pose: NDArray[np.float64], points: NDArray[np.float64], beams: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """What may be discs (n, 3) x, y, radius [m]: runs of beams whose ends lie beside each other."""
        if not len(points):
            return np.empty((0, 3))
        away = np.hypot(*(points - pose[:2]).T)
        apart = np.hypot(*(points - np.roll(points, 1, axis=0)).T)
        wide = 2.0 * self._lidar.increment * np.minimum(away, np.roll(away, 1)) + 0.3 * self._step
        new = (apart > wide) | (np.diff(beams, prepend=beams[-1] - self._lidar.beams) != 1)
        if not new.any():
            return np.empty((0, 3))
        group = np.cumsum(new) % int(new.sum())
        found = []
        for number in range(int(new.sum())):
            mine = np.flatnonzero(group == number)
            half = 0.5 * len(mine) * self._lidar.increment
            if half > _SMALL / 2.0:
                continue
            near = float(away[mine].min())
            radius = near * np.sin(half) / (1.0 - np.sin(half))
            towards = (points[mine] - pose[:2]).mean(axis=0)
            middle = pose[:2] + towards / np.hypot(*towards) * (near + radius)
            found.append((*middle, radius))
        return np.array(found).reshape(-1, 3)

    def _matched(self, discs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Discs that were somewhere else before (n, 5)."""
        if not len(discs) or not len(self._before):
            return np.empty((0, 5))
        shifts = discs[:, None, :2] - self._before[None, :, :2]
        lengths = np.hypot(shifts[..., 0], shifts[..., 1])
        nearest = lengths.argmin(axis=1)
        moved = lengths[np.arange(len(discs)), nearest]
        kept = (moved > _SLOWEST * self._step) & (moved < _FASTEST * self._step)
        velocity = shifts[np.arange(len(discs)), nearest]
        moving: NDArray[np.float64] = np.column_stack([discs[:, :2], velocity, discs[:, 2]])[kept]
        return moving


def times_to_collision(
    place: NDArray[np.float64], velocities: NDArray[np.float64], radius: float, obstacles: NDArray[np.float64]
) -> NDArray[np.float64]:
    """When a disc would first touch an obstacle, for each of its velocities (n,); inf if never.

    Args:
        place: (2,) of the disc [m].
        velocities: (n, 2) to compare [m in a unit of time].
        radius: Of the disc [m].
        obstacles: (m, 5) x, y [m], velocity, radius [m].
    """
    if not len(obstacles):
        return np.full(len(velocities), np.inf)
    away = obstacles[:, :2] - place
    closing = velocities[:, None] - obstacles[None, :, 2:4]  # (n, m, 2)
    reach = radius + obstacles[:, 4]
    speed, along = (closing**2).sum(axis=2), (closing * away).sum(axis=2)
    gap = (away**2).sum(axis=1) - reach**2
    root = along**2 - speed * gap
    meets = (root >= 0.0) & (along > 0.0) & (speed > 0.0)
    times = np.where(meets, (along - np.sqrt(np.maximum(root, 0.0))) / np.maximum(speed, 1e-12), np.inf)
    inside = (gap < 0.0) & (along > 0.0)  # nearer than it should be: any way out is good, none further in
    times = np.where(inside, 0.0, np.where((gap < 0.0), np.inf, times))
    first: NDArray[np.float64] = times.min(axis=1)
    return first
