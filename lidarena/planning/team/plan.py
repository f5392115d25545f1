"""One call for every planner of teams: ``plan_team`` on a bare array."""

import math
from functools import cache
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import TeamError, suggest
from lidarena.planning.team import arrangements, lacam
from lidarena.planning.team.budget import Budget
from lidarena.planning.team.certified import plan_certified
from lidarena.planning.team.coordination import plan_coordination
from lidarena.planning.team.deviation import DeviationCosts
from lidarena.planning.team.grid_graph import STEP, UNREACHABLE, GridGraph, grid_graph_of
from lidarena.planning.team.joint import plan_joint
from lidarena.planning.team.prioritized import plan_independent, plan_prioritized
from lidarena.planning.team.search import plan_search
from lidarena.planning.team.team_plan import TeamPlan
from lidarena.planning.team.traffic import Traffic

Method = Literal[
    "independent_astar", "prioritized_astar", "coordination", "joint_astar", "prioritized_search", "lacam", "cbs"
]
"""``independent_astar`` ignores the other robots (solved only if that happens to be free of conflicts).
``prioritized_astar`` is Bennewitz & Burgard's planner. ``coordination`` keeps to the independent paths. ``joint_astar``
is the joint optimum of two robots. ``prioritized_search`` looks for a good order of priority and repairs the plan
until it is settled or time is up; where no order works it starts from LaCAM's plan. ``lacam`` is LaCAM*, which is
complete: it finds a plan where there is one, given time, and may prove that there is none. ``cbs`` certifies the
optimum of some 2 to 6 robots, or says that it could not."""
MAX_CELL_COST = 64.0


def plan_team(
    grid: ArrayLike | GridGraph,
    starts: ArrayLike,
    goals: ArrayLike,
    method: Method = "prioritized_search",
    connectivity: int = 8,
    radius: float = 0.0,
    time_limit: float = 1.0,
    *,
    seed: int = 0,
    iterations: int | None = None,
    cell_costs: ArrayLike | None = None,
    deviation: ArrayLike | None = None,
) -> TeamPlan:
    """Plan paths on which a team of disc robots reaches its goals without touching walls or each other.

    In a time step a robot waits or moves to a neighbouring cell, in a straight line; a diagonal takes one step too and
    cuts no corner. The cost is the number of steps until every robot stays at its goal: Bennewitz & Burgard's score,
    cells traversed plus steps waited. Robots conflict if at any time of a step their centres are closer than two radii,
    or meet; one at its goal stays there and blocks.

    Args:
        grid: (rows, cols) bool, True = blocked; or the graph of a grid, which has a radius and neighbours of its own.
        starts: (k, 2) int [row, column].
        goals: (k, 2) int [row, column].
        method: See ``Method``.
        connectivity: 4 or 8 neighbours.
        radius: Of every robot, in cells; 0 = points.
        time_limit: Seconds that ``prioritized_search`` and ``cbs`` may take (``joint_astar``: a million states each).
        seed: Of the random choices of ``prioritized_search`` and ``cbs``.
        iterations: Greatest number of neighbourhoods that are replanned and of orders, of nodes, and of slices of
            LaCAM's search (some ten thousand moves each); with it and a ``time_limit`` of infinity, the same input
            gives the same plan on every machine.
        cell_costs: (rows, cols) what being in a cell for a step costs besides the step itself, Bennewitz & Burgard's
            P(occ) in steps, 0 to 64; for ``independent_astar``, ``prioritized_astar`` and ``prioritized_search``.
        deviation: (m, 2) distance in cells and cost in steps of being so near to where a robot with priority is planned
            to be, Bennewitz & Burgard's P_t; for ``prioritized_astar``.

    Raises:
        TeamError: The grid, starts or goals are no arrays of this form; a start or goal is outside of the grid, in a
            wall or too near to one, shared or overlapping; a goal cannot be reached, there are more starts than goals
            or the reverse, or an option is out of range.
    """
    _check_options(method, connectivity, radius, time_limit, iterations, seed)
    if math.isfinite(time_limit):
        _load_kernels(method)
    budget = Budget(time_limit, iterations)
    blocked = grid.blocked if isinstance(grid, GridGraph) else _checked_grid(grid)
    first, final = _checked_cells(starts, goals, blocked)
    if method == "joint_astar" and len(first) != 2:
        raise TeamError(f"method 'joint_astar' plans 2 robots, not {len(first)}; 'cbs' certifies the optimum of more")
    graph = grid if isinstance(grid, GridGraph) else grid_graph_of(blocked, connectivity, float(radius))
    ends = np.stack([_places(graph, first, "start"), _places(graph, final, "goal")], axis=1)
    surcharge = _surcharge(graph, cell_costs, method)
    deviation_costs = _deviation(deviation, method)
    traffic = Traffic(graph, ends, surcharge, timed=deviation_costs is not None)
    _check_reachable(traffic, blocked)
    plan = _plan(traffic, method, budget, time_limit, iterations, np.random.default_rng(seed), deviation_costs)
    traffic.close()
    return plan


