"""Planning for teams, measured against what it must reach: cost, share of problems solved, and time on one core.

python benchmarks/team_planning.py [--data ../shared/data] [--problems 100] [--only mapf speed joint certified solved]

Every plan is checked by ``validate_plan``, which shares nothing with the planners. Times are processor time of one core
with warm kernels. Freiburg's building 079, whose licence keeps it out of this repository, is read from the data folder,
and left out where it is absent. Figures of others: CBSH2-RTC, PBS and LaCAM3 on the same scenarios.
"""

import argparse
import itertools
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.terminal import make_output_printable
from lidarena.evaluation.team_planning.team_experiment import SHIPPED
from lidarena.evaluation.team_planning.team_problems import Problem
from lidarena.planning import TeamPlan, plan_team, validate_plan
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph, grid_graph_of
from lidarena.world.load import load_floorplan
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario
from lidarena.world.team_drawings import team_places

MAPF = ("random-32-32-20", "room-32-32-4", "warehouse-10-20-10-2-1")
LIMITS = {6: 0.1, 20: 0.1, 50: 0.5}
ROBOT = 0.2  # radius [m]


class Answer(NamedTuple):
    """A plan and the processor time that it took [s]."""

    plan: TeamPlan
    seconds: float


def solve(problem: Problem, method: str, time_limit: float = 1.0) -> Answer:
    """Plan and validate."""
    blocked, starts, goals, radius, connectivity = problem
    begin = time.process_time()
    plan = plan_team(blocked, starts, goals, method, connectivity, radius, time_limit)  # type: ignore[arg-type]
    seconds = time.process_time() - begin
    faults = validate_plan(plan, blocked, starts, goals, connectivity, radius) if plan.solved else []
    if faults:
        raise AssertionError(f"{method}: {'; '.join(faults[:3])}")
    return Answer(plan, seconds)


def largest_part(graph: GridGraph) -> NDArray[np.int64]:
    """The places of the largest part of a grid whose places are all within reach of each other."""
    left, parts = np.ones(len(graph), np.bool_), []
    while left.any():
        within = graph.ahead(int(np.argmax(left))) < UNREACHABLE
        left &= ~within
        parts.append(np.flatnonzero(within))
    return max(parts, key=len)


def draw_team(
    graph: GridGraph, robots: int, rng: np.random.Generator, allowed: NDArray[np.int64] | None = None
) -> Problem:
    """A random problem: starts apart from each other, goals too, every goal within reach."""
    places = largest_part(graph) if allowed is None else allowed
    blocked = graph.index < 0  # robots of this radius stand anywhere else
    while True:
        ends = np.stack([rng.choice(places, robots, replace=False) for _ in range(2)])
        cells = graph.cells[ends].astype(float)
        gaps = np.linalg.norm(cells[:, :, None] - cells[:, None], axis=-1) + 99.0 * np.eye(robots)
        reached = all(graph.ahead(int(g))[s] < UNREACHABLE for s, g in ends.T)
        if reached and (robots == 1 or gaps.min() >= max(graph.apart, 1.0)) and (ends[0] != ends[1]).all():
            return Problem(blocked, graph.cells[ends[0]], graph.cells[ends[1]], graph.radius)


def problems(
    blocked: NDArray[np.bool_],
    radius: float,
    robots: int,
    count: int,
    seed: int,
    allowed: NDArray[np.int64] | None = None,
) -> Iterator[Problem]:
    """Random problems on a grid."""
    graph = grid_graph_of(blocked, 8, radius)
    rng = np.random.default_rng([seed, robots])
    for _ in range(count):
        yield draw_team(graph, robots, rng, allowed)._replace(blocked=blocked)


def conflicting(candidates: Iterator[Problem]) -> Iterator[Problem]:
    """Those whose independent paths conflict: the only ones that Bennewitz and Burgard count."""
    return (problem for problem in candidates if not solve(problem, "independent_astar").plan.solved)


def show(what: str, value: str, bar: str, reached: bool) -> None:
    """One line of the report."""
    print(f"  {'ok  ' if reached else 'MISS'} {what:62} {value:28} {bar}")


def floor(name: str) -> tuple[NDArray[np.bool_], NDArray[np.int64] | None]:
    """A built-in floor plan at 20 cm, and the places that robots are drawn from."""
    grid = FloorGrid.of(load_floorplan(name), 0.2)
    places = team_places(name)
    graph = grid_graph_of(grid.blocked, 8, grid.in_cells(ROBOT))
    if places is None:
        return grid.blocked, None
    cells = grid.cells(places.starts)
    return grid.blocked, graph.index[cells[:, 0], cells[:, 1]].astype(np.int64)


def cluttered(seed: int, side: int = 48, boxes: int = 45) -> NDArray[np.bool_]:
    """A square of random boxes of 1 to 7 cells a side."""
    rng = np.random.default_rng(seed)
    blocked = np.zeros((side, side), np.bool_)
    corners, sizes = rng.integers(0, side, (boxes, 2)), rng.integers(1, 8, (boxes, 2))
    for (row, col), (height, width) in zip(corners, sizes, strict=True):
        blocked[row : row + height, col : col + width] = True
    return blocked


