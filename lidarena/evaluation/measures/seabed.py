"""Flights over the seabed: how far the odometry drifts, and what it costs."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.table_columns import SUCCESS, Measure
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Recording
from lidarena.evaluation.trace import RobotTrace

if TYPE_CHECKING:
    from lidarena.evaluation.picture import Picture

_ERROR = Measure("error", "Error of the position", "cm", 100, "m", "low")


class SeabedMeasures(FamilyMeasures):
    """What is measured of a flight; compute is counted, see ``lidarena.envs.seabed.compute``."""

    columns = (
        SUCCESS,
        Measure("error", "Error at the end", "cm", 100, "m", "low", needs="success", main=True),
        Measure("compute", "Compute", "s", 1, "s", "low", needs="success", main=True, plane="across"),
        Measure("drift", "Drift", "% of path", 100, "", "low", needs="success", main=True, plane="up"),
        Measure("mean_error", "Mean error", "cm", 100, "m", "low", needs="success"),
        Measure("path", "Path", "m", 1, "m"),
        Measure("positions", "Positions"),
        Measure("refusals", "Refused", better="low"),
        Measure("nees", "NEES"),
    )
    kept = ("time", "truth.pose", "pose", "truth.error", "truth.path_length", "truth.nees")

    def measure(self, recording: Recording) -> Mapping[str, float]:
        """Error at the end and on the average over positions [m], over the path, NEES of the poses."""
        errors, nees = recording.series("truth.error"), recording.series("truth.nees")
        path = float(recording.info["truth"]["path_length"])
        error = float(errors[-1]) if np.all(recording.info["success"]) else math.nan
        return {
            "error": error,
            "drift": error / path if path > 0.0 else math.nan,
            "mean_error": float(errors.mean()),
            "path": path,
            "nees": float(np.nanmean(nees)) if np.isfinite(nees).any() else math.nan,
        }

    def picture(self, recording: Recording) -> "Picture":
        """True and computed track."""
        return RobotTrace(recording.positions("truth.pose"), estimated=recording.positions("pose"))

    def progress(self, recording: Recording) -> ProgressCurve | None:
        """The error over time: the curves of Bobkov et al.'s Fig. 5."""
        return ProgressCurve.of(_ERROR, recording.series("time"), recording.series("truth.error"))

    def describe(self, values: Mapping[str, float]) -> str:
        """Such as ``"drifted 0.04% at 12.1 s of compute"``."""
        drift = values.get("drift", math.nan)
        return f"drifted {100 * drift:.3f}%" if math.isfinite(drift) else ""


MEASURES = SeabedMeasures()
