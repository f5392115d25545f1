"""Greedy: the robot begins what it can have done soonest."""

from typing import Any

import numpy as np

from lidarena.baselines.registry import register
from lidarena.baselines.workshop.robot_interface import Scheduler, Situation
from lidarena.envs.workshop.task import ROBOT


@register("greedy", family="workshop")
class SoonestDone(Scheduler):
    """Never waits where it may act: of what it may begin it takes what ends first, ways included."""

    def __init__(self, env: Any) -> None:
        """Make it for a workshop environment."""
        super().__init__(env)

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the number of the robot's next action, or of waiting."""
        now = Situation.read(info)
        if not len(now.may):
            return now.wait
        arrays = self.task.arrays
        ways = self.ways_from(ROBOT, now.places[ROBOT])[arrays.stops[now.may, 0]] + arrays.trip[ROBOT, now.may]
        return int(now.may[np.argmin(ways + arrays.lower[ROBOT, now.may])])
