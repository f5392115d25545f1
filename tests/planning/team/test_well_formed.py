"""Well-formed problems are told from others, and are solved."""

import numpy as np

from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.plan import plan_team
from lidarena.planning.team.well_formed import is_well_formed
from tests.planning.team.problems import parse


def places_of(problem):
    graph = GridGraph(problem.grid, problem.connectivity, problem.radius)
    return graph, *(graph.index[tuple(cells.T)].astype(np.int64) for cells in (problem.starts, problem.goals))


def test_a_start_in_the_only_way_is_not_well_formed():
    graph, starts, goals = places_of(parse("a.b.A\n@@.@@\n..B..", 4))
    assert not is_well_formed(graph, starts, goals)


def test_a_way_round_makes_it_well_formed():
    graph, starts, goals = places_of(parse("a.b.A\n.....\n..B..", 4))
    assert is_well_formed(graph, starts, goals)


def test_discs_need_room_beside_each_other():
    drawing = "......A\n.......\na..b..B\n......."
    assert is_well_formed(*places_of(parse(drawing, 8, 0.0)))
    assert not is_well_formed(*places_of(parse("a...b...A\n....B....", 8, 0.5)))


def test_well_formed_problems_are_solved():
    rng, tried = np.random.default_rng(0), 0
    grid = rng.random((12, 12)) < 0.15
    graph = GridGraph(grid, 8, 0.5)
    while tried < 10:
        ends = np.stack([rng.choice(len(graph), 4, replace=False) for _ in range(2)])
        if is_well_formed(graph, ends[0], ends[1]):
            tried += 1
            cells = graph.cells[ends]
            assert plan_team(grid, *cells, "prioritized_search", 8, 0.5, np.inf, iterations=20).solved
