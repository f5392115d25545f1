"""Path planning by artificial potential fields: Khatib's, and the improved one of Yang et al.

result = plan_path(circles, start, goal)            # robust: what was measured to work
result = plan_path(circles, start, goal, "paper")   # as printed, misprints corrected
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.random_streams import seed_stream
from lidarena.planning.potential_field import field_kernels
from lidarena.planning.potential_field.clearance_order import clearance_shares
from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.field_descent import ARRIVED, COLLIDED, OUT_OF_FILLS, TRAPPED, walk
from lidarena.planning.potential_field.field_kernels import NEAREST
from lidarena.planning.potential_field.field_parameters import (
    PRESETS,
    FieldParameters,
    FieldWarning,
    check_gain_ratio,
    field_parameters,
)
from lidarena.planning.potential_field.field_scene import FieldScene, make_scene
from lidarena.planning.potential_field.regression_search import path_length, regression_search, shortened

__all__ = ["PRESETS", "FieldParameters", "FieldWarning", "PathResult", "PotentialField", "plan_path"]

_STRAIGHT = 1.002
"""No other way is tried if a path is longer than the straight line by no more than this."""


class PathResult(NamedTuple):
    """What a planner found.

    Attributes:
        success: The goal was reached without a collision.
        collided: A step touched an obstacle (never with ``guard``).
        path: (M, 2) x, y of every step, from the start on (m); after several attempts that of the last.
        smoothed: (S, 2) the corners left by the regression search (m); the same as ``path`` if it was not run.
        fills: How many fills the path took.
        message: One sentence.
        filled: (F, 3) x, y, s of the fills of the last walk, for :class:`PotentialField`.
        parameters: With which the path was found, lengths in metres.
        backwards: The walk led from the goal to the start, and was turned round.
    """

    success: bool
    collided: bool
    path: NDArray[np.float64]
    smoothed: NDArray[np.float64]
    fills: int
    message: str
    filled: NDArray[np.float64]
    parameters: FieldParameters
    backwards: bool = False


@dataclass(frozen=True)
class PotentialField:
    """The potential of a scene, to look at.

    Attributes:
        scene: The obstacles and the goal.
        parameters: The field's, lengths in metres (not scaled any more).
        filled: (F, 3) x, y, s of each fill.
    """

    scene: FieldScene
    parameters: FieldParameters
    filled: NDArray[np.float64]

    @classmethod
    def of(
        cls,
        circles: ArrayLike,
        start: ArrayLike,
        goal: ArrayLike,
        preset: str = "robust",
        robot_radius: float = 0.0,
        bounds: ArrayLike | None = None,
        **overrides: Any,
    ) -> "PotentialField":
        """Return the field in which :func:`plan_path` with the same arguments makes its first step."""
        scene = make_scene(circles, start, goal, robot_radius, bounds)
        parameters = field_parameters(preset, **overrides).fitted(scene.scale, overrides)
        share = clearance_shares(scene, parameters.h_0, parameters.attempts)[0]
        return cls(scene, parameters.tightened(share), np.empty((0, 3)))

    @classmethod
    def after(
        cls,
        result: PathResult,
        circles: ArrayLike,
        start: ArrayLike,
        goal: ArrayLike,
        robot_radius: float = 0.0,
        bounds: ArrayLike | None = None,
    ) -> "PotentialField":
        """Return the field in which a plan made its last step, with all of its fills."""
        ends = (goal, start) if result.backwards else (start, goal)
        scene = make_scene(circles, *ends, robot_radius, bounds)
        return cls(scene, result.parameters, result.filled)

    def potential(self, points: ArrayLike) -> NDArray[np.float64]:
        """Return U (…,) at points (…, 2) (eqs. 1, 3, 5, 7, 8 and 15); inf inside obstacles."""
        places = np.ascontiguousarray(points, np.float64)
        values = np.empty(places.shape[:-1])
        field_kernels.potentials(places.reshape(-1, 2), *self._arguments(), values.reshape(-1))
        return values

    def force(self, points: ArrayLike) -> NDArray[np.float64]:
        """Return -∇U (…, 2) at points (…, 2) (eqs. 2, 4, 6, 9 and 10)."""
        places = np.ascontiguousarray(points, np.float64)
        values = np.empty(places.shape)
        field_kernels.forces(places.reshape(-1, 2), *self._arguments(), values.reshape(-1, 2))
        return values

    def _arguments(self) -> tuple[Any, ...]:
        scene = self.scene
        return scene.goal, scene.obstacles, self.parameters.field(), self.filled


def plan_path(
    circles: ArrayLike,
    start: ArrayLike,
    goal: ArrayLike,
    preset: str = "robust",
    robot_radius: float = 0.0,
    bounds: ArrayLike | None = None,
    **overrides: Any,
) -> PathResult:
    """Plan a path among circles by walking down a potential (Yang et al., Fig. 6), then by regression search.

    Args:
        circles: (K, 3) x, y, radius (m); K = 0 gives a straight line.
        start: x, y (m).
        goal: x, y (m).
        preset: ``"robust"``, ``"paper"`` or ``"traditional"``.
        robot_radius: Radius of the robot (m).
        bounds: x_min, y_min, x_max, y_max of the room, whose walls are obstacles (m); None: no walls.
        **overrides: Attributes of :class:`FieldParameters` (with ``fit_scale``, lengths that are given here are metres
            of this scene and are not scaled).

    Returns:
        The result; if there is no path its ``success`` is False and ``message`` says what ended the search.

    Raises:
        MapError: A circle, bound, start or goal has no meaning, or the start or the goal is in an obstacle.
        ConfigError: The preset or a parameter is not known or out of range.

    Warns:
        FieldWarning: The parameters break the bound on k/η (eq. 13).
    """
    scene = make_scene(circles, start, goal, robot_radius, bounds)
    parameters = field_parameters(preset, **overrides).fitted(scene.scale, overrides)
    check_gain_ratio(parameters, scene.goal_gap)
    noise = seed_stream(np.random.default_rng(parameters.seed))
    steps, kept = 0, []
    for share in clearance_shares(scene, parameters.h_0, parameters.attempts):
        tried = parameters.tightened(share)
        result, taken = _best_way(scene, tried, noise)
        steps += taken
        kept.append(f"{tried.h_0:.3g}")
        if result.success:
            break
    if not result.success and parameters.attempts > 1:
        tries = f"in {len(kept)} attempts with {steps} steps and clearances of {', '.join(kept)} m beside the robot"
        return result._replace(message=f"no path was found {tries}; in the last, {result.message}")
    return result


def _best_way(scene: FieldScene, parameters: FieldParameters, noise: NDArray[np.uint64]) -> tuple[PathResult, int]:
    """The shortest of several ways, see ``FieldParameters.ways``, and the steps that were made for all of them."""
    enough = _STRAIGHT * float(np.hypot(*(scene.goal - scene.start)))
    best = _attempt(scene, parameters, noise)
    steps = len(best.path) - 1
    for way in (_backwards, _other_side)[: parameters.ways - 1]:
        if best.success and path_length(best.smoothed) <= enough:
            break
        other = way(scene, parameters, noise, best)
        steps += len(other.path) - 1 if other is not best else 0
        if other.success and not (best.success and path_length(best.smoothed) <= path_length(other.smoothed)):
            best = other
    if best.success and parameters.regression and parameters.repeat_regression:
        best = best._replace(smoothed=shortened(best.smoothed, *scene.keeping(parameters.h_0)))
    return best, steps


def _backwards(
    scene: FieldScene, parameters: FieldParameters, noise: NDArray[np.uint64], best: PathResult
) -> PathResult:
    """Walk from the goal to the start: seen from its back, a trap is none."""
    found = _attempt(replace(scene, start=scene.goal, goal=scene.start), parameters, noise)
    return found._replace(path=found.path[::-1].copy(), smoothed=found.smoothed[::-1].copy(), backwards=True)


def _other_side(
    scene: FieldScene, parameters: FieldParameters, noise: NDArray[np.uint64], best: PathResult
) -> PathResult:
    """Walk by the mirror image of the farthest corner of the best path so far, and so on an obstacle's other side."""
    kept = scene.keeping(parameters.h_0)
    ahead = (scene.goal - scene.start) / max(float(np.hypot(*(scene.goal - scene.start))), NEAREST)
    aside = (best.smoothed - scene.start) @ np.array([-ahead[1], ahead[0]])
    corner = int(np.argmax(np.abs(aside)))
    via = best.smoothed[corner] - 2.0 * aside[corner] * np.array([-ahead[1], ahead[0]])
    if not best.success or not segment_is_free(*via, *via, *kept, np.zeros(1, np.int64)):
        return best
    there = _attempt(replace(scene, goal=via), parameters, noise)
    if not there.success:
        return there
    on = _attempt(replace(scene, start=via), parameters, noise)
    path = np.vstack([there.path, on.path[1:]])
    smoothed = regression_search(path, *kept) if parameters.regression else path
    return on._replace(path=path, smoothed=smoothed, fills=there.fills + on.fills)


