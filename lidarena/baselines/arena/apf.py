"""The traditional artificial potential field (Khatib): downhill until the goal, an obstacle or a local minimum."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.planned_drive import PlannedDrive
from lidarena.baselines.arena.robot_interface import KnownWorld
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.potential_field import plan_path


@register("apf", family="arena")
class TraditionalField(PlannedDrive):
    """Walks down Khatib's potential (eqs. 1 and 3); finished where the walk is trapped.

    Its lengths, printed for a room of 100 m, are to scale in others.
    """

    name = "apf"
    guarded = False

    def __init__(self, env: Any) -> None:
        """Make it for an arena environment with ``knowledge="map"``."""
        super().__init__(env)

    def plan(self, world: KnownWorld) -> NDArray[np.float64]:
        """The walk down the potential."""
        return plan_path(*world.scene, "traditional", world.radius, world.bounds, fit_scale=True).path
