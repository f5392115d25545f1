"""Drives through an arena: how long, how near to the obstacles, how smooth, and BARN's score."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.table_columns import OUTCOME, Measure
from lidarena.evaluation.recording import Recording
from lidarena.evaluation.trace import RobotTrace, Walls
from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.planning.potential_field.regression_search import path_length

_SLOWEST, _FASTEST = 8.0, 2.0
"""BARN counts a drive as if it took at least and at most so many optimal times."""


class ArenaMeasures(FamilyMeasures):
    """What is measured of a drive to a goal; planning counts as part of the first decision."""

    columns = (
        *OUTCOME,
        Measure("path_ratio", "Path over A*'s", better="low", needs="success", main=True),
        Measure("least_clearance", "Clearance", "m", 1, "m", "high", needs="success", main=True),
        Measure("smoothness", "Turning", "rad/m", 1, "rad/m", "low", needs="success", main=True),
        Measure("barn_score", "BARN score", better="high", main=True),
    )
    kept = ("truth.pose", "clearance")

    def measure(self, recording: Recording) -> Mapping[str, float]:
        """See ``measure_drive``."""
        places, clearances = recording.positions("truth.pose"), recording.series("clearance")
        return measure_drive(recording.info, places, clearances.tolist(), recording.decision_times)

    def picture(self, recording: Recording) -> RobotTrace:
        """The path among the obstacles."""
        goal = np.array(recording.info["goal"], np.float64).reshape(1, 2)
        walls, crashed = Walls.of(recording.env, "obstacles", filled=True), recording.ending == "collision"
        return RobotTrace(recording.positions("truth.pose"), walls=walls, goal=goal, crashed=crashed)

    def describe(self, values: Mapping[str, float]) -> str:
        """Such as ``"1.02 × A*'s path"``; empty without success."""
        ratio = values.get("path_ratio", math.nan)
        return f"{ratio:.2f} × A*'s path" if math.isfinite(ratio) else ""


def measure_drive(
    info: Mapping[str, Any],
    places: NDArray[np.float64],
    clearances: Sequence[float],
    decisions: Sequence[float],
) -> dict[str, float]:
    """Measure a finished drive.

    Args:
        info: The last one, with the truth.
        places: (T + 1, 2) true positions [m].
        clearances: Least distance to a surface of each of the T steps, after that of the start [m].
        decisions: Time of each decision, planning included [s].

    Returns:
        ``path_ratio``, the path driven and what was left to the goal, over A*'s path; ``least_clearance``;
        ``smoothness``, all turns over the path; these are NaN without success. ``barn_score``, 0 without success, NaN
        in arenas without an optimal time; ``decision_time``, the mean.
    """
    truth, success = info["truth"], bool(info["success"])
    values = dict.fromkeys(("path_ratio", "least_clearance", "smoothness"), math.nan)
    if success:
        driven = float(truth["path_length"])
        values = {
            "path_ratio": (driven + float(info["distance"])) / _shortest(info, places[0]),
            "least_clearance": float(min(clearances)),
            "smoothness": _turning(places) / driven,
        }
    score = barn_score(success, float(info["time"]), float(truth["optimal_time"]))
    return values | {"barn_score": score, "decision_time": float(np.mean(decisions))}


def barn_score(success: bool, time: float, optimal_time: float) -> float:
    """BARN's score of a drive, at most 0.5: success · OT / clip(T, 2 OT, 8 OT) (Xiao et al. 2022).

    Args:
        success: Whether the goal was reached without a collision.
        time: T, what it took [s].
        optimal_time: OT, the reference path's length over 2 m/s [s]; infinite gives NaN.
    """
    if math.isinf(optimal_time):
        return math.nan
    return success * optimal_time / min(max(time, _FASTEST * optimal_time), _SLOWEST * optimal_time)


def _shortest(info: Mapping[str, Any], start: NDArray[np.float64]) -> float:
    """Length of A*'s path [m]; NaN if it finds none."""
    truth = info["truth"]
    path = astar_path(truth["circles"], start, info["goal"], float(info["radius"]), truth["bounds"])
    return path_length(path) if len(path) else math.nan


def _turning(places: NDArray[np.float64]) -> float:
    """Sum of the angles between one step and the next [rad]."""
    steps = np.diff(places, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turns = (np.diff(headings) + np.pi) % (2.0 * np.pi) - np.pi
    return float(np.abs(turns).sum())


MEASURES = ArenaMeasures()
