"""A potential field that is led by a global path: the future work of Yang et al., smooth and without traps.

The goal of the walk is a lookahead point: the farthest point of an A* path that is in sight and not too far ahead.
Obstacles repel as before. The heading turns by a limited angle a step, which is what smooths the path. The walk takes
no step from which it would lose sight of every lookahead point, and goes straight to one where the field holds it back:
since the lookahead point stays in sight on the way to it, the walk arrives.
"""

import itertools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.jit import leaf
from lidarena.planning.potential_field.circle_grid import shortest_grid_path
from lidarena.planning.potential_field.clearance_order import clearance_shares
from lidarena.planning.potential_field.disc_clearance import segment_is_free
from lidarena.planning.potential_field.field_descent import ARRIVED, OUT_OF_STEPS
from lidarena.planning.potential_field.field_kernels import Field, Obstacles, force_at
from lidarena.planning.potential_field.field_parameters import FieldParameters, field_parameters
from lidarena.planning.potential_field.field_scene import FieldScene, make_scene
from lidarena.planning.potential_field.gap_graph import GapGraph
from lidarena.planning.potential_field.potential_field import PathResult
from lidarena.planning.potential_field.regression_search import path_length, regression_search, shortened

_AHEAD = 8.0
"""A lookahead point is at most this far ahead along the path, in units of h_0."""
_TURN = 0.1
"""Most a heading turns in a step (rad)."""
_WINDOW = 20
_WEIGHT = 2.0
"""A* pays so much more for cells without any clearance."""
_DETOUR = 1.1
"""A* path that is so much longer than the gaps between obstacles need may be one that its grid or weight led astray."""


@leaf
def _lookahead_point(
    x: float,
    y: float,
    route: NDArray[np.float64],
    first: int,
    reach: int,
    kept: Obstacles,
    blocker: NDArray[np.int64],
) -> int:
    """The last point of ``route`` (R, 2) from ``first`` on, at most ``reach`` further, that is in sight; -1: none."""
    for i in range(min(first + reach, route.shape[0] - 1), first - 1, -1):
        if segment_is_free(x, y, route[i, 0], route[i, 1], kept.discs, kept.walls, blocker):
            return i
    return -1


@leaf
def _limited(heading: float, wanted: float, most: float) -> float:
    """``heading`` turned towards ``wanted`` by ``most`` at most."""
    turn = (wanted - heading + math.pi) % (2.0 * math.pi) - math.pi
    return heading + min(max(turn, -most), most)


@leaf
def follow(
    path: NDArray[np.float64],
    route: NDArray[np.float64],
    reach: int,
    obstacles: Obstacles,
    kept: Obstacles,
    field: Field,
    gamma: float,
    target: NDArray[np.float64],
    blocker: NDArray[np.int64],
) -> tuple[int, int]:
    """Walk along a route.

    Args:
        path: (N + 1, 2) its first row is the start; the others are written.
        route: (R, 2) points to be led by, close together.
        reach: How many of them the lookahead point is ahead at most.
        obstacles: Discs and walls, which repel.
        kept: The same, grown by the clearance that the walk keeps.
        field: The potential.
        gamma: Length of a step (m).
        target: (2,) scratch for the lookahead point.
        blocker: (1,) scratch, 0.

    Returns:
        Index of the last row of ``path`` that was written, and how it ended.
    """
    ahead, straight = 0, 0
    end = route.shape[0] - 1
    heading = math.atan2(route[min(1, end), 1] - route[0, 1], route[min(1, end), 0] - route[0, 0])
    for k in range(path.shape[0] - 1):
        x, y = path[k, 0], path[k, 1]
        if math.hypot(x - route[end, 0], y - route[end, 1]) <= gamma:
            return k, ARRIVED
        found = _lookahead_point(x, y, route, ahead, reach, kept, blocker)
        ahead = max(ahead, found)
        target[0], target[1] = route[ahead, 0], route[ahead, 1]
        if k >= _WINDOW and math.hypot(x - path[k - _WINDOW, 0], y - path[k - _WINDOW, 1]) < 0.25 * _WINDOW * gamma:
            straight = _WINDOW
        step = gamma
        fx, fy = force_at(x, y, target, obstacles.discs, obstacles.walls, field, route, 0)
        turned = _limited(heading, math.atan2(fy, fx), _TURN)
        nx, ny = x + gamma * math.cos(turned), y + gamma * math.sin(turned)
        lost = straight > 0 or not segment_is_free(x, y, nx, ny, kept.discs, kept.walls, blocker)
        if lost or _lookahead_point(nx, ny, route, ahead, reach, kept, blocker) < 0:
            turned = math.atan2(target[1] - y, target[0] - x)
            step = min(gamma, math.hypot(target[0] - x, target[1] - y))
            nx, ny = x + step * math.cos(turned), y + step * math.sin(turned)
        straight = max(straight - 1, 0)
        heading = turned
        path[k + 1, 0], path[k + 1, 1] = nx, ny
    return path.shape[0] - 1, OUT_OF_STEPS


