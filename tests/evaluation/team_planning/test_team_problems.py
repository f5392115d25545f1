"""Random problems for teams: apart, solvable alone, always the same; what claims to be solved is checked."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from lidarena.evaluation.team_planning import team_problems
from lidarena.evaluation.team_planning.team_problems import Problem, count_conflicts, problem_grid, problems, solve
from lidarena.planning.team.grid_graph import UNREACHABLE
from lidarena.planning.team.team_plan import TeamPlan
from tests.envs.corridor.corridor_worlds import gaps
from tests.planning.team.problems import meet


@pytest.mark.parametrize(("name", "robots"), [("office", 6), ("unstructured", 4)])
def test_problems_have_room_and_a_way_for_everybody(name: str, robots: int) -> None:
    grid = problem_grid(name, 0.2)
    assert len(grid.places) >= 20
    for problem in itertools.islice(problems(grid, robots, 3), 5):
        assert problem.radius == pytest.approx(1.0) and problem.starts.shape == problem.goals.shape == (robots, 2)
        assert (problem.starts != problem.goals).any(axis=1).all()
        for cells in (problem.starts, problem.goals):
            assert gaps(cells.astype(float)).min() >= 2.0
            assert {grid.graph.place(cell) for cell in cells} <= set(grid.places.tolist())
        for start, goal in zip(problem.starts, problem.goals, strict=True):
            assert grid.graph.ahead(grid.graph.place(goal))[grid.graph.place(start)] < UNREACHABLE


def test_the_problems_of_a_seed_are_always_the_same_and_those_of_another_are_others() -> None:
    grid = problem_grid("office", 0.2)
    first = [np.stack(problem[1:3]).tolist() for problem in itertools.islice(problems(grid, 3, 7), 4)]
    again = [np.stack(problem[1:3]).tolist() for problem in itertools.islice(problems(grid, 3, 7), 4)]
    other = [np.stack(problem[1:3]).tolist() for problem in itertools.islice(problems(grid, 3, 8), 4)]
    assert first == again and not any(problem in first for problem in other)
    assert all(problem != following for problem, following in itertools.pairwise(first))


def slow_conflicts(paths: list[list[tuple[int, int]]], apart: float) -> int:
    longest = max(map(len, paths))
    whole = [path + [path[-1]] * (longest - len(path)) for path in paths]
    return sum(
        any(meet(*ends, apart) for ends in zip(one, other, one[1:] + one[-1:], other[1:] + other[-1:], strict=True))
        for one, other in itertools.combinations(whole, 2)
    )


@pytest.mark.parametrize("apart", [0.0, 1.0, 1.6, 2.0])
def test_pairs_that_meet_anywhere_are_counted_once(apart: float) -> None:
    rng, counts = np.random.default_rng(0), set()
    for _ in range(25):
        paths = []
        for _ in range(4):
            steps = rng.integers(-1, 2, (rng.integers(0, 7), 2))
            walk = np.concatenate([[(0, 0)], np.cumsum(steps, axis=0)]) + rng.integers(0, 7, 2)
            paths.append(walk.astype(np.int64))
        plan = TeamPlan(False, paths, 0.0, 0.0, False, "")
        expected = slow_conflicts([[(int(r), int(c)) for r, c in path] for path in paths], apart)
        assert count_conflicts(plan, apart) == expected
        counts.add(expected)
    assert len(counts) > 2


def test_a_plan_that_is_not_what_it_claims_to_be_is_never_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Problem(np.zeros((1, 5), bool), np.array([(0, 0)]), np.array([(0, 3)]), 0.0, 4)
    honest = solve(problem, "independent_astar")
    assert honest.solved and honest.cost == 3.0
    for lie in (replace(honest, cost=2.0), replace(honest, paths=[honest.paths[0][:-1]])):
        monkeypatch.setattr(team_problems, "plan_team", lambda *arguments, lie=lie, **options: lie)
        with pytest.raises(AssertionError, match="prioritized_search: "):
            solve(problem, "prioritized_search")
