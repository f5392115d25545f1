"""The search with buckets against a plain Dijkstra."""

import heapq
import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.grid.known_ways import search_space, search_way, trace_way

STEPS = [(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)]


def step_cost(cost: np.ndarray, here: tuple[int, int], there: tuple[int, int]) -> int:
    """5 straight and 7 diagonally, times the dearest cell that is touched."""
    (r, c), (y, x) = here, there
    if r == y or c == x:
        return 5 * int(cost[y, x])
    return 7 * int(max(cost[y, x], cost[r, x], cost[y, c]))


def cheapest(cost: np.ndarray, start: tuple[int, int], goal: tuple[int, int]) -> int:
    """What the way costs, by Dijkstra's algorithm as in a textbook."""
    done: set[tuple[int, int]] = set()
    waiting = [(0, start)]
    while True:
        spent, here = heapq.heappop(waiting)
        if here == goal:
            return spent
        if here in done:
            continue
        done.add(here)
        for down, right in STEPS:
            there = here[0] + down, here[1] + right
            if 0 <= there[0] < cost.shape[0] and 0 <= there[1] < cost.shape[1]:
                heapq.heappush(waiting, (spent + step_cost(cost, here, there), there))


@settings(deadline=None)  # the first call loads or compiles the kernels
@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.2, 0.5]))
def test_a_way_costs_what_a_plain_dijkstra_says_and_is_the_way_that_was_found(seed: int, dear: float) -> None:
    rng, wide = np.random.default_rng(seed), 14
    space = search_space(wide)
    for _ in range(3):  # memory is used again
        cost = np.where(rng.random((wide, wide)) < dear, rng.choice([3, 20, 255], (wide, wide)), 1).astype(np.uint8)
        start, goal = (int(cell) for cell in rng.integers(wide * wide, size=2))
        found = search_way(cost, start, goal, space)
        assert found == cheapest(cost, divmod(start, wide), divmod(goal, wide))
        cells = np.full(wide * wide, -1, np.int32)
        count = trace_way(start, goal, space, cells)
        way = [divmod(int(cell), wide) for cell in cells[:count]]
        assert way[0] == divmod(start, wide) and way[-1] == divmod(goal, wide)
        assert sum(step_cost(cost, a, b) for a, b in itertools.pairwise(way)) == found


def test_a_way_that_is_too_long_to_be_remembered_is_remembered_from_its_start_on() -> None:
    space, cost = search_space(30), np.ones((30, 30), np.uint8)
    search_way(cost, 0, 29, space)
    cells = np.full(10, -1, np.int32)
    assert trace_way(0, 29, space, cells) == 30
    assert cells.tolist() == list(range(10))


@pytest.mark.parametrize("door", [True, False])
def test_a_wall_is_crossed_only_for_want_of_a_door(door: bool) -> None:
    cost = np.ones((20, 20), np.uint8)
    cost[:, 10] = 255
    if door:
        cost[19, 10] = 20
    space, cells = search_space(20), np.zeros(400, np.int32)
    search_way(cost, 0, 19, space)
    way = cells[: trace_way(0, 19, space, cells)]
    assert (19 * 20 + 10 in way) is door
