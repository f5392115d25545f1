import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.deviation import DeviationCosts
from lidarena.planning.team.grid_graph import STEP, GridGraph
from lidarena.planning.team.traffic import Traffic

KNOTS = st.lists(st.tuples(st.floats(0.1, 1.5), st.floats(0.0, 9.0)), min_size=1, max_size=4)


def team(seed: int) -> Traffic:
    """Two robots placed in a hall with a few pillars."""
    rng = np.random.default_rng(seed)
    grid = rng.random((8, 9)) < 0.1
    graph = GridGraph(grid, 8, 0.0)
    traffic = Traffic(graph, rng.permutation(len(graph))[:4].reshape(2, 2).astype(np.int64), timed=True)
    traffic.plan(np.array([0, 1]))
    return traffic


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.0, 9.0), KNOTS)
def test_a_place_costs_what_its_distance_to_the_path_says_at_every_time(
    seed: int, first: float, more: list[tuple[float, float]]
) -> None:
    distances = np.concatenate([[0.0], np.cumsum([gap for gap, _ in more])])
    costs = np.array([first, *(cost for _, cost in more)])
    traffic = team(seed)
    DeviationCosts(np.stack([distances, costs], axis=1)).add(traffic, 0)
    cells, path = traffic.graph.cells, traffic.paths[0]
    for t in (0, 1, 3, int(traffic.lengths[0]), len(traffic.layer) - 1):
        centre = cells[path[min(t, traffic.lengths[0])]]
        for place, cell in enumerate(cells):
            away = math.dist(cell, centre)
            expected = np.interp(away, distances, costs) * int(STEP) if away <= distances[-1] else 0.0
            assert abs(traffic.layer[t, place] - expected) <= 0.5 + 1e-6


def test_the_costs_of_several_robots_add_up() -> None:
    knots = [(0.0, 2.0), (3.0, 0.0)]
    both, alone = team(3), [team(3), team(3)]
    for robot in (0, 1):
        DeviationCosts(knots).add(both, robot)
        DeviationCosts(knots).add(alone[robot], robot)
    np.testing.assert_array_equal(both.layer, alone[0].layer + alone[1].layer)
