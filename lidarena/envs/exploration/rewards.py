"""What exploring is rewarded for: DA-SLAM's two rewards, and the one that wants all at once."""

import math
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration.options import CERTAIN_ENOUGH, ExplorationOptions
from lidarena.envs.exploration.state import ExplorationCore

Floats = NDArray[np.float64]

CRASH_REWARD = -100.0
"""DA-SLAM's r_crashed."""
USUAL_PATH_PER_AREA = 0.55
"""About what ``frontier`` drives for a square metre of floor plan [1/m]."""
ORDINARY_AREA, LARGEST_AREA = 56.0, 91.0
"""Floor plan in which uncertainty weighs as given, and the one from which on it weighs no more [m²]."""
SIZE_POWER = 1.5
"""Power of the area with which uncertainty weighs more in larger floor plans, in which certainty is lost sooner."""
USUAL_STEPS = 50
"""The mean of D-optimality begins as if it had been the usual one for so many steps; the certain start says little."""


class Reward(Protocol):
    """Rewards the steps of a batch; ``terms`` are those of the last step by name, (worlds,) each."""

    terms: dict[str, Floats]

    def begin(self, world: int) -> None:
        """Begin a new episode in a world that has been reset."""

    def grade(self, gain: Floats) -> Floats:
        """Grade the step that all worlds have taken, (worlds,); ``gain`` (worlds,) is that of completeness."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What later rewards depend on, by name; a view, to be written to when a state is loaded."""


class CompletenessReward:
    """DA-SLAM's eq. 2: -100 for a crash, or else the gain in completeness in percentage points."""

    def __init__(self, core: ExplorationCore) -> None:
        self._core = core
        self.terms = {name: np.zeros(core.worlds) for name in ("completeness", "collision")}

    def begin(self, world: int) -> None:
        """Begin a new episode."""
        _clear(self.terms, world)

    def grade(self, gain: Floats) -> Floats:
        """Grade a step."""
        self.terms = _crash_or(self._core, "completeness", 100.0 * gain)
        return self.terms["completeness"] + self.terms["collision"]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Nothing."""
        return {}


class UncertaintyReward:
    """DA-SLAM's eq. 3: -100 for a crash, or else 1 + tanh(η / D)."""

    def __init__(self, core: ExplorationCore, eta: float) -> None:
        self._core, self._eta = core, eta
        self.terms = {name: np.zeros(core.worlds) for name in ("d_optimality", "collision")}

    def begin(self, world: int) -> None:
        """Begin a new episode."""
        _clear(self.terms, world)

    def grade(self, gain: Floats) -> Floats:
        """Grade a step."""
        # NumPy's tanh takes another path for the last few of an array: world i would depend on the batch's size
        certain = np.array([1.0 + math.tanh(self._eta / d) for d in self._core.d_optimality.tolist()])
        self.terms = _crash_or(self._core, "d_optimality", certain)
        return self.terms["d_optimality"] + self.terms["collision"]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Nothing."""
        return {}


class CombinedReward:
    """The whole map on a short path with a certain pose (DA-SLAM's future work).

    r = w_completeness Δc - w_path Δs / s_A - w_uncertainty k_A Δm - w_collision · collision

    c is the completeness, s the path by odometry, s_A = 0.55/m · A what frontier exploration usually drives in a floor
    plan whose walls span the area A, and k_A = (min(A, 91 m²) / 56 m²)^1.5. m is the mean over the steps of
    ln max(D, D_0) since the start, as if D had been 1.3e-4, its usual value, for 50 steps before. D_0 is the keyword
    ``certain_enough``: with the default, the usual value, waiting where the pose is certain earns nothing, and
    uncertainty only costs. A smaller one rewards every step near the start, also of a robot that stands still: for
    policies that cannot.

    Over an episode the terms add up to what a comparison measures (nearly: it takes the true path, and the mean of ln D
    without the 50 steps). The area, which the agent is not told, only weighs; with ``observation="da_slam"`` the agent
    is told the completeness, with ``"map"`` the covariance, too.

    Args:
        core: The worlds.
        weights: By name: ``completeness``, ``path``, ``uncertainty``, ``collision``.
        certain_enough: D_0 [m^(4/3) rad^(2/3)].
    """

    def __init__(self, core: ExplorationCore, weights: Mapping[str, float], certain_enough: float) -> None:
        self._core, self._weights, self._enough = core, dict(weights), certain_enough
        worlds = core.worlds
        self._path, self._log_mean = np.zeros(worlds), np.zeros(worlds)
        self._steps = np.zeros(worlds, np.int64)
        self.terms = {name: np.zeros(worlds) for name in self._weights}

    def begin(self, world: int) -> None:
        """Begin a new episode."""
        self._path[world] = self._core.sensors.path_length[world]
        self._log_mean[world] = math.log(max(CERTAIN_ENOUGH, self._enough))
        self._steps[world] = USUAL_STEPS
        _clear(self.terms, world)

    def grade(self, gain: Floats) -> Floats:
        """Grade a step."""
        core, weights = self._core, self._weights
        area, path = core.floors.areas[core.plan], core.sensors.path_length
        size = (np.minimum(area, LARGEST_AREA) / ORDINARY_AREA) ** SIZE_POWER
        self._steps += 1
        log_d = np.array([math.log(max(d, self._enough)) for d in core.d_optimality.tolist()])  # as with tanh above
        change = (log_d - self._log_mean) / self._steps
        self.terms = {
            "completeness": weights["completeness"] * gain,
            "path": -weights["path"] * (path - self._path) / (USUAL_PATH_PER_AREA * area),
            "uncertainty": -weights["uncertainty"] * size * change,
            "collision": np.where(core.sensors.collision, -weights["collision"], 0.0),
        }
        self._path[:] = path
        self._log_mean += change
        total = self.terms["completeness"] + self.terms["path"]
        return total + self.terms["uncertainty"] + self.terms["collision"]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The path so far, and the mean."""
        return {"reward_path": self._path, "reward_log_mean": self._log_mean, "reward_steps": self._steps}


def make_reward(core: ExplorationCore, options: ExplorationOptions) -> Reward:
    """Make what the keyword ``reward`` names."""
    if options.reward == "combined":
        return CombinedReward(core, options.combined_weights, options.certain_enough)
    return UncertaintyReward(core, options.eta) if options.reward == "d_optimality" else CompletenessReward(core)


def _crash_or(core: ExplorationCore, name: str, gain: Floats) -> dict[str, Floats]:
    """The terms of a reward of DA-SLAM: a gain, or in its place the crash."""
    alive = ~core.sensors.collision
    return {name: np.where(alive, gain, 0.0), "collision": np.where(alive, 0.0, CRASH_REWARD)}


def _clear(terms: dict[str, Floats], world: int) -> None:
    for term in terms.values():
        term[world] = 0.0