def mapf(data: Path, count: int) -> None:
    """The MovingAI scenarios, 4-connected points."""
    print("MovingAI, all ten random scenarios of a map, prioritized_search; cost over the lower bound")
    bars = {("room-32-32-4", 20): 1.02, ("room-32-32-4", 50): 1.15}
    for name in MAPF:
        free = load_movingai(SHIPPED / "map" / f"{name}.map")
        for robots, limit in LIMITS.items():
            answers = []
            for i in range(1, 11):
                scenario = load_scenario(
                    SHIPPED / "scen-random" / f"{name}-random-{i}.scen", free, robots, f"{name}.map"
                )
                answers.append(solve(Problem(~free, *scenario, 0.0, 4), "prioritized_search", limit))
            solved = [a for a in answers if a.plan.solved]
            ratio = np.mean([a.plan.cost / a.plan.lower_bound for a in solved])
            took = 1e3 * np.array([a.seconds for a in answers])
            bar = bars.get((name, robots))
            show(
                f"{name}, {robots} robots, limit {1e3 * limit:.0f} ms",
                f"{len(solved)}/10 {ratio:.4f} {np.mean(took):.0f} (max {took.max():.0f}) ms",
                "10/10" + (f", {bar}" if bar else ""),
                len(solved) == 10 and (bar is None or ratio <= bar),
            )


def speed(data: Path, count: int) -> None:
    """Time to plan on FR079 at 20 cm."""
    print("FR079 at 20 cm, discs of 20 cm radius: time to a plan")
    blocked = ~load_movingai(data / "office" / "fr079_20cm.map")
    for robots, bar, methods in (
        (1, 2, ("independent_astar", "prioritized_astar")),
        (6, 25, ("prioritized_astar", "prioritized_search")),
        (20, 150, ("prioritized_astar", "prioritized_search")),
    ):
        cases = list(problems(blocked, 1.0, robots, count, 1))
        for method in methods:
            answers = [solve(case, method, bar * 0.8e-3) for case in cases]
            took = 1e3 * np.array([a.seconds for a in answers])
            solved = [a.plan for a in answers if a.plan.solved]
            ratio = np.mean([plan.cost / plan.lower_bound for plan in solved])
            show(
                f"{robots} robots, {method}, {len(solved)}/{len(cases)} solved",
                f"median {np.median(took):.1f}, p95 {np.quantile(took, 0.95):.1f} ms, {ratio:.4f}",
                f"{bar} ms",
                bool(np.median(took) <= bar),
            )


def joint(data: Path, count: int) -> None:
    """Fig. 10: two robots, 60 cm cells."""
    print("Fig. 10: 60 cm cells, two robots whose paths conflict and can be coordinated; cost over the joint optimum")
    grid, places = FloorGrid.of(load_floorplan("office"), 0.6), team_places("office")
    assert places is not None
    cells = grid.cells(places.starts)
    for radius in (0.0, grid.in_cells(ROBOT)):
        allowed = grid_graph_of(grid.blocked, 8, radius).index[cells[:, 0], cells[:, 1]].astype(np.int64)
        report = f"office, predefined places, radius {radius * 0.6:.1f} m"
        compare_with_optimum(report, problems(grid.blocked, radius, 2, 40 * count, 2, allowed), count, 0, True)
    if (data / "office").is_dir():
        blocked = ~load_movingai(data / "office" / "fr079_60cm.map")
        for least in (0, 15):
            report = f"FR079, any places {least * 0.6:.0f} m apart or more, points"
            compare_with_optimum(report, problems(blocked, 0.0, 2, 40 * count, 2), count, least, least > 0)


def compare_with_optimum(report: str, candidates: Iterator[Problem], count: int, least: int, barred: bool) -> None:
    """Costs of two robots over the joint optimum, for ways alone of at least ``least`` steps."""
    rows: list[list[float]] = []
    for case in conflicting(candidates):
        alone = solve(case, "independent_astar").plan
        if min(len(path) - 1 for path in alone.paths) < least:
            continue
        optimum, coordinated = solve(case, "joint_astar").plan, solve(case, "coordination").plan
        if optimum.solved and coordinated.solved:
            others = [solve(case, m).plan for m in ("prioritized_astar", "prioritized_search")]
            rows.append([plan.cost / optimum.cost for plan in (*others, coordinated)])
        if len(rows) == count:
            break
    names = ("prioritized_astar", "prioritized_search", "coordination")
    for name, mean, bar in zip(names, np.mean(rows, axis=0), (1.05, 1.005, None), strict=True):
        bar = bar if barred else None
        show(f"{report}: {name}", f"{mean:.4f} ({len(rows)})", f"{bar or 'reported'}", bar is None or mean <= bar)


