"""Teams in crowds, in mazes, on large maps and with ever new goals: how often they are solved, how dear, how lean.

python benchmarks/crowded_teams.py [--only tiny mazes large lifelong] [--cases 20] [--seed 0] [--limit 1.0]

All maps are drawn here. Times are processor time; the planners' limits are wall-clock time, so that a busy machine
leaves them less.
"""

import argparse
import resource
import time
from collections import Counter
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import TeamError
from lidarena.base.terminal import make_output_printable
from lidarena.planning import plan_team, validate_plan
from lidarena.planning.team.grid_graph import grid_graph_of
from lidarena.planning.team.lifelong import plan_lifelong
from lidarena.world.grid_mazes import draw_grid_maze

Grid = NDArray[np.bool_]


def draw_ends(blocked: Grid, robots: int, rng: np.random.Generator) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Starts and goals (robots, 2) on different cells each."""
    free = np.argwhere(~blocked)
    return free[rng.permutation(len(free))[:robots]], free[rng.permutation(len(free))[:robots]]


def landscape(rng: np.random.Generator, side: int) -> Grid:
    """Lakes and woods like a game's map, a third of it blocked; only its largest part is free."""
    import cv2

    coarse, fine = rng.random((side // 8, side // 8)), rng.random((side // 3, side // 3))
    height = cv2.resize(coarse, (side, side), interpolation=cv2.INTER_CUBIC)
    height = height + 0.5 * cv2.resize(fine, (side, side), interpolation=cv2.INTER_CUBIC)
    blocked = height > np.quantile(height, 0.65)
    _, parts = cv2.connectedComponents((~blocked).astype(np.uint8), connectivity=4)
    largest = int(np.argmax(np.bincount(parts[~blocked])))
    return np.asarray(parts != largest)


def tiny(cases: int, seed: int, limit: float) -> None:
    """2 to 9 robots on up to 16 cells, 100 problems a case: solved, proved unsolvable, or neither."""
    rng, count = np.random.default_rng(seed), Counter[str]()
    while count.total() < 100 * cases:
        blocked = np.ones((rng.integers(2, 6), rng.integers(2, 6)), np.bool_)
        blocked.flat[rng.permutation(blocked.size)[: rng.integers(3, 17)]] = False
        robots = int(rng.integers(2, 10))
        if (~blocked).sum() < robots:
            continue
        starts, goals = draw_ends(blocked, robots, rng)
        connectivity, radius = int(rng.choice([4, 8])), float(rng.choice([0.0, 0.0, 0.5]))
        try:
            plan = plan_team(blocked, starts, goals, "prioritized_search", connectivity, radius, limit)
        except TeamError:
            continue
        if plan.solved and validate_plan(plan, blocked, starts, goals, connectivity, radius):
            raise AssertionError("a plan is not what it says")
        proved = "There is no plan" in plan.message
        count["solved" if plan.solved else "proved unsolvable" if proved else "undecided"] += 1
    print("tiny:", dict(count))


def mazes(cases: int, seed: int, limit: float) -> None:
    """200 robots in mazes of 32 x 32 cells with corridors of two."""
    ratios = []
    for case in range(cases):
        rng = np.random.default_rng([seed, case])
        blocked = draw_grid_maze(rng)
        plan = plan_team(blocked, *draw_ends(blocked, 200, rng), "prioritized_search", 4, 0.0, limit)
        ratios.append(plan.cost / plan.lower_bound)
    solved = np.isfinite(ratios)
    print(
        f"mazes: {solved.sum()} of {cases} solved in {limit:g} s, {np.mean(np.array(ratios)[solved]):.3f} of the bound"
    )


def large(cases: int, seed: int, limit: float) -> None:
    """200 robots on maps of 256 and 194 cells a side."""
    for side in (256, 194):
        for case in range(max(cases // 10, 1)):
            rng = np.random.default_rng([seed, side, case])
            blocked = landscape(rng, side)
            ends = draw_ends(blocked, 200, rng)
            begin = time.perf_counter(), time.process_time()
            plan = plan_team(blocked, *ends, "prioritized_search", 4, 0.0, limit)
            wall, used = time.perf_counter() - begin[0], time.process_time() - begin[1]
            memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            print(
                f"large: {side} x {side}, {plan.cost / plan.lower_bound:.4f} of the bound, {wall:.2f} s, "
                f"{used:.2f} s of the processor, at most {memory:.0f} MB"
            )


def lifelong(cases: int, seed: int, limit: float) -> None:
    """64 robots that go on to random cells for 500 steps; goals a step, and what ways without others would allow."""
    rng = np.random.default_rng(seed)
    blocked = draw_grid_maze(rng)
    free = np.argwhere(~blocked)
    graph = grid_graph_of(blocked, 4, 0.0)
    ways = np.mean([graph.ahead(int(p)).mean() / 4096 for p in rng.integers(len(graph), size=40)])
    for futures, horizon in ((1, 1), (8, 6), (16, 12)):
        starts = free[rng.permutation(len(free))[:64]]
        begin = time.process_time()
        found = plan_lifelong(
            blocked, starts, lambda robot, cell: free[rng.integers(len(free))], 500, futures=futures, horizon=horizon
        )
        took = 1e3 * (time.process_time() - begin) / 500
        print(
            f"lifelong: maze, 64 robots, {futures} futures of {horizon} steps: {found.throughput:.2f} goals a step "
            f"(alone {64 / ways:.2f}), {took:.1f} ms a step"
        )


PARTS: dict[str, Callable[[int, int, float], None]] = {
    "tiny": tiny,
    "mazes": mazes,
    "large": large,
    "lifelong": lifelong,
}


def main() -> None:
    """Print the parts that are asked for."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="parts of the report")
    parser.add_argument("--cases", type=int, default=20, help="problems of a kind")
    parser.add_argument("--seed", type=int, default=0, help="of the maps")
    parser.add_argument("--limit", type=float, default=1.0, help="of a plan [s]")
    given = parser.parse_args()
    plan_team(np.zeros((3, 3), np.bool_), [(0, 0), (0, 2)], [(0, 2), (0, 0)], "prioritized_search")  # loads the kernels
    for name in given.only:
        PARTS[name](given.cases, given.seed, given.limit)


if __name__ == "__main__":
    main()
