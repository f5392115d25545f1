import itertools
from pathlib import Path

import numpy as np
import pytest

from lidarena.planning.team.lacam_joint import GOES_ON, JointSearch, next_joint_move, open_nodes
from lidarena.planning.team.lacam_nodes import add_node, empty_nodes, find_slot
from lidarena.planning.team.pibt import team_step
from tests.planning.team.problems import Problem, crowded, faults, meet, plan, traffic_of
from tests.planning.team.test_lacam import is_solvable, tiny

INFINITE = float("inf")


def crowd(seed: int) -> Problem:
    """2 to 9 robots on up to 16 cells."""
    return crowded(seed, side=5, places=16, robots=9)


@pytest.mark.parametrize("seed", range(12))
def test_every_joint_move_is_tried_once_and_none_after_the_last(seed: int) -> None:
    problem = tiny(seed)
    traffic = traffic_of(problem)
    graph, starts = traffic.graph, traffic.ends[:, 0].astype(np.int32)
    nodes, step = empty_nodes(len(traffic), 8, 8), team_step(graph.arrays, traffic.ends[:, 1], 0)
    nodes.order[0] = np.arange(len(traffic))
    add_node(nodes, starts, find_slot(nodes, starts)[0], -1, traffic.ahead, traffic.ends[:, 1], np.arange(len(traffic)))
    step.here[:], step.occupant[starts] = starts, np.arange(len(traffic))
    tried = []
    while next_joint_move(np.int64(0), nodes, graph.arrays, traffic.ahead, step):
        tried.append(tuple(step.moves.tolist()))
    expected = set()
    for moves in itertools.product(*([m for m in range(9) if graph.neighbours[p, m] >= 0] for p in starts)):
        there = [graph.cells[graph.neighbours[p, m]] for p, m in zip(starts, moves, strict=True)]
        pairs = itertools.combinations(range(len(starts)), 2)
        here = graph.cells[starts]
        if not any(meet(here[i], here[j], there[i], there[j], 2 * problem.radius) for i, j in pairs):
            expected.add(moves)
    assert len(tried) == len(expected) and set(tried) == expected
    assert not next_joint_move(np.int64(0), nodes, graph.arrays, traffic.ahead, step)
    assert open_nodes(nodes)[2][0] == 0
    first = int(nodes.order[0, 0])
    left = [traffic.ahead[first, graph.neighbours[starts[first], moves[first]]] for moves in tried]
    assert left == sorted(left)  # the best moves of the first robot come first


@pytest.fixture
def oracle(monkeypatch: pytest.MonkeyPatch):
    """``team_oracle`` of the benchmarks, which decides larger problems than a search through all arrangements can."""
    monkeypatch.syspath_prepend(Path(__file__).parents[3] / "benchmarks")
    import team_oracle

    return team_oracle.is_solvable


def test_the_oracle_agrees_with_a_search_through_all_arrangements(oracle) -> None:
    answers = [(oracle(*problem), is_solvable(problem)) for problem in map(tiny, range(100, 140))]
    assert all(one == other for one, other in answers)
    assert {one for one, _ in answers} == {True, False}


def test_crowds_on_a_few_cells_are_solved_where_there_is_a_plan(oracle) -> None:
    for seed in range(40):
        problem = crowd(seed)
        found = plan(problem, "prioritized_search", time_limit=INFINITE, iterations=100, seed=seed)
        if found.solved:
            assert not faults(problem, found)
        else:
            assert not oracle(*problem), (seed, found.message)


def test_a_search_that_grows_remembers_how_often_it_went_on_from_where() -> None:
    traffic = traffic_of(crowd(26))
    nodes = empty_nodes(len(traffic), 64, 128)
    step, ranks = team_step(traffic.graph.arrays, traffic.ends[:, 1], 0), np.arange(len(traffic))
    nodes.order[0] = ranks
    starts = np.ascontiguousarray(traffic.ends[:, 0], np.int32)
    add_node(nodes, starts, find_slot(nodes, starts)[0], -1, traffic.ahead, traffic.ends[:, 1], ranks)
    search = JointSearch(traffic.graph.arrays, traffic.ahead, nodes, step, ranks, 4096)
    to_starts = np.stack([traffic.graph.ahead(int(start)) for start in starts])
    back = JointSearch.back(traffic.graph.arrays, to_starts, traffic.ends, ranks, 4096)
    while search.run(back, 1) == GOES_ON and len(search.nodes.parent) == 64:
        count = int(search._heap[2][0])
        before = sorted(zip(search._heap[1][:count].tolist(), search._heap[0][:count].tolist(), strict=True))
    assert len(search.nodes.parent) == 128
    count = int(search._heap[2][0])
    assert sorted(zip(search._heap[1][:count].tolist(), search._heap[0][:count].tolist(), strict=True)) == before
    assert any(key % 4 for _, key in before)  # some were gone on from


def test_where_nothing_is_left_to_try_the_search_ends() -> None:
    rows = ("...", "...")
    grid = np.array([[c == "@" for c in row] for row in rows])
    cells = np.argwhere(~grid)
    found = plan(Problem(grid, cells[:5], cells[[1, 0, 2, 3, 4]], 8, 0.5), "lacam", time_limit=INFINITE, iterations=50)
    assert not found.solved and "There is no plan" in found.message