def certified(data: Path, count: int) -> None:
    """Cost over the certified optimum."""
    print("prioritized_search over the certified optimum (cbs, 2 s), 20 cm cells, discs of 20 cm radius")
    floors: dict[str, tuple[NDArray[np.bool_], NDArray[np.int64] | None]] = {"office": floor("office")}
    if (data / "office").is_dir():
        floors["FR079"] = (~load_movingai(data / "office" / "fr079_20cm.map"), None)
    for name, (blocked, _) in floors.items():
        ratios, all_cases = [], 0
        for robots in range(2, 7):
            for case in conflicting(problems(blocked, 1.0, robots, count // 4, 3)):
                all_cases += 1
                optimum = solve(case, "cbs", 2.0).plan
                if optimum.optimal:
                    ratios.append(solve(case, "prioritized_search").plan.cost / optimum.cost)
        show(
            f"{name}, 2 to 6 robots, {len(ratios)} of {all_cases} conflicts certified",
            f"mean {np.mean(ratios):.4f}, max {np.max(ratios):.4f}",
            "1.01",
            bool(np.mean(ratios) <= 1.01),
        )


def solved(data: Path, count: int) -> None:
    """Fig. 15 and 16: teams of 2 to 6 in two environments; and the hard cases."""
    print(
        "Fig. 15, 16: teams whose paths conflict; cost over the independent paths where both methods solve,"
        " share solved"
    )
    methods = ("prioritized_astar", "coordination", "prioritized_search")
    for name in ("office", "unstructured"):
        blocked, allowed = floor(name)
        for robots in range(2, 7):
            cases = list(itertools.islice(conflicting(problems(blocked, 1.0, robots, 40 * count, 4, allowed)), count))
            plans = [[solve(case, m, 0.1).plan for m in methods] for case in cases]
            both = [row for row in plans if row[0].solved and row[1].solved]
            cost = [np.mean([row[m].cost / row[0].lower_bound for row in both]) for m in range(3)]
            share = [float(np.mean([row[m].solved for row in plans])) for m in range(3)]
            asked = robots < 6 or name == "office" or (share[0] >= 0.993 and share[2] == 1.0)
            show(
                f"{name}, {robots} robots, {len(cases)} problems: prioritized, coordination, search",
                " ".join(f"{c:.3f}" for c in cost) + "  " + " ".join(f"{100 * s:.1f}%" for s in share),
                "cheaper" + (", 99.3%, 100%" if robots == 6 and name == "unstructured" else ""),
                bool(cost[0] < cost[1] and asked),
            )
    hard()
    crowded(count)


def hard() -> None:
    """Fig. 9 and 17."""
    for name, expected in (("passing", (True, False, True)), ("blocked", (False, False, True))):
        grid, places = FloorGrid.of(load_floorplan(name), 0.2), team_places(name)
        assert places is not None
        case = Problem(grid.blocked, grid.cells(places.starts), grid.cells(places.goals), grid.in_cells(ROBOT))
        plans = [solve(case, m).plan for m in ("prioritized_astar", "coordination", "prioritized_search")]
        outcome = tuple(plan.solved for plan in plans)
        costs = " ".join(f"{plan.cost:.0f}" for plan in plans)
        show(f"{name}: prioritized, coordination, search solved", costs, str(expected), outcome == expected)


def crowded(count: int) -> None:
    """14 robots in a cluttered map of 48 x 48 cells."""
    tried, answers, first = 0, [], []
    for seed in range(count):
        case = next(problems(cluttered(seed), 1.0, 14, 1, seed))
        tried += 1
        answers.append(solve(case, "prioritized_search", 1.0))
        first.append(solve(case, "prioritized_astar").plan.solved)
    done = sum(a.plan.solved for a in answers)
    show(
        f"cluttered 48 x 48, 14 robots, {tried} maps (prioritized {sum(first)})",
        f"{done}/{tried}",
        "all",
        done == tried,
    )


def warm_up() -> None:
    """Compile every kernel."""
    blocked = np.zeros((12, 12), np.bool_)
    case = Problem(blocked, np.array([(2, 2), (2, 9)]), np.array([(2, 9), (2, 2)]), 0.5)
    for method in (
        "independent_astar",
        "prioritized_astar",
        "coordination",
        "joint_astar",
        "prioritized_search",
        "cbs",
    ):
        solve(case, method)


PARTS: dict[str, tuple[Callable[[Path, int], None], bool]] = {
    "mapf": (mapf, False),
    "speed": (speed, True),
    "joint": (joint, False),
    "certified": (certified, False),
    "solved": (solved, False),
}


def main() -> None:
    """Print the parts that are asked for."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--data", type=Path, default=Path(__file__).parents[2] / "shared" / "data", help="recorded maps"
    )
    parser.add_argument("--problems", type=int, default=100, help="random problems of a kind")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="parts of the report")
    given = parser.parse_args()
    warm_up()
    for name in given.only:
        part, needs_data = PARTS[name]
        if needs_data and not given.data.is_dir():
            print(f"{name}: left out, there is no {given.data}")
            continue
        part(given.data, given.problems)


if __name__ == "__main__":
    main()
