"""Teams of robots: how many arrived, when, and who collided."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.table_columns import OUTCOME, Measure
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Recording
from lidarena.evaluation.trace import TeamTrace, Walls

ARRIVAL = Measure("arrival", "Robots arrived", "%", 100, better="high", main=True)


class CorridorMeasures(FamilyMeasures):
    """What is measured of a team; robots that never arrive count with the time at which the episode ended."""

    columns = (
        *(replace(column, main=False) for column in OUTCOME),
        Measure("path_length", "Path", "m", 1, "m", "low", needs="arrival", main=True),
        ARRIVAL,
        Measure("all_arrived", "All arrived", "%", 100, better="high", share=True, main=True),
        Measure("collided", "Robots collided", "%", 100, better="low", main=True),
        Measure("makespan", "Last arrival", "s", 1, "s", "low", main=True),
        Measure("mean_time", "Mean arrival", "s", 1, "s", "low", main=True),
    )
    kept = ("time", "success", "pose")

    def measure(self, recording: Recording) -> Mapping[str, float]:
        """See ``columns``; the path is that of all robots together."""
        arrived, time = recording.series("success") > 0, recording.series("time")
        first = np.where(arrived.any(axis=0), arrived.argmax(axis=0), len(time) - 1)
        return {
            "path_length": float(np.sum(recording.info.get("truth", {}).get("path_length", np.nan))),
            "arrival": float(arrived[-1].mean()),
            "all_arrived": float(arrived[-1].all()),
            "collided": float(np.mean(recording.info["collision"])),
            "makespan": float(time[first].max()),
            "mean_time": float(time[first].mean()),
        }

    def picture(self, recording: Recording) -> TeamTrace:
        """The paths of all robots."""
        info = recording.info
        return TeamTrace(
            recording.positions("pose"),
            np.array(info["goal"], np.float64),
            np.array(info["collision"], np.bool_),
            Walls.of(recording.env, "walls"),
        )

    def progress(self, recording: Recording) -> ProgressCurve | None:
        """How many had arrived when."""
        return ProgressCurve.of(ARRIVAL, recording.series("time"), recording.series("success").mean(axis=1))

    def describe(self, values: Mapping[str, float]) -> str:
        """Such as ``"75% of the robots arrived in 41.2 m"``."""
        way = f" in {values['path_length']:.1f} m" if np.isfinite(values.get("path_length", np.nan)) else ""
        return f"{100 * values['arrival']:.0f}% of the robots arrived{way}"


MEASURES = CorridorMeasures()
