"""What exploring is rewarded for: DA-SLAM's two rewards, and the one that wants all at once."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.rewards import ChosenReward, Floats, RewardTerms

if TYPE_CHECKING:
    from lidarena.envs.exploration.state import ExplorationCore

ETA = 1.2e-4
"""η of the uncertainty reward: the median D-optimality of random driving in Env-1 (``benchmarks/eta.py``). DA-SLAM
prints 1, with which every step is worth 2."""
CERTAIN_ENOUGH = 1.3e-4
"""The usual D-optimality of an exploring robot in Env-1 to Env-4."""
USUAL_PATH_PER_AREA = 0.55
"""About what ``frontier`` drives for a square metre of floor plan [1/m]."""
ORDINARY_AREA, LARGEST_AREA = 56.0, 91.0
"""Floor plan in which uncertainty weighs as given, and the one from which on it weighs no more [m²]."""
SIZE_POWER = 1.5
"""Power of the area with which uncertainty weighs more in larger floor plans, in which certainty is lost sooner."""
USUAL_STEPS = 50
"""The mean of D-optimality begins as if it had been the usual one for so many steps; the certain start says little."""

REWARDS = RewardTerms(
    ("completeness", "d_optimality", "path", "uncertainty", "collision"),
    {
        "completeness": {"completeness": 100.0, "collision": 100.0},
        "d_optimality": {"d_optimality": 1.0, "collision": 100.0},
        "combined": {"completeness": 10.0, "path": 1.0, "uncertainty": 1.0, "collision": 10.0},
    },
)
"""See ``ExplorationTerms``. DA-SLAM's r_crashed is -100; with the weights of ``combined`` a whole drive is worth more
than none also in the real buildings."""
_CRASH_REPLACES = ("completeness", "d_optimality")
"""DA-SLAM's presets, in which the step of a crash earns nothing else."""


class ExplorationTerms:
    """The terms of an exploring robot's reward.

    - ``completeness``: the gain in map completeness, from 0 to 1. Times 100 it is DA-SLAM's eq. 2.
    - ``d_optimality``: 1 + tanh(η / D), DA-SLAM's eq. 3.
    - ``path``: -Δs / s_A. s is the path by odometry, s_A = 0.55/m · A what frontier exploration usually drives in a
      floor plan whose walls span the area A.
    - ``uncertainty``: -k_A Δm, k_A = (min(A, 91 m²) / 56 m²)^1.5. m is the mean over the steps of ln max(D, D_0) since
      the start, as if D had been 1.3e-4, its usual value, for 50 steps before. D_0 is the keyword ``certain_enough``:
      with the default, the usual value, waiting where the pose is certain earns nothing, and uncertainty only costs. A
      smaller one rewards every step near the start, also of a robot that stands still: for policies that cannot.
    - ``collision``: -1 in the step of a collision. In DA-SLAM's presets that step earns nothing else.

    Over an episode the terms of ``combined`` (DA-SLAM's future work: the whole map on a short path with a certain pose)
    add up to what a comparison measures, nearly: it takes the true path, and the mean of ln D without the 50 steps. The
    area, which the agent is not told, only weighs.

    Args:
        core: The worlds.
        chosen: What is paid for.
        eta: η [m^(4/3) rad^(2/3)].
        certain_enough: D_0 [m^(4/3) rad^(2/3)].
    """

    def __init__(self, core: "ExplorationCore", chosen: ChosenReward, eta: float, certain_enough: float) -> None:
        self._core, self._chosen, self._eta, self._enough = core, chosen, eta, certain_enough
        worlds = core.worlds
        self._path, self._log_mean = np.zeros(worlds), np.zeros(worlds)
        self._steps = np.zeros(worlds, np.int64)
        self._gain = np.zeros(worlds)
        self._weighing = {
            "completeness": self._completeness,
            "d_optimality": self._certainty,
            "path": self._driven,
            "uncertainty": self._uncertainty,
            "collision": self._collision,
        }

    def begin(self, world: int) -> None:
        """Begin a new episode in a world that has been reset."""
        self._path[world] = self._core.sensors.path_length[world]
        self._log_mean[world] = math.log(max(CERTAIN_ENOUGH, self._enough))
        self._steps[world] = USUAL_STEPS

    def weigh(self, gain: Floats) -> dict[str, Floats]:
        """Return the terms of the step that all worlds have taken, each times its weight, (worlds,).

        Args:
            gain: (worlds,) of completeness.
        """
        self._gain = gain
        terms = {name: self._weighing[name](weight) for name, weight in self._chosen.weights.items()}
        if self._chosen.preset in _CRASH_REPLACES:
            crashed = self._core.sensors.collision
            for name, term in terms.items():
                if name != "collision":
                    term[crashed] = 0.0
        return terms

    def _completeness(self, weight: float) -> Floats:
        return weight * self._gain

    def _certainty(self, weight: float) -> Floats:
        # NumPy's tanh takes another path for the last few of an array: world i would depend on the batch's size
        return weight * np.array([1.0 + math.tanh(self._eta / d) for d in self._core.d_optimality.tolist()])

    def _driven(self, weight: float) -> Floats:
        path = self._core.sensors.path_length
        made: Floats = -weight * (path - self._path) / (USUAL_PATH_PER_AREA * self._core.floors.areas[self._core.plan])
        self._path[:] = path
        return made

    def _uncertainty(self, weight: float) -> Floats:
        size = (np.minimum(self._core.floors.areas[self._core.plan], LARGEST_AREA) / ORDINARY_AREA) ** SIZE_POWER
        self._steps += 1
        log_d = np.array([math.log(max(d, self._enough)) for d in self._core.d_optimality.tolist()])  # as with tanh
        change = (log_d - self._log_mean) / self._steps
        self._log_mean += change
        made: Floats = -weight * size * change
        return made

    def _collision(self, weight: float) -> Floats:
        made = np.zeros(self._core.worlds)
        made[self._core.sensors.collision] = -weight
        return made

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What later rewards depend on, by name; a view, to be written to when a state is loaded."""
        if not {"path", "uncertainty"} & self._chosen.weights.keys():
            return {}
        return {"reward_path": self._path, "reward_log_mean": self._log_mean, "reward_steps": self._steps}
