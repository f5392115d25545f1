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
        needs_success: The same for a policy that does not arrive: only episodes with success have a value, and only
            policies are compared whose share of successes cannot be told from the best.
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
    needs_success: bool = False
    main: bool = False

    @property
    def heading(self) -> str:
        """Title, unit and direction, such as ``"Path (m) ↓"``."""
        arrow = {"high": " ↑", "low": " ↓", None: ""}[self.better]
        return f"{self.title} ({self.unit}){arrow}" if self.unit else f"{self.title}{arrow}"


MEASURES: tuple[Measure, ...] = (
    Measure("completeness", "Explored", "%", 100, better="high", main=True),
    Measure("success", "Success", "%", 100, better="high", share=True, main=True),
    Measure("collision", "Collision", "%", 100, better="low", share=True, main=True),
    Measure("path_length", "Path", "m", 1, "m", "low", needs_coverage=True, main=True),
    Measure("time", "Time", "s", 1, "s", "low", needs_coverage=True, main=True),
    Measure("d_optimality", "D-optimality", "10⁻³", 1000, better="low", needs_coverage=True, main=True),
    Measure("trajectory_error", "Pose error", "cm", 100, "m", "low", needs_coverage=True, main=True),
    Measure("map_iou", "Map IoU", "%", 100, better="high", needs_coverage=True, main=True),
    Measure("path_ratio", "Path over A*'s", better="low", needs_success=True, main=True),
    Measure("least_clearance", "Clearance", "m", 1, "m", "high", needs_success=True, main=True),
    Measure("smoothness", "Turning", "rad/m", 1, "rad/m", "low", needs_success=True, main=True),
    Measure("barn_score", "BARN score", better="high", main=True),
    Measure("arrival", "Robots arrived", "%", 100, better="high", main=True),
    Measure("all_arrived", "All arrived", "%", 100, better="high", share=True, main=True),
    Measure("collided", "Robots collided", "%", 100, better="low", main=True),
    Measure("makespan", "Last arrival", "s", 1, "s", "low", main=True),
    Measure("mean_time", "Mean arrival", "s", 1, "s", "low", main=True),
    Measure("odometry_error", "Odometry error", "cm", 100, "m"),
    Measure("entropy", "Entropy", "nat", 1, "nat"),
    Measure("entropy_gmapping", "gmapping's entropy", "nat", 1, "nat", main=True),
    Measure("return", "Return"),
    Measure("steps", "Steps"),
    Measure("decision_time", "Decision", "ms", 1000, "s", main=True),
)
"""Every measure, in the order of the columns."""

_EVERYWHERE = ("success", "collision", "return", "steps", "decision_time")
FAMILIES: dict[str, frozenset[str]] = {
    "exploration": frozenset(
        {"completeness", "path_length", "time", "d_optimality", "trajectory_error", "map_iou", "odometry_error"}
        | {"entropy", "entropy_gmapping", *_EVERYWHERE}
    ),
    "arena": frozenset({"path_ratio", "least_clearance", "smoothness", "barn_score", *_EVERYWHERE}),
    "corridor": frozenset({"arrival", "all_arrived", "collided", "makespan", "mean_time", "path_length", *_EVERYWHERE}),
}
"""The measures of each family of environments. Teams report their own by name in ``info["measures"]``."""


def names_for(family: str | None) -> frozenset[str]:
    """The measures of a family; those of exploration for an environment of none."""
    return FAMILIES.get(family or "", FAMILIES["exploration"])


BY_NAME = {measure.name: measure for measure in MEASURES}
