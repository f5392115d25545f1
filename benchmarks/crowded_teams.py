"""Teams in crowds, in mazes, on large maps and with ever new goals: how often they are solved, how dear, how lean.

python benchmarks/crowded_teams.py [--only tiny mazes large lifelong] [--cases 20] [--seed 0] [--limit 1.0] [--busy]

All maps are drawn here. The planners' limits are wall-clock time, of which a busy machine leaves them little;
with ``--busy`` they count the processor time of this process instead, and so tell what an idle machine would do.
"""

import argparse
import resource
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from team_oracle import is_solvable

from lidarena.base.errors import TeamError
from lidarena.base.terminal import make_output_printable
from lidarena.planning import plan_team, validate_plan
from lidarena.planning.team import budget
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
    return largest_part(height > np.quantile(height, 0.65))


def largest_part(blocked: Grid) -> Grid:
    """The same grid with all but its largest connected part blocked."""
    parts, _ = ndimage.label(~blocked)
    return np.asarray(parts != np.argmax(np.bincount(parts[~blocked])))


def tiny(cases: int, seed: int, limit: float) -> None:
    """2 to 9 robots on up to 16 cells, 100 problems a case; what was not solved is decided by ``team_oracle``."""
    rng, count, slowest = np.random.default_rng(seed), Counter[str](), 0.0
    while count.total() < 100 * cases:
        blocked = np.ones((rng.integers(2, 6), rng.integers(2, 6)), np.bool_)
        blocked.flat[rng.permutation(blocked.size)[: rng.integers(3, 17)]] = False
        robots = int(rng.integers(2, 10))
        if (~blocked).sum() < robots:
            continue
        starts, goals = draw_ends(blocked, robots, rng)
        connectivity, radius = int(rng.choice([4, 8])), float(rng.choice([0.0, 0.0, 0.5]))
        begin = time.process_time()
        try:
            plan = plan_team(blocked, starts, goals, "prioritized_search", connectivity, radius, limit)
        except TeamError:
            continue
        slowest = max(slowest, time.process_time() - begin)
        if plan.solved and validate_plan(plan, blocked, starts, goals, connectivity, radius):
            raise AssertionError("a plan is not what it says")
        solvable = plan.solved or is_solvable(blocked, starts, goals, connectivity, radius)
        proved = "There is no plan" in plan.message
        if proved and solvable:
            raise AssertionError("there is a plan, but that there is none was said to be proved")
        unsolved = "missed" if solvable else "proved unsolvable" if proved else "unsolvable, not proved"
        count["solved" if plan.solved else unsolved] += 1
    print(f"tiny: {dict(count)}, the slowest after {slowest:.2f} s of the processor")


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
        for case in range(max(cases // 4, 1)):
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


def draw_walls(rng: np.random.Generator) -> Grid:
    """A maze with loops, 17 to 21 cells a side: straight and bent walls grown from random places of a lattice."""
    rows, cols = (2 * int(n // 2) + 3 for n in rng.integers(17, 22, 2))
    density, longest, straight = rng.uniform(), int(rng.integers(1, 9)), rng.uniform(0.75, 0.85)
    blocked = np.zeros((rows, cols), np.bool_)
    blocked[[0, -1]], blocked[:, [0, -1]] = True, True
    ways = np.array([(0, 2), (2, 0), (0, -2), (-2, 0)])
    for _ in range(int(rows * cols * density / longest)):
        at, way = 2 * rng.integers(0, (rows // 2, cols // 2)), int(rng.integers(4))
        blocked[tuple(at)] = True
        for _ in range(longest):
            way = way if rng.random() < straight else int(rng.integers(4))
            there = at + ways[way]
            if (there < 0).any() or (there >= blocked.shape).any() or blocked[tuple(there)]:
                continue
            blocked[tuple(there)] = blocked[tuple((at + there) // 2)] = True
            at = there
    return largest_part(blocked[1:-1, 1:-1])


def warehouse(rng: np.random.Generator) -> Grid:
    """Racks of 5 x 2 cells, five in a row, with aisles of one cell between them and of three between rows."""
    blocked = np.zeros((28, 39), np.bool_)
    for row in range(5):
        for rack in range(5):
            blocked[3 + 5 * row : 5 + 5 * row, 5 + 6 * rack : 10 + 6 * rack] = True
    return blocked


def _random_goal(rng: np.random.Generator, free: NDArray[np.int64], robot: int, cell: NDArray[np.int64]) -> list[int]:
    row, col = rng.choice(free).tolist()
    return [row, col]


def lifelong(cases: int, seed: int, limit: float) -> None:
    """64 robots that go on to random cells for 256 steps; goals a step, and what ways without others would allow."""
    for name, draw in (("mazes with loops", draw_walls), ("warehouse", warehouse), ("mazes", draw_grid_maze)):
        rows = []
        for case in range(cases):
            rng = np.random.default_rng([seed, case])
            blocked = draw(rng)
            free = np.argwhere(~blocked)
            if len(free) < 128:
                continue
            graph = grid_graph_of(blocked, 4, 0.0)
            ways = np.mean([graph.ahead(int(p)).mean() / 4096 for p in rng.integers(len(graph), size=40)])
            begin = time.process_time()
            starts = free[rng.permutation(len(free))[:64]]
            goals_of = partial(_random_goal, rng, free)
            found = plan_lifelong(blocked, starts, goals_of, 256)
            rows.append((found.throughput, 64 / ways, 1e3 * (time.process_time() - begin) / 256))
        goals, alone, took = np.mean(rows, axis=0)
        spread = 1.96 * np.std([row[0] for row in rows]) / len(rows) ** 0.5
        print(
            f"lifelong: {name}, {len(rows)} maps, {goals:.2f} (+- {spread:.2f}) goals a step, "
            f"each robot alone {alone:.2f}, {took:.1f} ms a step, the slowest map {max(row[2] for row in rows):.1f} ms"
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
    parser.add_argument("--busy", action="store_true", help="let limits count processor time")
    given = parser.parse_args()
    if given.busy:
        vars(budget)["time"] = SimpleNamespace(perf_counter=time.process_time)
    plan_team(np.zeros((3, 3), np.bool_), [(0, 0), (0, 2)], [(0, 2), (0, 0)], "prioritized_search")  # loads the kernels
    for name in given.only:
        PARTS[name](given.cases, given.seed, given.limit)


if __name__ == "__main__":
    main()
