"""A potential field that A*'s path leads: what Yang et al. announce as future work."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.planned_drive import PlannedDrive
from lidarena.baselines.arena.robot_interface import KnownWorld
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.guided_field import plan_guided_path


@register("apf_global", family="arena")
class GuidedField(PlannedDrive):
    """Smooth and without traps, see :mod:`lidarena.planning.potential_field.guided_field`."""

    name = "apf_global"

    def __init__(self, env: Any) -> None:
        """Make it for an arena environment with ``knowledge="map"``."""
        super().__init__(env)

    def plan(self, world: KnownWorld) -> NDArray[np.float64]:
        """The smooth path."""
        return plan_guided_path(*world.scene, world.radius, world.bounds).path
