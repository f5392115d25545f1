import itertools
from functools import lru_cache

import numpy as np
import pytest

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.lacam import EXHAUSTED, FOUND, GOES_ON, Lacam
from lidarena.world.grid_mazes import draw_grid_maze
from tests.planning.team.problems import MOVES, Problem, crowded, faults, meet, plan, traffic_of

INFINITE = float("inf")
NARROW = "@@@@@@@ @{}@ @@@.@@@ @@@@@@@"
near = lru_cache(maxsize=None)(meet)


def is_solvable(problem: Problem) -> bool:  # noqa: C901 - all of it in one place, to be read
    """Whether any sequence of joint moves leads from the starts to the goals: all of them are gone through."""
    grid, starts, goals, connectivity, radius = problem
    free = {tuple(cell) for cell in np.argwhere(~grid).tolist()}
    goal = tuple(tuple(g) for g in goals.tolist())

    def moves(cell):
        for dr, dc in MOVES[: connectivity + 1]:
            to = cell[0] + dr, cell[1] + dc
            if to in free and (to[0], cell[1]) in free and (cell[0], to[1]) in free:
                yield to

    def joint(here, chosen):
        if len(chosen) == len(here):
            yield chosen
            return
        i = len(chosen)
        for to in moves(here[i]):
            if not any(near(here[j], here[i], chosen[j], to, 2 * radius) for j in range(i)):
                yield from joint(here, (*chosen, to))

    begin = tuple(tuple(s) for s in starts.tolist())
    met, waiting = {begin}, [begin]
    while waiting:
        here = waiting.pop()
        if here == goal:
            return True
        for following in joint(here, ()):
            if following not in met:
                met.add(following)
                waiting.append(following)
    return False


def tiny(seed: int) -> Problem:
    """A dense problem that ``plan_team`` accepts: 2 to 4 robots on 3 to 7 cells."""
    return crowded(seed, side=4, places=7, robots=4)


@pytest.mark.parametrize("method", ["lacam", "prioritized_search"])
@pytest.mark.parametrize("first", range(0, 100, 25))
def test_a_plan_is_found_wherever_a_joint_search_finds_one(method: str, first: int) -> None:
    unsolvable = 0
    for seed in range(first, first + 25):
        problem = tiny(seed)
        found = plan(problem, method, time_limit=INFINITE, iterations=20, seed=seed)
        assert found.solved == is_solvable(problem), (seed, found.message)
        if found.solved:
            assert not faults(problem, found)
        else:
            unsolvable += 1
            assert "There is no plan" in found.message
    assert unsolvable < 20


HARD = {
    "three make room again and again": Problem(
        np.array([[c == "@" for c in row] for row in NARROW.format(".....").split()]),
        np.array([(1, 1), (1, 2), (1, 5)]),
        np.array([(1, 5), (1, 4), (1, 1)]),
        4,
    ),
    "a reversed row at one pocket": Problem(
        np.array([[c == "@" for c in row] for row in ("@@@@.@@@@", ".........")]),
        np.array([(1, c) for c in range(4)]),
        np.array([(1, c) for c in range(3, -1, -1)]),
        4,
    ),
    "a full square but for one": Problem(
        np.zeros((3, 3), bool),
        np.array([(r, c) for r, c in itertools.product(range(3), range(3))][:8]),
        np.array([(r, c) for r, c in itertools.product(range(3), range(3))][:0:-1]),
        4,
    ),
    "a full square": Problem(
        np.zeros((3, 3), bool),
        np.array([(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)]),
        np.array([(0, 1), (1, 1), (0, 2), (0, 0), (1, 0), (2, 2), (2, 0), (1, 2), (2, 1)]),
        4,
    ),
}


@pytest.mark.parametrize("method", ["lacam", "prioritized_search"])
@pytest.mark.parametrize("name", HARD)
def test_robots_that_must_make_room_again_and_again_get_to_their_goals(name: str, method: str) -> None:
    found = plan(HARD[name], method, time_limit=INFINITE, iterations=60)
    assert found.solved, found.message
    assert not faults(HARD[name], found)


def test_the_plan_gets_better_with_time_up_to_the_optimum() -> None:
    found = plan(HARD["three make room again and again"], "lacam", time_limit=INFINITE, iterations=100)
    assert found.cost == 25 and "nothing better" in found.message  # 25: by joint search over all three


def test_a_maze_with_two_hundred_robots_is_solved() -> None:
    rng = np.random.default_rng(7)
    blocked = draw_grid_maze(rng)
    free = np.argwhere(~blocked)
    starts, goals = (free[rng.permutation(len(free))[:200]] for _ in range(2))
    traffic = traffic_of(Problem(blocked, starts, goals, 4))
    search = Lacam(traffic, 0)
    assert search.run(Budget(30.0), first=True) == FOUND
    paths, lengths = search.paths()
    traffic.adopt(paths, lengths)
    cells = np.stack([traffic.graph.cells[path] for path in paths])
    assert (cells[:, 0] == starts).all() and (cells[:, -1] == goals).all()
    assert (np.abs(np.diff(cells, axis=1)).sum(axis=2) <= 1).all()
    numbers = cells[..., 0] * 32 + cells[..., 1]
    for t, row in enumerate(numbers.T):
        assert len(set(row.tolist())) == 200, t
        if t:
            before = numbers[:, t - 1]
            swaps = {(a, b) for a, b in zip(before.tolist(), row.tolist(), strict=True) if a != b}
            assert not any((b, a) in swaps for a, b in swaps)
    assert lengths.sum() == traffic.cost()


def test_discs_of_two_cells_change_places_in_a_hall() -> None:
    starts = np.array([(2, 2), (2, 9), (6, 2), (6, 9)])
    problem = Problem(np.zeros((9, 12), bool), starts, starts[::-1], 8, 1.2)
    found = plan(problem, "lacam", time_limit=INFINITE, iterations=20)
    assert found.solved and not faults(problem, found)


def test_a_team_at_its_goals_has_nothing_to_do() -> None:
    cells = np.array([(0, 0), (0, 2)])
    found = plan(Problem(np.zeros((1, 3), bool), cells, cells), "lacam", time_limit=INFINITE, iterations=5)
    assert found.solved and found.cost == 0 and found.optimal


def test_the_search_is_the_same_again_and_goes_on_where_it_stopped() -> None:
    problem = HARD["a full square but for one"]
    searches = [Lacam(traffic_of(problem), 3) for _ in range(2)]
    assert searches[0].run(Budget(INFINITE, 0), first=False) == GOES_ON and not searches[0].found
    for search in searches:
        assert search.run(Budget(INFINITE, 10), first=False) in (GOES_ON, EXHAUSTED)
    (one, steps), (other, same) = (search.paths() for search in searches)
    assert np.array_equal(one, other) and np.array_equal(steps, same)
