"""Working together: whether and when everything was done, who was idle, how fluently the two worked."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lidarena.evaluation.gantt import GanttChart
from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.table_columns import OUTCOME, Measure
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Recording

COMPLETION = Measure("completion", "Actions done", "%", 100, better="high", main=True)


class WorkshopMeasures(FamilyMeasures):
    """What is measured of two who share a task; shares are of the makespan, and walking is not idling."""

    columns = (
        *(replace(column, main=False) for column in OUTCOME),
        COMPLETION,
        Measure("makespan", "Makespan", "s", 1, "s", "low", needs="completion", main=True),
        Measure("deadline_met", "Deadline met", "%", 100, better="high", share=True, main=True),
        Measure("human_idle", "Human idle", "%", 100, better="low", main=True),
        Measure("robot_idle", "Robot idle", "%", 100, better="low", main=True),
        Measure("concurrent", "Both active", "%", 100, better="high", main=True),
        Measure("functional_delay", "Functional delay", "%", 100, better="low", main=True),
        Measure("bounds_broken", "Bounds broken", "%", 100, main=True),
        Measure("separation", "Least distance", "m", 1, "m"),
        Measure("stranded", "Without a plan", main=True, better="low"),
        Measure("decision_time", "Decision", "ms", 1000, "s", "low", main=True),
    )
    kept = ("time", "completion")

    def measure(self, recording: Recording) -> Mapping[str, float]:
        """All but one are entries of the last info; ``stranded`` are a policy's decisions without a plan."""
        return {"stranded": float(getattr(recording.policy, "stranded", np.nan))}

    def picture(self, recording: Recording) -> GanttChart | None:
        """Who has done what when."""
        return GanttChart.of(recording)

    def progress(self, recording: Recording) -> ProgressCurve | None:
        """How much was done when."""
        return ProgressCurve.of(COMPLETION, recording.series("time"), recording.series("completion"))

    def describe(self, values: Mapping[str, float]) -> str:
        """Such as ``"done in 84 s"``."""
        done = values.get("completion", 0.0)
        return f"{'done' if done == 1.0 else f'{100 * done:.0f}% done'} in {values['makespan']:.0f} s"


MEASURES = WorkshopMeasures()
