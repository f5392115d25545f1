"""How far robots deviate from their planned paths: Bennewitz & Burgard's Fig. 2, learned from runs (section 2)."""

import json
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import ConfigError
from lidarena.base.files import write_text

MODEL_FILE = Path(__file__).parent / "data" / "deviation.json"
"""The model that comes with the package; ``python -m lidarena.baselines.corridor.learn_deviation`` learns it anew."""
BIN = 0.02
"""Width of the distance ranges that are counted [m]."""
WEIGHT = 40.0
"""What touching another robot is worth, in steps of a plan."""
_ENDS = (0.03, 0.07, 0.12, 0.2, 0.4, 0.8)
"""Where the linear pieces end [m]; the last one ends with the distances."""
_DIRECTIONS, _RADII = 32, 40
_LARGEST = 64.0  # the planner's greatest cost of a step


@dataclass(frozen=True)
class DeviationModel:
    """The distribution of a robot's distance from where it is planned to be.

    Attributes:
        counts: (n,) how often the distance fell into each range of ``BIN`` metres.
        knots: (m, 2) distance [m] and probability density [1/m], linear in between: few pieces, against over-fitting.
        runs: Executions that were recorded.
    """

    counts: NDArray[np.int64]
    knots: NDArray[np.float64]
    runs: int

    @classmethod
    def fitted(cls, distances: ArrayLike, runs: int) -> "DeviationModel":
        """Fit linear pieces to recorded distances.

        Args:
            distances: (n,) [m].
            runs: Executions that they come from.

        Raises:
            ConfigError: There are no distances.
        """
        values = np.asarray(distances, np.float64)
        if values.size < 2 or not np.isfinite(values).all():
            raise ConfigError(f"{values.size} recorded distances are too few for a deviation model")
        counts = np.bincount((values / BIN).astype(np.int64))
        end = len(counts) * BIN
        at = np.array([0.0, *(knot for knot in _ENDS if knot < end), end])
        return cls(counts, np.stack([at, _least_squares(at, counts / (counts.sum() * BIN))], axis=1), runs)

    def density(self, distance: ArrayLike) -> NDArray[np.float64]:
        """Probability density [1/m] of distances [m]."""
        return np.interp(np.asarray(distance, np.float64), self.knots[:, 0], self.knots[:, 1], right=0.0)

    def risk(self, gap: float, reach: float) -> float:
        """The probability that a robot deviates to within ``reach`` of a point, all directions being as likely.

        Args:
            gap: Distance of the point from where the robot is planned to be [m].
            reach: Distance at which the two touch: the sum of their radii [m].
        """
        radii = (np.arange(_RADII) + 0.5) / _RADII * self.knots[-1, 0]
        weights = self.density(radii)
        angles = (np.arange(_DIRECTIONS) + 0.5) * (2.0 * np.pi / _DIRECTIONS)
        away = np.hypot(gap - radii[:, None] * np.cos(angles), radii[:, None] * np.sin(angles))
        return float(weights @ (away < reach).mean(axis=1) / weights.sum())

    def costs(self, cell: float, reach: float, weight: float = WEIGHT) -> NDArray[np.float64]:
        """What it costs to be near where a robot is planned to be, as ``plan_team`` takes it for ``deviation``.

        Bennewitz & Burgard's P_t of a robot that is a disc: the probability to touch it, times what a touch is worth.

        Args:
            cell: Side of the cells [m].
            reach: Sum of the two radii [m].
            weight: What touching is worth [steps].

        Returns:
            (m, 2) distance [cells] and cost [steps].
        """
        gaps = np.arange(0.0, self.knots[-1, 0] + reach + cell, 0.5 * cell)
        table = np.array([(gap / cell, min(weight * self.risk(float(gap), reach), _LARGEST)) for gap in gaps])
        table[-1, 1] = 0.0
        return table

    def save(self, path: Path) -> None:
        """Write the model as JSON."""
        content = {"runs": self.runs, "bin": BIN, "counts": self.counts.tolist(), "knots": self.knots.tolist()}
        write_text(path, json.dumps(content, indent=1) + "\n")

    @classmethod
    def load(cls, path: Path) -> "DeviationModel":
        """Read a model.

        Raises:
            ConfigError: The file is missing or torn.
        """
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
            return cls(np.array(content["counts"], np.int64), np.array(content["knots"], float), int(content["runs"]))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ConfigError(f"{str(path)!r} is no deviation model: {error}") from error


@lru_cache(maxsize=1)
def shipped_model() -> DeviationModel:
    """The model that comes with the package."""
    return DeviationModel.load(MODEL_FILE)


def _least_squares(at: NDArray[np.float64], heights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Heights of linear pieces with ends ``at`` that fit a histogram of ranges of ``BIN``; not negative, area 1."""
    centres = (np.arange(len(heights)) + 0.5) * BIN
    basis = np.stack([np.interp(centres, at, row) for row in np.eye(len(at))], axis=1)
    fit = np.linalg.lstsq(basis, heights, rcond=None)[0]
    fit = np.maximum(fit, 0.0)
    fit[-1] = 0.0
    area = float(np.sum(0.5 * (fit[1:] + fit[:-1]) * np.diff(at)))
    result: NDArray[np.float64] = fit / area
    return result
