"""What choosing well is worth: the whole map on a short way, seen from poses that are certain."""

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration.goal_choice.features import USUAL_D
from lidarena.envs.exploration.rewards import USUAL_PATH_PER_AREA
from lidarena.envs.rewards import Floats, RewardTerms

if TYPE_CHECKING:
    from lidarena.envs.exploration.state import ExplorationCore

SECOND = 0.03
"""What a second costs beside the way [m]: turning right round takes ten."""

REWARDS = RewardTerms(
    ("explored", "path", "time", "uncertainty", "collision"),
    {"preference": {"explored": 5.0, "path": 1.0, "time": 1.0, "uncertainty": 1.0, "collision": 5.0}},
)
"""See ``GoalChoiceTerms``."""


class GoalChoiceTerms:
    """The terms of a chooser's reward, added up over the decision periods of its step.

    - ``explored``: the gain in map completeness, from 0 to 1.
    - ``path``: -Δs / s_A; s is the path by odometry, s_A = 0.55/m · A what is usual in a floor plan of the area A.
    - ``time``: -0.03 m/s · Δt / s_A.
    - ``uncertainty``: -(0.05 + 2.5 p) Δc ln(D / 1e-4): p is the preference, Δc the gain in completeness, D the
      D-optimality of the pose from which it was seen. Over an episode it is the mean of ln D over the map: what was
      drawn from an uncertain pose is drawn awry. Only mapping is paid for, so that waiting or circling where the pose
      is certain earns nothing and costs way and time.
    - ``collision``: -1 in the step of a collision.

    Args:
        core: The worlds.
    """

    def __init__(self, core: "ExplorationCore") -> None:
        self._core = core
        self._path, self._completeness = np.zeros(core.worlds), np.zeros(core.worlds)

    def begin(self, world: int) -> None:
        """Begin a new episode in a world that has been reset."""
        self._path[world] = self._core.sensors.path_length[world]
        self._completeness[world] = self._core.completeness[world]

    def log_d(self) -> Floats:
        """Return ln of every world's D-optimality."""
        return np.array([math.log(max(d, 1e-9)) for d in self._core.d_optimality.tolist()])

    def weigh(self, preference: Floats, period: float, active: NDArray[np.bool_]) -> dict[str, Floats]:
        """Return the terms of the period that the active worlds have driven, each of weight 1, (worlds,)."""
        core = self._core
        usual = USUAL_PATH_PER_AREA * core.floors.areas[core.plan]
        gain = np.where(active, core.completeness - self._completeness, 0.0)
        path = np.where(active, core.sensors.path_length - self._path, 0.0)
        self._completeness += gain
        self._path += path
        return {
            "explored": gain,
            "path": -path / usual,
            "time": np.where(active, -SECOND * period / usual, 0.0),
            "uncertainty": -(0.05 + 2.5 * preference) * gain * (self.log_d() - math.log(USUAL_D)),
            "collision": np.where(active & core.sensors.collision, -1.0, 0.0),
        }

    def arrays(self) -> dict[str, Floats]:
        """What later rewards depend on, by name; views, to be written to when a state is loaded."""
        return {"paid_path": self._path, "paid_completeness": self._completeness}
