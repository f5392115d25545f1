"""What is measured of an episode: names, units, and which direction is better."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Measure:
    """One number per episode, and how tables show it.

    Attributes:
        name: Key in `results.json` and `table.csv`; values there are in SI units and fractions.
        title: Column heading, without the unit.
        unit: Shown in the heading, after multiplying by ``scale``; may be empty.
        scale: From the stored value to the shown one, such as 100 for per cent.
        stored_unit: Of `results.json` and `table.csv`; empty for a fraction, a count, or mixed units.
        better: Which direction is better; None where neither is.
        share: Every value is 0 or 1, so the interval is Wilson's.
        needs_coverage: A policy that stops or crashes early gets a small value for nothing, so only those are compared
            whose completeness cannot be told from the best.
        main: In the short tables too, not only in `results.json`, `table.csv` and `table.md`.
    """

    name: str
    title: str
    unit: str = ""
    scale: float = 1.0
    stored_unit: str = ""
    better: Literal["high", "low"] | None = None
    share: bool = False
    needs_coverage: bool = False
    main: bool = False

    @property
    def heading(self) -> str:
        """Title, unit and direction, such as ``"Path (m) ↓"``."""
        arrow = {"high": " ↑", "low": " ↓", None: ""}[self.better]
        return f"{self.title} ({self.unit}){arrow}" if self.unit else f"{self.title}{arrow}"


EXPLORATION: tuple[Measure, ...] = (
    Measure("completeness", "Explored", "%", 100, better="high", main=True),
    Measure("success", "Success", "%", 100, better="high", share=True, main=True),
    Measure("collision", "Collision", "%", 100, better="low", share=True, main=True),
    Measure("path_length", "Path", "m", 1, "m", "low", needs_coverage=True, main=True),
    Measure("time", "Time", "s", 1, "s", "low", needs_coverage=True, main=True),
    Measure("d_optimality", "D-optimality", "10⁻³", 1000, better="low", needs_coverage=True, main=True),
    Measure("trajectory_error", "Pose error", "cm", 100, "m", "low", needs_coverage=True, main=True),
    Measure("map_iou", "Map IoU", "%", 100, better="high", needs_coverage=True, main=True),
    Measure("odometry_error", "Odometry error", "cm", 100, "m"),
    Measure("entropy", "Entropy", "nat", 1, "nat"),
    Measure("entropy_gmapping", "gmapping's entropy", "nat", 1, "nat"),
    Measure("return", "Return"),
    Measure("steps", "Steps"),
    Measure("decision_time", "Decision", "ms", 1000, "s", main=True),
)
"""Of robots that explore; what every environment has in common is here, too."""

TEAM: tuple[Measure, ...] = (
    Measure("arrival", "Robots arrived", "%", 100, better="high", main=True),
    Measure("all_arrived", "All arrived", "%", 100, better="high", share=True, main=True),
    Measure("collided", "Robots collided", "%", 100, better="low", main=True),
    Measure("makespan", "Last arrival", "s", 1, "s", "low", main=True),
    Measure("mean_time", "Mean arrival", "s", 1, "s", "low", main=True),
)
"""Of teams of robots; the environments report these by name in ``info["measures"]``."""

MEASURES = (*EXPLORATION, *TEAM)
"""Every measure, in the order of the columns."""

BY_NAME = {measure.name: measure for measure in MEASURES}
