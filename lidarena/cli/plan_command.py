"""``lidarena plan MAP``: paths for one robot or a team on a floor plan, from a file or by name."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, TeamError
from lidarena.base.files import check_writable, write_figure, write_text
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph, grid_graph_of
from lidarena.planning.team.plan import Method, plan_team
from lidarena.planning.team.team_plan import TeamPlan
from lidarena.world.load import load_floorplan
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TRIES = 2_000
Ends = tuple[NDArray[np.int64], NDArray[np.int64]]
"""Starts and goals, (k, 2) [row, column] each."""


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    text = "Plan paths on a floor plan for robots that shall not touch walls or each other."
    parser = commands.add_parser("plan", help="plan paths for one robot or a team", description=text)
    add = parser.add_argument
    add("map", metavar="MAP", help="a name (lidarena list maps), a map_server .yaml, a MovingAI .map, maze:SEED …")
    place = {"nargs": 2, "type": float, "action": "append", "default": [], "metavar": ("X", "Y")}
    add("--from", dest="starts", help="where a robot starts [m]; once for each robot", **place)  # type: ignore[arg-type]
    add("--to", dest="goals", help="where it goes [m]", **place)  # type: ignore[arg-type]
    add("--scen", metavar="FILE", help="a MovingAI scenario of a .map, whose cells are then the grid's")
    add("--robots", type=int, metavar="N", help="robots at random places, or the first of the scenario (default: 1)")
    add("--seed", type=int, default=0, help="of the random places and choices (default: %(default)s)")
    add("--method", choices=get_args(Method), default="prioritized_search", help="planner (default: %(default)s)")
    add("--cell", type=float, default=0.2, metavar="M", help="side of a grid cell [m] (default: %(default)s)")
    add("--radius", type=float, default=0.1, metavar="M", help="of every robot [m] (default: %(default)s)")
    add("--connectivity", type=int, choices=(4, 8), default=8, help="neighbours of a cell (default: %(default)s)")
    add("--time-limit", type=float, default=1.0, metavar="S", help="of the search [s] (default: %(default)s)")
    add("--out", metavar="FILE", help="write the paths as JSON")
    add("--picture", metavar="FILE", help="write a picture (PNG)")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Plan; return 0, or 1 where no plan was found.

    Raises:
        LidarenaError: The map, the places or an option are refused.
    """
    for file in (options.out, options.picture):
        if file:
            check_writable(file)
    grid, ends, radius = _problem(options)
    how: dict[str, Any] = {"method": options.method, "connectivity": options.connectivity, "radius": radius}
    plan = plan_team(grid.blocked, *ends, time_limit=options.time_limit, seed=options.seed, **how)
    _report(plan, grid)
    if options.out:
        write_text(options.out, json.dumps(_document(plan, grid), indent=1) + "\n")
        print(f"paths:    {options.out}")
    if options.picture:
        write_figure(options.picture, _draw(plan, grid, ends))
        print(f"picture:  {options.picture}")
    return 0 if plan.solved else 1


def _problem(options: argparse.Namespace) -> tuple[FloorGrid, Ends, float]:
    """The grid, starts and goals, and the radius in cells."""
    if options.robots is not None and options.robots < 1:
        raise ConfigError(f"--robots is {options.robots}; at least one robot is needed")
    if options.radius < 0:
        raise ConfigError(f"--radius is {options.radius:g} m; it cannot be negative")
    if options.scen:
        if options.starts or options.goals:
            raise ConfigError("--scen says who starts where, so leave --from and --to out")
        free = load_movingai(options.map)
        scenario = load_scenario(options.scen, free, options.robots, Path(options.map).name)
        return FloorGrid(~free, (0.0, 0.0), 1.0), (scenario.starts, scenario.goals), options.radius
    grid = FloorGrid.of(load_floorplan(options.map), options.cell)
    radius = grid.in_cells(options.radius)
    if len(options.starts) != len(options.goals):
        raise ConfigError(f"{len(options.starts)} --from and {len(options.goals)} --to are given; give a pair a robot")
    if options.starts:
        if options.robots not in (None, len(options.starts)):
            raise ConfigError(f"--robots is {options.robots}, but {len(options.starts)} have places; leave one out")
        return grid, (grid.cells(options.starts), grid.cells(options.goals)), radius
    graph = grid_graph_of(grid.blocked, options.connectivity, radius)
    return grid, _draw_ends(graph, options.robots or 1, np.random.default_rng(options.seed)), radius


def _draw_ends(graph: GridGraph, robots: int, rng: np.random.Generator) -> Ends:
    """Random places apart from each other, every goal within reach of its start.

    Raises:
        TeamError: There is no room for so many.
    """
    starts: list[int] = []
    goals: list[int] = []
    if len(graph.cells) >= 2:
        for _ in range(_TRIES):
            start, goal = (int(place) for place in rng.choice(len(graph.cells), 2, replace=False))
            apart = max(graph.apart, 1.0)
            taken = any(
                np.linalg.norm(graph.cells[place] - graph.cells[others], axis=1).min(initial=np.inf) < apart
                for place, others in ((start, starts), (goal, goals))
            )
            if not taken and graph.ahead(goal)[start] < UNREACHABLE:
                starts.append(start)
                goals.append(goal)
            if len(starts) == robots:
                return graph.cells[starts], graph.cells[goals]
    raise TeamError(f"there is no room for {robots} robots; {len(starts)} found a start and a goal")


def _report(plan: TeamPlan, grid: FloorGrid) -> None:
    rows, columns = grid.blocked.shape
    print(f"grid:     {columns} x {rows} cells of {grid.resolution:g} m")
    print(f"plan:     {plan.message}")
    if plan.solved:
        known = "optimal" if plan.optimal else f"at least {plan.lower_bound:g}"
        print(f"cost:     {plan.cost:g} steps of {len(plan.paths)} robots ({known})")


def _document(plan: TeamPlan, grid: FloorGrid) -> dict[str, Any]:
    """What ``--out`` holds; positions are the centres of cells, one a time step [m]."""
    return {
        "solved": plan.solved,
        "cost": plan.cost if plan.solved else None,
        "lower_bound": plan.lower_bound,
        "optimal": plan.optimal,
        "message": plan.message,
        "paths": [grid.points(path).tolist() for path in plan.paths],
    }


def _draw(plan: TeamPlan, grid: FloorGrid, ends: Ends) -> "Figure":
    from matplotlib.figure import Figure

    from lidarena.evaluation.palette import line_of

    figure = Figure(figsize=(7, 7 * max(0.4, min(2.0, grid.blocked.shape[0] / grid.blocked.shape[1]))))
    axes = figure.add_subplot()
    rows, columns = grid.blocked.shape
    (x, y), side = grid.origin, grid.resolution
    axes.imshow(grid.blocked, origin="lower", extent=(x, x + side * columns, y, y + side * rows), cmap="Greys")
    for robot, (path, start, goal) in enumerate(zip(plan.paths, *ends, strict=True)):
        colour, dashes = line_of(robot)
        axes.plot(*grid.points(path).T, color=colour, linestyle=dashes)
        axes.plot(*grid.points(start).T, "o", color=colour)
        axes.plot(*grid.points(goal).T, "*", color=colour, markeredgecolor="black", markersize=11)
    axes.set(aspect="equal", xlabel="x (m)", ylabel="y (m)", title=plan.message)
    return figure
