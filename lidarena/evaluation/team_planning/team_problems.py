"""Random problems for teams of robots, as in Bennewitz & Burgard's experiments (section 3)."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph, grid_graph_of
from lidarena.planning.team.plan import Method, plan_team
from lidarena.planning.team.team_plan import TeamPlan
from lidarena.planning.team.validation import validate_plan
from lidarena.world.load import load_floorplan
from lidarena.world.team_drawings import team_places

RADIUS = 0.2
"""Of the robots that are planned for [m]."""


class Problem(NamedTuple):
    """A team's problem; radius in cells."""

    blocked: NDArray[np.bool_]
    starts: NDArray[np.int64]
    goals: NDArray[np.int64]
    radius: float
    connectivity: int = 8


class ProblemGrid(NamedTuple):
    """A floor plan's grid and the places of it that problems are drawn from."""

    blocked: NDArray[np.bool_]
    graph: GridGraph
    places: NDArray[np.int64]


def problem_grid(name: str, cell: float, radius: float = RADIUS) -> ProblemGrid:
    """Lay out a floor plan that has predefined places.

    Args:
        name: Of the floor plan.
        cell: Side of a cell [m].
        radius: Of the robots [m].

    Raises:
        ConfigError: There are no places to draw from.
    """
    known = team_places(name)
    if known is None or not known.drawn:
        raise ConfigError(f"map {name!r} has no places to draw starts and goals from; office and unstructured have")
    grid = FloorGrid.of(load_floorplan(name), cell)
    graph = grid_graph_of(grid.blocked, 8, grid.in_cells(radius))
    cells = grid.cells(known.starts)
    places = graph.index[cells[:, 0], cells[:, 1]].astype(np.int64)
    return ProblemGrid(grid.blocked, graph, places[places >= 0])


def draw_problem(grid: ProblemGrid, robots: int, rng: np.random.Generator) -> Problem:
    """Draw starts apart from each other, goals too, every goal within reach."""
    graph = grid.graph
    while True:
        ends = np.stack([rng.choice(grid.places, robots, replace=False) for _ in range(2)])
        cells = graph.cells[ends].astype(float)
        gaps = np.linalg.norm(cells[:, :, None] - cells[:, None], axis=-1) + 1e9 * np.eye(robots)
        reached = all(graph.ahead(int(goal))[start] < UNREACHABLE for start, goal in ends.T)
        if reached and gaps.min() >= max(graph.apart, 1.0) and (ends[0] != ends[1]).all():
            return Problem(grid.blocked, graph.cells[ends[0]], graph.cells[ends[1]], graph.radius)


def problems(grid: ProblemGrid, robots: int, seed: int) -> Iterator[Problem]:
    """Random problems without end; the first ones of a seed are always the same."""
    rng = np.random.default_rng([seed, robots])
    while True:
        yield draw_problem(grid, robots, rng)


def solve(problem: Problem, method: Method, time_limit: float = np.inf, iterations: int | None = None) -> TeamPlan:
    """Plan, and check what claims to be solved by the independent validator.

    Raises:
        AssertionError: The plan is not what it says.
    """
    blocked, starts, goals, radius, connectivity = problem
    plan = plan_team(blocked, starts, goals, method, connectivity, radius, time_limit, iterations=iterations)
    faults = validate_plan(plan, blocked, starts, goals, connectivity, radius) if plan.solved else []
    if faults:
        raise AssertionError(f"{method}: {'; '.join(faults[:3])}")
    return plan


def count_conflicts(plan: TeamPlan, apart: float) -> int:
    """Pairs of robots that conflict somewhere on their paths.

    Args:
        plan: Of ``independent_astar``.
        apart: Sum of two radii [cells].
    """
    longest = max(len(path) for path in plan.paths)
    table = np.stack([np.pad(path, ((0, longest + 1 - len(path)), (0, 0)), "edge") for path in plan.paths])
    pairs = 0
    for i in range(len(table)):
        for j in range(i):
            gap = (table[i] - table[j]).astype(float)
            change = np.diff(gap, axis=0)
            square = np.maximum((change**2).sum(axis=1), 1e-12)
            when = np.clip(-(gap[:-1] * change).sum(axis=1) / square, 0.0, 1.0)
            nearest = gap[:-1] + when[:, None] * change
            pairs += bool((np.hypot(*nearest.T) < max(apart - 1e-6, 1e-6)).any())
    return pairs
