import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.conflicts import conflict_times, find_blocking_agents, first_conflict
from lidarena.planning.team.grid_graph import GridGraph
from tests.planning.team.problems import meet
from tests.planning.team.walks import Walks, conflicts, walks


def slow_first(team: Walks, one: int, other: int, begin: int = 0) -> int:
    """The first conflicting step from ``begin`` on, with a look beyond both walks' ends."""
    last = max(int(team.lengths[one]), int(team.lengths[other]), begin) + 2
    return next((t for t in range(begin, last) if conflicts(team, one, other, t)), -1)


@settings(max_examples=60, deadline=None)
@given(walks())
def test_each_pair_has_the_first_step_in_which_it_meets(team: Walks) -> None:
    times = conflict_times(team.graph.cells, team.paths, team.lengths, team.graph.apart)
    assert np.array_equal(times, times.T)
    assert (np.diag(times) == -1).all()
    for i in range(len(team.lengths)):
        for j in range(i):
            assert times[i, j] == slow_first(team, i, j)


@settings(max_examples=40, deadline=None)
@given(walks(robots=2), st.integers(0, 12))
def test_what_happened_before_is_not_looked_at(team: Walks, begin: int) -> None:
    (one, other), (a, b) = team.paths, team.lengths.tolist()
    found = first_conflict(team.graph.cells, one, a, other, b, team.graph.apart, begin)
    assert found == slow_first(team, 0, 1, begin)


CORRIDOR = GridGraph(np.zeros((1, 12), bool), 4, 0.0)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, 5))
def test_blocking_agents_are_those_whom_the_straight_way_meets(seed: int, begin: int) -> None:
    """In a corridor there is one shortest way, so that nothing is left to chance."""
    rng = np.random.default_rng(seed)
    lengths = np.concatenate([[5], rng.integers(0, 8, 3)])
    paths = np.zeros((4, 20), np.int32)
    for robot, length in enumerate(lengths):
        steps = np.cumsum(rng.integers(-1, 2, length))
        paths[robot, : length + 1] = np.clip(np.concatenate([[0], steps]) + rng.integers(12), 0, 11)
    goal = int(rng.integers(12))
    found = np.zeros(4, np.bool_)
    arrays = (CORRIDOR.cells, CORRIDOR.neighbours, CORRIDOR.ahead(goal), paths, lengths, 0.0)
    find_blocking_agents(0, begin, *arrays, rng.integers(8, size=16), found, np.empty(16, np.int32))
    here, t, expected = int(paths[0, begin]), begin, {0: False, 1: False, 2: False, 3: False}
    while here != goal or t < lengths.max():
        there = here + int(np.sign(goal - here))
        for other in (1, 2, 3):
            a, b = (int(paths[other, min(s, lengths[other])]) for s in (t, t + 1))
            expected[other] |= meet((0, here), (0, a), (0, there), (0, b), 0.0)
        here, t = there, t + 1
    assert found.tolist() == list(expected.values())
