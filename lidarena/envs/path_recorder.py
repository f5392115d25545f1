"""Where robots have been, for the pictures."""

import numpy as np
from numpy.typing import NDArray


class PathRecorder:
    """Remembers the paths that pictures draw.

    Args:
        worlds: Number of worlds.
    """

    def __init__(self, worlds: int) -> None:
        self._paths: list[list[NDArray[np.float64]]] = [[] for _ in range(worlds)]

    def begin(self, world: int, points: NDArray[np.float64]) -> None:
        """Start one world's paths anew at points (n, 2 or more) [m], of which x and y are kept."""
        self._paths[world] = [points[:, :2].copy()]

    def begun(self, world: int) -> bool:
        """Whether a world has an episode to draw."""
        return bool(self._paths[world])

    def record(self, points: NDArray[np.float64]) -> None:
        """Append where every world's points are now, (worlds, n, 2 or more) [m]."""
        for path, now in zip(self._paths, points, strict=True):
            path.append(now[:, :2].copy())

    def paths(self, world: int) -> NDArray[np.float64]:
        """(n, steps, 2) [m]."""
        return np.stack(self._paths[world], axis=1)
