"""A* on a grid of the known arena: what the potential fields are compared with."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.planned_drive import PlannedDrive
from lidarena.baselines.arena.robot_interface import KnownWorld
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.circle_grid import astar_path


@register("astar", family="arena")
class GridSearch(PlannedDrive):
    """Drives along the shortest path on a grid, see :mod:`lidarena.planning.potential_field.circle_grid`."""

    name = "astar"

    def __init__(self, env: Any) -> None:
        """Make it for an arena environment with ``knowledge="map"``."""
        super().__init__(env)

    def plan(self, world: KnownWorld) -> NDArray[np.float64]:
        """A*'s path."""
        path = astar_path(*world.scene, world.radius, world.bounds)
        return path if len(path) else world.pose[None, :2].copy()
