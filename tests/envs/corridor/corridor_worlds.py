"""Teams in worlds of the corridor family, to be looked into."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.options import CorridorOptions

EXACT: dict[str, Any] = {"motion_noise": 0.0, "localization_noise": 0.0, "lidar": {"noise": 0.0}}
"""Wheels obey, and what robots know is true."""


def begin(worlds: int = 1, seed: int = 0, **keywords: Any) -> CorridorEpisodes:
    """Episodes that have begun; world i with a generator of its own."""
    episodes = CorridorEpisodes(worlds, CorridorOptions.checked(keywords))
    episodes.reset(range(worlds), [np.random.default_rng([seed, world]) for world in range(worlds)])
    return episodes


def gaps(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distances (..., k, k) between points (..., k, 2); of a point to itself infinity."""
    away = points[..., :, None, :2] - points[..., None, :, :2]
    distances: NDArray[np.float64] = np.sqrt((away**2).sum(axis=-1))
    distances[..., np.arange(points.shape[-2]), np.arange(points.shape[-2])] = np.inf
    return distances
