"""Small problems for teams, and an optimum that is found by looking at everything."""

import heapq
import itertools
from typing import Any, NamedTuple

import numpy as np
from hypothesis import strategies as st

from lidarena.base.errors import TeamError
from lidarena.planning import TeamPlan, plan_team, validate_plan
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.search_arrays import NEVER, Reservations
from lidarena.planning.team.traffic import Traffic

MOVES = [(0, 0), (0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1)]


class Problem(NamedTuple):
    grid: np.ndarray
    starts: np.ndarray
    goals: np.ndarray
    connectivity: int = 8
    radius: float = 0.0


def parse(drawing, connectivity=8, radius=0.0):
    """A problem from a drawing: ``@`` blocked, ``a`` the start of the first robot, ``A`` its goal, row 0 on top."""
    rows = [line.strip() for line in drawing.strip().splitlines()]
    cells = {c: (r, k) for r, row in enumerate(rows) for k, c in enumerate(row) if c.isalpha()}
    names = sorted(c for c in cells if c.islower())
    grid = np.array([[c == "@" for c in row] for row in rows])
    starts = np.array([cells[n] for n in names])
    return Problem(grid, starts, np.array([cells[n.upper()] for n in names]), connectivity, radius)


def plan(problem, method, **options) -> TeamPlan:
    grid, starts, goals, connectivity, radius = problem
    return plan_team(grid, starts, goals, method, connectivity, radius, **options)


_TEAMS, _SIDES, _RADII = st.integers(1, 4), st.integers(2, 7), st.sampled_from([0.0, 0.0, 0.5])


@st.composite
def problems(draw, robots=_TEAMS, sides=_SIDES, radii=_RADII):
    """Random grids, starts and goals; only problems that ``plan_team`` accepts."""
    rows, cols = draw(sides), draw(sides)
    wall = draw(st.lists(st.integers(0, 3), min_size=rows * cols, max_size=rows * cols))
    grid = np.array(wall).reshape(rows, cols) == 0
    free = [tuple(cell) for cell in np.argwhere(~grid)]
    team = min(draw(robots), len(free) // 2)
    if team < 1:
        return draw(problems(robots, sides, radii))
    starts = draw(st.permutations(free))[:team]
    goals = draw(st.permutations(free))[:team]
    problem = Problem(grid, np.array(starts), np.array(goals), draw(st.sampled_from([4, 8])), draw(radii))
    try:
        plan(problem, "independent_astar")
    except TeamError:
        empty = np.zeros((rows, cols), bool)
        return problem._replace(grid=empty)
    return problem


def meet(a, b, c, d, apart):
    """Whether robots that go from a to c and from b to d in a step come closer than ``apart``, or meet."""
    gap = np.subtract(b, a).astype(float)
    change = np.subtract(d, c) - gap
    samples = [0.0, 1.0]
    if change @ change > 0:
        samples.append(float(np.clip(-(gap @ change) / (change @ change), 0, 1)))
    nearest = min(float(np.hypot(*(gap + s * change))) for s in samples)
    return nearest < max(apart - 1e-6, 1e-6)


def brute_force(problem) -> float:  # noqa: C901 - all of it in one place, to be read
    """The least sum of steps: Dijkstra over all robots' cells together and over who rests for good; inf if none."""
    grid, starts, goals, connectivity, radius = problem
    rows, cols = grid.shape

    def reached(cell):
        r, c = cell
        for dr, dc in MOVES[: connectivity + 1]:
            y, x = r + dr, c + dc
            if 0 <= y < rows and 0 <= x < cols and not (grid[y, x] or grid[r, x] or grid[y, c]):
                yield y, x

    goal = tuple(tuple(g) for g in goals)
    first = (tuple(tuple(s) for s in starts), (False,) * len(starts))
    best, queue, number = {first: 0}, [(0, 0, first)], itertools.count(1)
    while queue:
        spent, _, state = heapq.heappop(queue)
        if spent > best[state]:
            continue
        here, rests = state
        if here == goal:
            return spent
        for phase in itertools.product(
            *([r] if r or h != g else [False, True] for h, g, r in zip(here, goal, rests, strict=True))
        ):
            choices = [[h] if p else list(reached(h)) for h, p in zip(here, phase, strict=True)]
            price = phase.count(False)
            for there in itertools.product(*choices):
                pairs = itertools.combinations(range(len(here)), 2)
                if any(meet(here[i], here[j], there[i], there[j], 2 * radius) for i, j in pairs):
                    continue
                following = (there, phase)
                if spent + price < best.get(following, 10**9):
                    best[following] = spent + price
                    heapq.heappush(queue, (spent + price, next(number), following))
    return float("inf")


def faults(problem: Problem, found: TeamPlan) -> list[str]:
    """What an independent validator finds wrong with a plan."""
    return validate_plan(found, *problem)


def traffic_of(problem: Problem, **options: Any) -> Traffic:
    """The team of a problem on its graph, nobody placed."""
    grid, starts, goals, connectivity, radius = problem
    graph = GridGraph(grid, connectivity, radius)
    ends = np.stack([graph.index[tuple(starts.T)], graph.index[tuple(goals.T)]], axis=1).astype(np.int64)
    return Traffic(graph, ends, **options)


def hall(*ends: tuple[int, int], rows: int = 5, cols: int = 9) -> Traffic:
    """Robots between pairs of places of an empty grid."""
    return Traffic(GridGraph(np.zeros((rows, cols), bool), 8, 0.0), np.array(ends, np.int64))


def is_empty(reserved: Reservations) -> bool:
    """Whether no move is taken at any time."""
    return not reserved.counts.any() and bool((reserved.since == NEVER).all())


def taken_moves(reserved: Reservations, times: int) -> np.ndarray:
    """Whether each move from each place is taken in each step by somebody who passes: (n, times, 9)."""
    shifts = 4 * np.arange(9)
    counts = reserved.counts[reserved.rows].reshape(len(reserved.rows), -1)[:, :times]
    return (counts[:, :, None] >> shifts & 15) > 0


def crowded(seed: int, side: int, places: int, robots: int) -> Problem:
    """A dense problem that ``plan_team`` accepts: 2 or more robots on 3 or more cells, up to these numbers."""
    rng = np.random.default_rng(seed)
    while True:
        grid = np.ones((rng.integers(2, side + 1), rng.integers(2, side + 1)), bool)
        grid.flat[rng.permutation(grid.size)[: rng.integers(3, places + 1)]] = False
        cells, count = np.argwhere(~grid), int(rng.integers(2, robots + 1))
        if len(cells) < count:
            continue
        ends = [cells[rng.permutation(len(cells))[:count]] for _ in range(2)]
        problem = Problem(grid, ends[0], ends[1], int(rng.choice([4, 8])), float(rng.choice([0.0, 0.0, 0.5])))
        try:
            plan(problem, "independent_astar")
        except TeamError:
            continue
        return problem
