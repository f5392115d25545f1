"""Explorations: how much was mapped, on which way, how certain, and how right the final map is."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.exploration.coverage import measure_coverage
from lidarena.envs.exploration.options import ROBOT as DA_SLAM_ROBOT
from lidarena.envs.registration import owner_of
from lidarena.evaluation.measures.family_measures import FamilyMeasures
from lidarena.evaluation.measures.over_path import explored_over_path, geometric_mean_over_path, path_at
from lidarena.evaluation.measures.table_columns import COLLISION, SUCCESS, Measure
from lidarena.evaluation.progress_curve import ProgressCurve
from lidarena.evaluation.recording import Recording
from lidarena.evaluation.statistics import geometric_mean
from lidarena.evaluation.trace import BelievedMap, RobotTrace, Walls
from lidarena.world.floorplan import Floorplan
from lidarena.world.robots import RobotSpec

EXPLORED = 0.99
"""Completeness that counts as success of an exploration, however its episode ended but by a collision."""
COMPLETENESS = Measure("completeness", "Explored", "%", 100, better="high", main=True)
_WITHIN_ONE = np.ones((3, 3), np.uint8)


class ExplorationMeasures(FamilyMeasures):
    """What is measured of an exploration; its ending may also be ``out of patience``: nothing new for too long.

    D is the D-optimality of the covariance that SLAM tells, det(Σ)^(1/3) (Carrillo et al. 2012), and s the true path:

    - ``d_optimality`` ("per second"): geometric mean of D over the time of the episode, exp(Σ ln D_k / n) over its n
      steps, which all take equally long. A policy lowers it by waiting where it is certain.
    - ``d_optimality_per_metre``: geometric mean of D over the path, exp(Σ ln D_k Δs_k / Σ Δs_k), see
      ``over_path.geometric_mean_over_path``. Standing still and turning on the spot count for nothing.
    - ``path_at_95``, ``path_at_99``: path at which 95% and 99% were explored for the first time. Episodes that never
      came so far have none; ``reached_95`` and ``reached_99`` tell the share of those that did.
    - ``explored_over_path``: area under completeness over path, over the length up to which it is taken, one metre for
      each square metre of what there is to explore; what was explored in the end counts on from where the path ends.
    """

    columns = (
        COMPLETENESS,
        replace(SUCCESS, main=False),
        replace(COLLISION, title="Collisions"),
        Measure(
            *("path_length", "Path", "m", 1, "m", "low"),
            needs="completeness",
            main=True,
            plane="across",
            hint="distance driven until everything was explored",
        ),
        Measure("time", "Time", "s", 1, "s", "low", needs="completeness", main=True),
        Measure(
            *("d_optimality_per_metre", "D-optimality per metre", "10⁻³", 1000),
            better="low",
            needs="completeness",
            main=True,
            plane="up",
            hint="how uncertain the robot was of its pose while driving",
        ),
        Measure("trajectory_error", "Pose error", "cm", 100, "m", "low", needs="completeness", main=True),
        Measure("d_optimality", "D-optimality per second", "10⁻³", 1000, better="low", needs="completeness"),
        Measure("map_iou", "Map IoU", "%", 100, better="high", needs="completeness"),
        Measure("reached_95", "Reached 95%", "%", 100, better="high", share=True),
        Measure("path_at_95", "Path at 95%", "m", 1, "m", "low", needs="reached_95"),
        Measure("reached_99", "Reached 99%", "%", 100, better="high", share=True),
        Measure("path_at_99", "Path at 99%", "m", 1, "m", "low", needs="reached_99"),
        Measure("explored_over_path", "Explored over path", "%", 100, better="high"),
        Measure("odometry_error", "Odometry error", "cm", 100, "m"),
        Measure("entropy", "Entropy", "nat", 1, "nat"),
        Measure("entropy_gmapping", "gmapping's entropy", "nat", 1, "nat"),
    )
    kept = (
        *("time", "completeness", "d_optimality", "entropy", "entropy_gmapping"),
        *("truth.pose", "truth.path_length", "pose", "odometry_pose"),
    )

    def ending(self, recording: Recording) -> str:
        """As of every environment, but for what ran out of ``patience`` before it ran out of steps.

        Explorers tell why they have finished: nothing is left, what is left is out of reach, or the map hardly grows.
        """
        ending = super().ending(recording)
        patience = getattr(getattr(recording.env.unwrapped, "options", None), "patience", None)
        if ending == "out of time" and patience is not None and recording.steps < recording.step_limit:
            return "out of patience"
        why = getattr(recording.policy, "ending", "") if ending == "policy finished" else ""
        return f"{ending}: {why}" if why else ending

    def measure(self, recording: Recording) -> Mapping[str, float]:
        """See the class; what is not said there is a mean over the steps."""
        path, explored = recording.series("truth.path_length"), recording.series("completeness")
        values = {
            "path_length": float(path[-1]),
            "d_optimality": float(geometric_mean(recording.steps_of("d_optimality"))),
            "d_optimality_per_metre": geometric_mean_over_path(recording.series("d_optimality")[1:], path),
            "trajectory_error": _position_error(recording, "pose"),
            "odometry_error": _position_error(recording, "odometry_pose"),
            "map_iou": _map_quality(recording),
            "explored_over_path": explored_over_path(explored, path, _area_to_explore(recording)),
        }
        values |= {name: float(np.mean(recording.steps_of(name))) for name in ("entropy", "entropy_gmapping")}
        for percent in (95, 99):
            way = path_at(percent / 100, explored, path)
            values |= {f"path_at_{percent}": way, f"reached_{percent}": float(np.max(explored) >= percent / 100)}
        if recording.ending != "collision":  # also where no completeness ends an episode
            values["success"] = float(recording.ending == "success" or explored[-1] >= EXPLORED)
        return values

    def picture(self, recording: Recording) -> RobotTrace | None:
        """The believed map on the true walls, both paths, and the policy's graph if it keeps one."""
        true, estimated = (known(recording.positions(name)) for name in ("truth.pose", "pose"))
        if not len(true) + len(estimated):
            return None
        if np.array_equal(true, estimated):  # the pose is known: there is no belief to draw beside it
            estimated = np.empty((0, 2))
        graph = getattr(recording.policy, "graph", None)
        nodes = np.array(graph.positions if graph is not None else [], np.float64).reshape(-1, 2)
        links = np.array(sorted(graph.edges if graph is not None else []), np.int64).reshape(-1, 2)
        return RobotTrace(
            true,
            estimated,
            Walls.of(recording.env),
            _believed(recording.info),
            nodes,
            links,
            crashed=recording.ending == "collision",
        )

    def progress(self, recording: Recording) -> ProgressCurve | None:
        """How much was explored when."""
        return ProgressCurve.of(COMPLETENESS, recording.series("time"), recording.series("completeness"))

    def describe(self, values: Mapping[str, float]) -> str:
        """Such as ``"explored 97% in 31.2 m, 105 s"``."""
        explored = values.get("completeness", np.nan)
        part = f"explored {100 * explored:.0f}%" if np.isfinite(explored) else ""
        return " in ".join(text for text in (part, way(values)) if text)