def _spaced(path: NDArray[np.float64], spacing: float) -> NDArray[np.float64]:
    """The same polyline as points a ``spacing`` apart, its corners among them."""
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    wanted = np.union1d(at, np.arange(0.0, at[-1], spacing))
    return np.column_stack([np.interp(wanted, at, path[:, 0]), np.interp(wanted, at, path[:, 1])])


class _Route(NamedTuple):
    """What a walk is led by.

    Attributes:
        points: (n, 2) corners (m).
        parameters: With the clearance ``h_0`` that it keeps.
        kept: Obstacles, grown by that.
    """

    points: NDArray[np.float64]
    parameters: FieldParameters
    kept: Obstacles


def _find_route(scene: FieldScene, parameters: FieldParameters) -> tuple[_Route | None, list[float]]:
    """The route of the first clearance that is no detour, or else the shortest; the clearances without any (m)."""
    gaps, best, without = GapGraph(scene), None, []
    shares = clearance_shares(scene, parameters.h_0, parameters.attempts)
    enough = _DETOUR * gaps.way_length(shares[0] * parameters.h_0)
    for share in shares:
        tried = parameters.tightened(share)
        kept = scene.keeping(tried.h_0)
        points = shortest_grid_path(scene.narrowed(kept), tried.h_0, _WEIGHT)
        if not len(points) or path_length(points) > enough:
            points = _shorter(points, _between(gaps, kept, tried.h_0))
        if not len(points):
            without.append(tried.h_0)
        elif best is None or path_length(points) < path_length(best.points):
            best = _Route(points, tried, kept)
            if path_length(points) <= enough:
                break
    return best, without


def _between(gaps: GapGraph, kept: Obstacles, clearance: float) -> NDArray[np.float64]:
    """A free way (n, 2) through gaps that may be too fine for A*'s grid; (0, 2) if there is none."""
    way, blocker = gaps.way(clearance, in_the_middle=True), np.zeros(1, np.int64)
    if not all(segment_is_free(*a, *b, *kept, blocker) for a, b in itertools.pairwise(way)):
        return np.empty((0, 2))
    return shortened(regression_search(way, *kept), *kept) if len(way) else way


def _shorter(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """The shorter of two paths (n, 2), either of which may be missing (0, 2)."""
    return other if not len(one) or (len(other) and path_length(other) < path_length(one)) else one


def plan_guided_path(
    circles: ArrayLike,
    start: ArrayLike,
    goal: ArrayLike,
    robot_radius: float = 0.0,
    bounds: ArrayLike | None = None,
    **overrides: Any,
) -> PathResult:
    """Plan a smooth path by a potential field that is led by A*'s path.

    Its arguments are those of :func:`~lidarena.planning.potential_field.potential_field.plan_path`, with the preset
    ``robust``.

    Returns:
        The result; ``path`` is the smooth one, ``smoothed`` the corners that the regression search leaves of it.

    Raises:
        MapError: As :func:`lidarena.planning.potential_field.potential_field.plan_path`.
        ConfigError: As there.
    """
    scene = make_scene(circles, start, goal, robot_radius, bounds)
    parameters = field_parameters("robust", **overrides).fitted(scene.scale, overrides)
    none = np.empty((0, 3))
    found, without = _find_route(scene, parameters)
    if found is None:
        alone, tried_m = scene.start[None].copy(), ", ".join(f"{clearance:.3g}" for clearance in without)
        message = f"A* finds no path on its grid with clearances of {tried_m} m beside the robot"
        return PathResult(False, False, alone, alone.copy(), 0, message, none, parameters)
    route, tried, kept = found
    route = shortened(regression_search(route, *kept), *kept)
    points = _spaced(route, tried.gamma)
    steps = min(parameters.max_steps, 4 * len(points) + 1000)
    path = np.empty((steps + 1, 2))
    path[0] = scene.start
    arguments = (scene.obstacles, kept, tried.field(), float(tried.gamma))
    reach = np.int64(_AHEAD * tried.h_0 / tried.gamma)
    last, end = follow(path, points, reach, *arguments, np.empty(2), np.zeros(1, np.int64))
    path = np.vstack([path[: last + 1], scene.goal]) if end == ARRIVED else path[: last + 1].copy()
    smoothed = shortened(regression_search(path, *kept), *kept) if end == ARRIVED else path.copy()
    way = f"the goal was reached in {last} steps along A*'s path of {path_length(route):.4g} m"
    message = way if end == ARRIVED else f"the goal was not reached within {steps} steps (the limit)"
    return PathResult(end == ARRIVED, False, path, smoothed, 0, message, none, tried)