@cache
def _load_kernels(method: Method) -> None:
    """Plan for two robots that swap places: compiling and loading kernels is not to be taken from a time limit."""
    if method == "prioritized_search":
        _load_kernels("lacam")
        arrangements.load_kernels()
    if method == "lacam":
        lacam.load_kernels()
    options: dict[str, Any] = {"cell_costs": np.zeros((3, 3))} if method == "prioritized_search" else {}
    ends = [(1, 0), (1, 2)]
    plan_team(np.zeros((3, 3), np.bool_), ends, ends[::-1], method, time_limit=math.inf, iterations=2, **options)


def _plan(
    traffic: Traffic,
    method: Method,
    budget: Budget,
    time_limit: float,
    iterations: int | None,
    rng: np.random.Generator,
    deviation_costs: DeviationCosts | None,
) -> TeamPlan:
    match method:
        case "independent_astar":
            return plan_independent(traffic)
        case "prioritized_astar":
            return plan_prioritized(traffic, deviation_costs)
        case "coordination":
            return plan_coordination(traffic)
        case "joint_astar":
            return plan_joint(traffic, time_limit)
        case "prioritized_search":
            return plan_search(traffic, budget, rng)
        case "lacam":
            return lacam.plan_lacam(traffic, budget, rng)
        case "cbs":
            return plan_certified(traffic, time_limit, iterations, rng)


def _check_options(
    method: str, connectivity: object, radius: object, time_limit: object, iterations: object, seed: object
) -> None:
    if method not in get_args(Method):
        raise TeamError(f"there is no method {method!r}{suggest(str(method), get_args(Method))}")
    if not _is_number(connectivity) or connectivity not in (4, 8):
        raise TeamError(f"connectivity {connectivity!r} is not possible; 4 or 8 neighbours are")
    if not _is_number(radius) or not 0.0 <= radius <= 100.0:  # type: ignore[operator]
        raise TeamError(f"a radius of {radius!r} cells is not possible; 0 to 100 is allowed")
    if not _is_number(time_limit) or not time_limit > 0.0:  # type: ignore[operator]
        raise TeamError(f"a time limit of {time_limit!r} s is not possible; a positive number is needed")
    for name, value in (("iterations", iterations), ("a seed", seed)):
        whole = isinstance(value, int | np.integer) and value >= 0
        if not whole and not (value is None and name == "iterations"):
            raise TeamError(f"{name} of {value!r} is not possible; a whole number, 0 or more, is needed")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.integer | np.floating)


def _array_of(name: str, given: ArrayLike) -> NDArray[Any]:
    """The array that was given; refused where its rows differ in length."""
    try:
        return np.asarray(given)
    except (TypeError, ValueError):
        raise TeamError(f"rows of different lengths were given as the {name}; an array is needed") from None


def _checked_grid(grid: ArrayLike) -> NDArray[np.bool_]:
    blocked = _array_of("grid", grid)
    if blocked.ndim != 2 or blocked.size == 0:
        raise TeamError(f"the grid has shape {blocked.shape}; (rows, columns) with at least one cell is needed")
    if blocked.dtype != np.bool_ and not np.isin(blocked, (0, 1)).all():
        raise TeamError("the grid must be bool, True for blocked cells; it holds other values than 0 and 1")
    return np.ascontiguousarray(blocked, np.bool_)


