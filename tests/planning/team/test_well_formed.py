"""Well-formed problems are told from others, and every order of priority solves them."""

import itertools

import numpy as np

from lidarena.planning.team.roads import Roads
from lidarena.planning.team.traffic import Traffic
from lidarena.planning.team.well_formed import is_well_formed
from tests.planning.team.problems import parse


def places_of(problem):
    roads = Roads(problem.grid, problem.connectivity, problem.radius)
    return roads, *(roads.index[tuple(cells.T)].astype(np.int64) for cells in (problem.starts, problem.goals))


def test_a_start_in_the_only_way_is_not_well_formed():
    roads, starts, goals = places_of(parse("a.b.A\n@@.@@\n..B..", 4))
    assert not is_well_formed(roads, starts, goals)


def test_a_way_round_makes_it_well_formed():
    roads, starts, goals = places_of(parse("a.b.A\n.....\n..B..", 4))
    assert is_well_formed(roads, starts, goals)


def test_discs_need_room_beside_each_other():
    drawing = "......A\n.......\na..b..B\n......."
    assert is_well_formed(*places_of(parse(drawing, 8, 0.0)))
    roads, starts, goals = places_of(parse("." * 9 + "\n" + "a...b...A\n" + "....B....\n" + "." * 9, 8, 0.5))
    assert not is_well_formed(*places_of(parse("a...b...A\n....B....", 8, 0.5)))
    assert len(starts) == len(goals) == 2 and len(roads)


def test_every_order_of_priority_solves_a_well_formed_problem():
    rng, tried = np.random.default_rng(0), 0
    grid = rng.random((12, 12)) < 0.15
    roads = Roads(grid, 8, 0.5)
    while tried < 5:
        ends = np.stack([rng.choice(len(roads), 4, replace=False) for _ in range(2)])
        if not is_well_formed(roads, ends[0], ends[1]):
            continue
        tried += 1
        for order in itertools.permutations(range(4)):
            traffic = Traffic(roads, ends.T.copy())
            # those still to come stand at their starts: nobody is placed in the way of a robot with priority
            assert traffic.plan(np.array(order)) >= 1
            traffic.close()
