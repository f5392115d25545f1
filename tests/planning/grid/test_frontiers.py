import math
from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lidarena.base.errors import ConfigError
from lidarena.planning.grid.frontiers import find_frontiers, nearest_cell

RES = 0.05
maps = arrays(
    np.int8, st.tuples(st.integers(1, 10), st.integers(1, 10)), elements=st.sampled_from([-1, -1, 0, 0, 0, 100])
)


def picture(*rows):
    """' ' free, '?' unknown, '#' occupied; first row = row 0."""
    return np.array([[{" ": 0, "?": -1, "#": 100}[char] for char in row] for row in rows], np.int8)


def around(cell, eight):
    r, c = cell
    steps = [(dr, dc) for dr in (-1, 0, 1) for dc in (-1, 0, 1) if (dr or dc) and (eight or not (dr and dc))]
    return [(r + dr, c + dc) for dr, dc in steps]


def flood(cells, start, eight):
    seen, queue = {start}, deque([start])
    while queue:
        for cell in around(queue.popleft(), eight):
            if cell in cells and cell not in seen:
                seen.add(cell)
                queue.append(cell)
    return seen


def slow_frontiers(grid, start):
    """Sets of frontier cells that touch the free space of a free start, by the definition."""
    free = {tuple(cell) for cell in np.argwhere(grid == 0).tolist()}
    edge = {
        tuple(cell) for cell in np.argwhere(grid < 0).tolist() if any(n in free for n in around(tuple(cell), False))
    }
    reached = flood(free, start, False)
    touching = {cell for cell in edge if any(n in reached for n in around(cell, False))}
    return {frozenset(flood(edge, cell, True)) for cell in touching}, reached


@settings(max_examples=300, deadline=None)
@given(maps, st.data())
def test_agrees_with_the_definition(grid, data):
    free = np.argwhere(grid == 0).tolist()
    if not free:
        assert find_frontiers(grid, (0, 0), RES, 0.0) == []
        return
    start = tuple(data.draw(st.sampled_from(free)))
    expected, reached = slow_frontiers(grid, start)
    found = find_frontiers(grid, start, RES, 0.0)
    assert {frozenset(map(tuple, f.cells.tolist())) for f in found} == expected
    assert len(found) == len(expected)
    for frontier in found:
        assert frontier.size == len(frontier.cells)
        assert frontier.min_distance == pytest.approx(min(math.dist(cell, start) for cell in frontier.cells.tolist()))
        assert frontier.centroid == pytest.approx(tuple(frontier.cells.mean(axis=0)))
        assert frontier.cost == pytest.approx(1e-3 * frontier.min_distance * RES - frontier.size * RES)
        assert frontier.goal in reached
        assert math.dist(frontier.goal, frontier.centroid) == pytest.approx(
            min(math.dist(cell, frontier.centroid) for cell in reached)
        )
    assert [f.cost for f in found] == sorted(f.cost for f in found)


def test_small_frontiers_are_dropped_and_the_largest_comes_first():
    grid = np.zeros((30, 40), np.int8)
    grid[:, 0], grid[:, -1], grid[-1] = -1, -1, 100
    grid[10:, -1] = 100
    grid[0] = 100
    first, second = find_frontiers(grid, (15, 35), RES, min_frontier_size=0.4)
    assert (first.size, second.size) == (28, 9)
    assert first.min_distance > second.min_distance
    assert [f.size for f in find_frontiers(grid, (15, 35), RES, min_frontier_size=0.5)] == [28]


def test_distance_can_be_made_to_count():
    grid = np.zeros((30, 40), np.int8)
    grid[:, 0], grid[:, -1], grid[-1], grid[0] = -1, -1, 100, 100
    grid[15:, -1] = 100
    assert find_frontiers(grid, (5, 35), RES)[0].size == 28
    assert find_frontiers(grid, (5, 35), RES, potential_scale=1.0)[0].size == 14


def test_nothing_behind_a_wall_is_found():
    grid = picture("     ", " ### ", " #?# ", " ### ", "     ")
    assert find_frontiers(grid, (0, 0), RES, 0.0) == []


def test_a_start_that_is_not_free_moves_to_the_nearest_free_cell():
    grid = picture("####", "#??#", "#  #", "####")
    (frontier,) = find_frontiers(grid, (1, 1), RES, 0.0)
    assert frontier.size == 2


def test_goals_can_be_restricted():
    grid = picture("?   ", "?   ", "?   ")
    goals = np.zeros(grid.shape, bool)
    goals[0, 3] = True
    assert find_frontiers(grid, (1, 1), RES, 0.0, goals=goals)[0].goal == (0, 3)
    assert find_frontiers(grid, (1, 1), RES, 0.0, goals=np.zeros(grid.shape, bool)) == []


def test_nearest_cell_takes_the_first_of_equals():
    mask = np.array([[1, 0, 1], [0, 0, 0], [1, 0, 1]], bool)
    assert nearest_cell(mask, 1.0, 1.0) == (0, 0)
    assert nearest_cell(mask, 1.2, 1.1) == (2, 2)
    assert nearest_cell(np.zeros((2, 2), bool), 0.0, 0.0) == (-1, -1)


@settings(max_examples=200, deadline=None)
@given(
    arrays(bool, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.sampled_from([False, False, True])),
    st.sampled_from([-3.0, 0.0, 1.25, 2.5, 4.0, 6.7, 12.0]),
    st.sampled_from([-2.0, 0.0, 1.5, 3.0, 5.3, 11.0]),
)
def test_nearest_cell_agrees_with_looking_at_all(mask, row, col):
    cells = np.argwhere(mask).tolist()
    expected = min(cells, key=lambda cell: (cell[0] - row) ** 2 + (cell[1] - col) ** 2, default=[-1, -1])
    assert list(nearest_cell(mask, row, col)) == expected


@pytest.mark.parametrize(("start", "resolution", "says"), [((5, 0), RES, r"\(5, 0\)"), ((0, 0), 0.0, "resolution")])
def test_bad_input_is_refused(start, resolution, says):
    with pytest.raises(ConfigError, match=says):
        find_frontiers(np.zeros((3, 3), np.int8), start, resolution)
