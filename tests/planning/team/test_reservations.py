"""Reservation tables against the definition of a conflict, place by place and time by time."""

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.moves import MOVES
from lidarena.planning.team.reservations import clear, has_room, move_between, release, reserve, rest
from lidarena.planning.team.route import free_from
from lidarena.planning.team.search_arrays import counts_at, empty_tables
from tests.planning.team.problems import is_empty, meet, taken_moves
from tests.planning.team.walks import Walks, cell, walks

TIMES = 16


class Tables:
    """Tables for the graph of some walks."""

    def __init__(self, team: Walks) -> None:
        places = len(team.graph)
        self.team = team
        self.reserved = empty_tables(places, TIMES).reserved
        self.until, self.since = self.reserved.until, self.reserved.since

    def arrays(self, robot: int) -> tuple:
        graph, length = self.team.graph, int(self.team.lengths[robot])
        return self.team.paths[robot], length, graph.arrays, self.reserved

    def taken(self, place: int, move: int, t: int) -> bool:
        reserved = t < self.until[place] and counts_at(self.reserved, place, t) >> 4 * move & 15
        return bool(reserved or t >= self.since[place, move])


def conflicts_with(team: Walks, robots: tuple[int, ...], place: int, move: int, t: int) -> bool:
    here = team.graph.cells[place]
    there = here + MOVES[move]
    return any(meet(here, cell(team, r, t), there, cell(team, r, t + 1), team.graph.apart) for r in robots)


@settings(max_examples=15, deadline=None)
@given(walks(robots=2, most=6))
def test_a_move_is_taken_exactly_where_it_would_conflict(team: Walks) -> None:
    tables = Tables(team)
    for robot in (0, 1):
        reserve(*tables.arrays(robot))
    for place, move in itertools.product(range(len(team.graph)), range(9)):
        if team.graph.neighbours[place, move] >= 0:
            for t in range(int(team.lengths.max()) + 2):
                assert tables.taken(place, move, t) == conflicts_with(team, (0, 1), place, move, t), (place, move, t)


@settings(max_examples=30, deadline=None)
@given(walks(robots=2))
def test_clearing_empties_what_reserving_filled(team: Walks) -> None:
    tables, alone = Tables(team), Tables(team)
    for robot in (0, 1):
        reserve(*tables.arrays(robot))
    clear(*tables.arrays(0))
    last = team.lengths[1]
    rest(team.paths[1, last], last, team.graph.arrays, tables.reserved)  # whoever rests nearby is entered again
    reserve(*alone.arrays(1))
    assert np.array_equal(taken_moves(tables.reserved, TIMES), taken_moves(alone.reserved, TIMES))
    assert np.array_equal(tables.since, alone.since)
    clear(*tables.arrays(1))
    assert is_empty(tables.reserved)
    release(tables.reserved)
    assert not tables.reserved.rows.any() and tables.reserved.used[0] == 1 and not tables.until.any()


@settings(max_examples=20, deadline=None)
@given(walks(robots=1))
def test_there_is_room_for_a_path_until_the_rows_are_used_up(team: Walks) -> None:
    tables = Tables(team)
    for _ in range(40):
        if not has_room(int(team.lengths[0]), team.graph.arrays, tables.reserved):
            break
        reserve(*tables.arrays(0))
        assert tables.reserved.used[0] <= len(tables.reserved.counts)
        tables.reserved.used[0] += 100
    assert not has_room(10**6, team.graph.arrays, tables.reserved)


@settings(max_examples=30, deadline=None)
@given(walks(robots=2), st.data())
def test_a_goal_is_free_once_nobody_comes_close_any_more(team: Walks, data: st.DataObject) -> None:
    tables, goal = Tables(team), data.draw(st.integers(0, len(team.graph) - 1))
    for robot in (0, 1):
        reserve(*tables.arrays(robot))
    last = int(team.lengths.max()) + 1
    busy = [t for t in range(last + 1) if conflicts_with(team, (0, 1), goal, 0, t)]
    expected = -1 if last in busy else max(busy, default=-1) + 1
    assert free_from(tables.reserved, goal) == expected


def test_a_move_is_told_by_where_it_leads() -> None:
    graph = GridGraph(np.zeros((4, 5), bool), 8, 0.0)
    for here, there in itertools.product(range(len(graph)), repeat=2):
        step = tuple(graph.cells[there] - graph.cells[here])
        expected = [tuple(move) for move in MOVES].index(step) if max(map(abs, step)) <= 1 else -1
        assert move_between(graph.neighbours, here, there) == expected
