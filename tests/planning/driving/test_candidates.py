import numpy as np

from lidarena.planning.driving.candidates import (
    COARSE,
    find_frontier_candidates,
    lengths_from_robot,
    measure_ways_between,
)
from lidarena.planning.driving.explorer import CHOOSES, advance, command, set_out
from lidarena.planning.driving.goals import give_up
from lidarena.planning.grid.frontiers import find_frontiers
from lidarena.planning.grid.grid_search import path_costs
from tests.planning.driving.worlds import hired, make_world, perceived


def test_candidates_are_the_frontiers_and_the_ways_to_and_between_them() -> None:
    env, info = make_world(3, map="maze:9?width=8&height=8&loops=0.3")
    driver, settings, explorers = hired(env, info)
    looked = 0
    for _ in range(120):
        told = perceived(info)
        if advance(0, 0.0, told, driver, settings, explorers) == CHOOSES:
            candidates, ground = explorers.candidates, explorers.drive.ground
            rows, columns = ground.extent[0, 2:].tolist()
            shape, cell = (rows, columns), tuple(ground.cell[0].tolist())
            occupancy = ground.occupancy[0, : rows * columns].reshape(shape)
            reachable = ground.reachable[0, : rows * columns].reshape(shape)
            cost = ground.cost[0, : rows * columns].reshape(shape)
            found = find_frontiers(occupancy, cell, 0.05, 0.2, goals=reachable)
            count = candidates.number[0]
            assert {frontier.goal for frontier in found} >= {tuple(one) for one in candidates.cell[0, :count].tolist()}
            lengths = path_costs(np.where(np.isfinite(cost), 1.0, np.inf), cell) * 0.05
            assert np.array_equal(lengths_from_robot(0, explorers.drive), lengths)
            assert [lengths[tuple(one)] for one in candidates.cell[0, :count].tolist()] == candidates.way[
                0, :count
            ].tolist()
            looked += count > 1
            set_out(0, 0, told, driver, explorers)
        info = env.step(command(0, told, driver, explorers))[4]
    assert looked > 5


def test_none_is_pursued_once_the_frontier_that_is_driven_to_has_been_given_up() -> None:
    env, info = make_world(3, map="maze:9?width=8&height=8&loops=0.3")
    driver, settings, explorers = hired(env, info)
    candidates, accounts, tried = explorers.candidates, explorers.accounts, 0
    for _ in range(120):
        told = perceived(info)
        status, pursued = advance(0, 0.0, told, driver, settings, explorers), candidates.pursued[0]
        if status == CHOOSES and pursued >= 0 and candidates.number[0] > 1:
            count, goals = accounts.given_up_count[0], candidates.goals[0, pursued].copy()
            for x, y in goals.tolist():
                give_up(0, x, y, accounts)
            lengths = lengths_from_robot(0, explorers.drive)
            find_frontier_candidates(0, 0.2, lengths, explorers.drive, accounts, candidates)
            assert candidates.pursued[0] == -1
            accounts.given_up_count[0] = count
            find_frontier_candidates(0, 0.2, lengths, explorers.drive, accounts, candidates)
            assert candidates.pursued[0] == pursued
            tried += 1
        if status == CHOOSES:
            set_out(0, 0, told, driver, explorers)
        info = env.step(command(0, told, driver, explorers))[4]
    assert tried > 5


def test_the_distance_advantage_is_that_of_a_plain_dijkstra_on_blocks() -> None:
    env, info = make_world(3, map="maze:9?width=8&height=8&loops=0.3")
    driver, settings, explorers = hired(env, info)
    for _ in range(60):
        told = perceived(info)
        if advance(0, 0.0, told, driver, settings, explorers) == CHOOSES:
            set_out(0, 0, told, driver, explorers)
        info = env.step(command(0, told, driver, explorers))[4]
    candidates, ground = explorers.candidates, explorers.drive.ground
    measure_ways_between(0, 15.0, explorers.drive, candidates)
    rows, columns = ground.extent[0, 2:].tolist()
    reachable = ground.reachable[0, : rows * columns].reshape(rows, columns)
    whole = np.zeros((-(-rows // COARSE) * COARSE, -(-columns // COARSE) * COARSE), np.bool_)
    whole[:rows, :columns] = reachable
    blocks = whole.reshape(len(whole) // COARSE, COARSE, -1, COARSE).any(axis=(1, 3))
    robot = tuple((ground.cell[0] // COARSE).tolist())
    cells = [tuple((cell // COARSE).tolist()) for cell in candidates.cell[0, : candidates.number[0]]]
    for k, cell in enumerate(cells):
        lengths = path_costs(np.where(blocks, 1.0, np.inf), cell) * 0.05 * COARSE
        own = [lengths[other] for j, other in enumerate(cells) if j != k]
        measured = np.delete(candidates.between[0, k, : len(cells)], k)
        assert np.allclose(measured, own)
        assert np.isclose(candidates.between[0, k, k], lengths[np.isfinite(lengths)].mean() - lengths[robot])