def way(values: Mapping[str, float]) -> str:
    """Length and time of a drive, as far as they are known, such as ``"31.2 m, 105 s"``."""
    length, time = values.get("path_length", np.nan), values.get("time", np.nan)
    parts = [(f"{length:.1f} m", length), (f"{time:.0f} s", time)]
    return ", ".join(text for text, value in parts if np.isfinite(value))


def known(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """The positions (n, 2) that are not NaN."""
    return path[~np.isnan(path).any(axis=1)]


def _position_error(recording: Recording, name: str) -> float:
    """Mean distance to the true position over the episode [m]."""
    away = recording.positions(name) - recording.positions("truth.pose")
    return float(np.mean(np.hypot(away[:, 0], away[:, 1])))


def _believed(info: Mapping[str, Any]) -> BelievedMap | None:
    if "map" not in info:
        return None
    return BelievedMap(np.array(info["map"], np.int8), float(info["resolution"]), np.array(info["origin"], np.float64))


def _map_quality(recording: Recording) -> float:
    plan, belief = getattr(recording.env.unwrapped, "floorplan", None), _believed(recording.info)
    if plan is None or belief is None:
        return np.nan
    return map_iou(plan, belief.cells, belief.origin, belief.resolution, _robot_of(recording))


def _area_to_explore(recording: Recording) -> float:
    """Area of the cells whose share is the completeness [m²]; NaN where the floor plan is not known."""
    plan, resolution = getattr(recording.env.unwrapped, "floorplan", None), recording.info.get("resolution")
    if plan is None or resolution is None:
        return np.nan
    return float(measure_coverage(plan, resolution, _robot_of(recording)).wanted.sum() * resolution**2)


def _robot_of(recording: Recording) -> RobotSpec:
    owner = owner_of(recording.env, "options")
    robot: RobotSpec = getattr(getattr(owner, "options", None), "robot", DA_SLAM_ROBOT)
    return robot


def map_iou(
    plan: Floorplan,
    occupancy: NDArray[np.int8],
    origin: NDArray[np.float64],
    resolution: float,
    robot: RobotSpec = DA_SLAM_ROBOT,
) -> float:
    """Return the intersection over union of the occupied cells, where one cell off still counts as met.

    Wanted are the wall cells that border what the robot can reach (``measure_coverage``): no robot can map the others.
    A wanted cell is met if an occupied cell lies within one cell of it, an occupied cell if any wall does.

    Args:
        plan: The truth.
        occupancy: (rows, columns), -1 / 0 / 100, in the plan's frame.
        origin: (2,) lower-left corner of cell [0, 0] [m].
        resolution: Side of a cell [m].
        robot: That made the map.

    Returns:
        Wanted cells that were met, over these, the wanted ones that were missed and the occupied ones that no wall is
        near to. NaN if nothing is wanted.
    """
    coverage, solid = measure_coverage(plan, resolution, robot), plan.raster(resolution).solid
    believed = _on_grid(occupancy >= 50, origin, coverage.origin, solid.shape, resolution)
    wanted = coverage.wanted & solid
    met = int((wanted & _widened(believed)).sum())
    invented = int((believed & ~_widened(solid)).sum())
    union = int(wanted.sum()) + invented
    return met / union if union else float("nan")


def _widened(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """``cells`` and their eight neighbours."""
    widened: NDArray[np.bool_] = cv2.dilate(cells.astype(np.uint8), _WITHIN_ONE).astype(bool)
    return widened


def _on_grid(
    cells: NDArray[np.bool_],
    origin: NDArray[np.float64],
    target: NDArray[np.float64],
    shape: tuple[int, ...],
    resolution: float,
) -> NDArray[np.bool_]:
    """``cells`` moved to the grid of ``shape`` whose corner is ``target``; what lies outside is lost."""
    moved = np.zeros(shape, np.bool_)
    rows, columns = np.nonzero(cells)
    column_shift, row_shift = np.rint((np.asarray(origin) - target) / resolution).astype(int)
    rows, columns = rows + row_shift, columns + column_shift
    inside = (rows >= 0) & (rows < shape[0]) & (columns >= 0) & (columns < shape[1])
    moved[rows[inside], columns[inside]] = True
    return moved


MEASURES = ExplorationMeasures()
