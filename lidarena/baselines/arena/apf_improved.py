"""The improved artificial potential field of Yang et al., planned in the known world."""

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.planned_drive import PlannedDrive
from lidarena.baselines.arena.robot_interface import KnownWorld
from lidarena.baselines.registry import register
from lidarena.planning.potential_field.field_parameters import FieldWarning, field_parameters
from lidarena.planning.potential_field.potential_field import plan_path


@register("apf_improved", family="arena")
class ImprovedField(PlannedDrive):
    """Bounded attraction, goal-aware repulsion, potential filling and regression search, see ``plan_path``.

    Attributes:
        fills: How many fills the plan took.
    """

    name = "apf_improved"

    def __init__(self, env: Any, *, preset: str = "robust", field: Mapping[str, Any] | None = None) -> None:
        """Make it for an arena environment with ``knowledge="map"``.

        Args:
            env: The environment.
            preset: ``"robust"`` (the measured choices) or ``"paper"`` (as printed, misprints corrected).
            field: Attributes of :class:`FieldParameters` over the preset's.

        Raises:
            ConfigError: The preset or an attribute is not known or out of range.
        """
        self._preset, self._field = preset, {"fit_scale": True} | dict(field or {})
        field_parameters(preset, **self._field)
        self.fills = 0
        super().__init__(env)

    def plan(self, world: KnownWorld) -> NDArray[np.float64]:
        """The path after regression search, or as far as the walk came."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FieldWarning)  # a goal close to an obstacle is the arena's, not the user's
            result = plan_path(*world.scene, self._preset, world.radius, world.bounds, **self._field)
        self.fills, self.before = result.fills, result.path
        return result.smoothed if result.success else result.path