def _checked_cells(
    starts: ArrayLike, goals: ArrayLike, blocked: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    cells = []
    for kind, given in (("start", starts), ("goal", goals)):
        array = _array_of(f"{kind}s", given)
        if array.ndim != 2 or array.shape[1] != 2 or not len(array) or not np.issubdtype(array.dtype, np.integer):
            raise TeamError(
                f"the {kind}s have shape {array.shape} and type {array.dtype}; "
                "whole numbers (robots, 2), for at least one robot, are needed"
            )
        cells.append(array.astype(np.int64))
        for robot, (row, col) in enumerate(array):
            if not (0 <= row < blocked.shape[0] and 0 <= col < blocked.shape[1]):
                raise TeamError(
                    f"the {kind} of robot {robot} at ({row}, {col}) lies outside of the grid of shape {blocked.shape}"
                )
            if blocked[row, col]:
                raise TeamError(f"the {kind} of robot {robot} at ({row}, {col}) is in a wall")
    if len(cells[0]) != len(cells[1]):
        raise TeamError(f"there are {len(cells[0])} starts for {len(cells[1])} goals; every robot needs one of each")
    return cells[0], cells[1]


def _places(graph: GridGraph, cells: NDArray[np.int64], kind: str) -> NDArray[np.int64]:
    """Places of the robots' starts or goals; refused where a disc touches a wall or another disc."""
    places = graph.index[cells[:, 0], cells[:, 1]].astype(np.int64)
    for robot in np.flatnonzero(places < 0):
        row, col = cells[robot]
        raise TeamError(
            f"the {kind} of robot {robot} at ({row}, {col}) is nearer to a wall than its radius of {graph.radius} cells"
        )
    away = np.hypot(*(cells[:, None] - cells[None, :]).transpose(2, 0, 1))
    near = np.triu((away < graph.apart - 1e-9) | (away == 0), 1)
    for i, j in np.argwhere(near):
        if away[i, j] == 0:
            raise TeamError(f"robots {i} and {j} share the {kind} ({cells[i, 0]}, {cells[i, 1]})")
        raise TeamError(
            f"the {kind}s of robots {i} and {j} overlap: they are {away[i, j]:.2f} cells apart,"
            f" their radii need {graph.apart}"
        )
    return places


def _check_reachable(traffic: Traffic, blocked: NDArray[np.bool_]) -> None:
    graph = traffic.graph
    for robot in np.flatnonzero(traffic.alone >= int(UNREACHABLE // STEP)).tolist():
        start, goal = traffic.ends[robot]
        here, there = (tuple(int(x) for x in graph.cells[place]) for place in (start, goal))
        points = grid_graph_of(blocked, graph.connectivity, 0.0)
        if points.ahead(int(points.index[there]))[points.index[here]] < UNREACHABLE:
            raise TeamError(
                f"robot {robot} cannot reach its goal {there} from {here}: with a radius of {graph.radius} cells"
                " it is wider than every door on the way"
            )
        raise TeamError(f"robot {robot} cannot reach its goal {there} from {here}: no free cells connect them")


def _surcharge(graph: GridGraph, cell_costs: ArrayLike | None, method: str) -> NDArray[np.int32] | None:
    if cell_costs is None:
        return None
    if method not in ("independent_astar", "prioritized_astar", "prioritized_search"):
        raise TeamError(f"method {method!r} counts steps alone and takes no cell_costs")
    costs = np.asarray(cell_costs, np.float64)
    if costs.shape != graph.index.shape:
        raise TeamError(f"cell_costs have shape {costs.shape}; the grid has {graph.index.shape}")
    values = costs[graph.cells[:, 0], graph.cells[:, 1]]
    if not ((values >= 0) & (values <= MAX_CELL_COST)).all():
        raise TeamError(f"cell_costs must be 0 to {MAX_CELL_COST} steps where robots can stand")
    return np.round(values * int(STEP)).astype(np.int32)


def _deviation(deviation: ArrayLike | None, method: str) -> DeviationCosts | None:
    if deviation is None:
        return None
    if method != "prioritized_astar":
        raise TeamError(f"method {method!r} takes no deviation model; 'prioritized_astar' does")
    return DeviationCosts(deviation)
