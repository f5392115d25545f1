import heapq
import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError
from lidarena.planning.grid.grid_search import find_path, path_costs


def slow_costs(cost, start, diagonal):
    """Dijkstra as in a textbook."""
    steps = [(0, 1), (1, 0), (0, -1), (-1, 0)] + ([(1, 1), (1, -1), (-1, -1), (-1, 1)] if diagonal else [])
    rows, cols = cost.shape
    best = {start: 0.0}
    queue = [(0.0, start)]
    while queue:
        spent, (r, c) = heapq.heappop(queue)
        if spent > best[r, c]:
            continue
        for dr, dc in steps:
            y, x = r + dr, c + dc
            if not (0 <= y < rows and 0 <= x < cols) or math.isinf(cost[y, x]):
                continue
            if dr and dc and (math.isinf(cost[r, x]) or math.isinf(cost[y, c])):
                continue
            new = spent + math.hypot(dr, dc) * cost[y, x]
            if new < best.get((y, x), math.inf):
                best[y, x] = new
                heapq.heappush(queue, (new, (y, x)))
    return np.array([[best.get((r, c), math.inf) for c in range(cols)] for r in range(rows)])


def cost_of(cost, path):
    lengths = np.hypot(*np.diff(path, axis=0).T)
    return float((lengths * cost[path[1:, 0], path[1:, 1]]).sum())


@st.composite
def problems(draw):
    rows, cols = draw(st.integers(1, 9)), draw(st.integers(1, 9))
    values = draw(
        st.lists(
            st.sampled_from([math.inf, math.inf, 0.0, 0.5, 1.0, 1.0, 2.5, 7.0]),
            min_size=rows * cols,
            max_size=rows * cols,
        )
    )
    cell = st.tuples(st.integers(0, rows - 1), st.integers(0, cols - 1))
    return np.array(values).reshape(rows, cols), draw(cell), draw(cell), draw(st.booleans())


@settings(max_examples=200, deadline=None)
@given(problems())
def test_finds_the_cheapest_path(problem):
    cost, start, goal, diagonal = problem
    expected = slow_costs(cost, start, diagonal)
    np.testing.assert_allclose(path_costs(cost, start, diagonal), expected)
    path = find_path(cost, start, goal, diagonal)
    if math.isinf(expected[goal]):
        assert path.shape == (0, 2)
        return
    assert tuple(path[0]) == start and tuple(path[-1]) == goal
    assert cost_of(cost, path) == pytest.approx(expected[goal])
    steps = np.abs(np.diff(path, axis=0))
    assert (steps.max(axis=1) == 1).all() if len(steps) else start == goal
    if not diagonal:
        assert (steps.sum(axis=1) == 1).all()
    assert np.isfinite(cost[path[1:, 0], path[1:, 1]]).all()


@settings(max_examples=100, deadline=None)
@given(problems())
def test_never_cuts_a_corner(problem):
    cost, start, goal, _ = problem
    path = find_path(cost, start, goal)
    for (r0, c0), (r1, c1) in itertools.pairwise(path):
        if r0 != r1 and c0 != c1:
            assert np.isfinite(cost[r0, c1]) and np.isfinite(cost[r1, c0])


def test_prefers_a_detour_to_an_expensive_way():
    cost = np.ones((5, 5))
    cost[1:4, 2] = 20.0
    path = find_path(cost, (2, 0), (2, 4))
    assert 2 not in path[(path[:, 1] == 2)][:, 0]


def test_start_may_be_blocked_and_is_its_own_goal():
    cost = np.full((3, 3), np.inf)
    cost[1] = 1.0
    assert find_path(cost, (0, 1), (1, 2), diagonal=False).tolist() == [[0, 1], [1, 1], [1, 2]]
    assert find_path(cost, (0, 0), (0, 0)).tolist() == [[0, 0]]


def test_same_input_same_path():
    cost = np.ones((30, 30))
    paths = [find_path(cost, (3, 3), (25, 14)).tolist() for _ in range(3)]
    assert paths[0] == paths[1] == paths[2]


@pytest.mark.parametrize(
    ("cost", "start", "goal", "says"),
    [
        (np.ones(4), (0, 0), (0, 0), "shape"),
        (np.ones((0, 3)), (0, 0), (0, 0), "shape"),
        (np.array([[1.0, -2.0]]), (0, 0), (0, 1), "-2"),
        (np.array([[1.0, np.nan]]), (0, 0), (0, 1), "nan"),
        (np.ones((2, 2)), (2, 0), (0, 1), r"\(2, 0\)"),
        (np.ones((2, 2)), (0, 0), (0, -1), r"\(0, -1\)"),
    ],
)
def test_bad_input_is_refused(cost, start, goal, says):
    with pytest.raises(ConfigError, match=says):
        find_path(cost, start, goal)