def _attempt(scene: FieldScene, parameters: FieldParameters, noise: NDArray[np.uint64]) -> PathResult:
    """One walk and its regression search."""
    kept = scene.keeping(parameters.h_0)
    path = np.empty((parameters.max_steps + 1, 2))
    path[0] = scene.start
    filled = np.empty((parameters.max_fills, 3))
    last, fills, end = walk(
        path,
        scene.goal,
        scene.obstacles,
        kept,
        parameters.field(),
        parameters.motion(),
        filled,
        np.zeros(1, np.int64),
        noise,
    )
    steps, taken = path[: last + 1].copy(), filled[:fills].copy()
    if end == ARRIVED and np.any(steps[-1] != scene.goal):
        steps = np.vstack([steps, scene.goal])
    smoothed = steps.copy()
    if end == ARRIVED and parameters.regression:
        smoothed = regression_search(steps, *kept)
    message = _message(end, last, fills, parameters)
    return PathResult(end == ARRIVED, end == COLLIDED, steps, smoothed, fills, message, taken, parameters)


def _message(end: int, steps: int, fills: int, parameters: FieldParameters) -> str:
    if end == ARRIVED:
        return f"the goal was reached in {steps} steps with {fills} fills"
    if end == COLLIDED:
        return f"step {steps} touched an obstacle"
    if end == TRAPPED:
        return f"the walk was trapped in a local minimum at step {steps}"
    if end == OUT_OF_FILLS:
        return f"the walk was still trapped at step {steps} after {fills} fills, the most allowed"
    return f"the goal was not reached within {parameters.max_steps} steps (the limit), with {fills} fills"
