import itertools
import math

import numpy as np
import pytest

from lidarena.baselines.exploration.topological_graph import TopologicalGraph
from lidarena.planning.grid.inflation import clearance
from lidarena.planning.grid.surroundings import Surroundings
from tests.baselines.exploration.fake_exploration import drawn

RES = 0.05


def surroundings(*rows, side=20):
    occupancy = drawn(*rows, side=side).astype(np.int8) * 100
    return Surroundings(clearance(occupancy, RES), occupancy > 0, RES, (0.0, 0.0))


HALL = surroundings("##########", "#        #", "#        #", "##########")
RING = surroundings("#######", "#     #", "# ### #", "# ### #", "#     #", "#######")


def drive(graph, around, *corners, step=0.25):
    """Drive along straight lines; uncertainty grows with every metre."""
    for start, end in itertools.pairwise(corners):
        n = max(1, round(math.dist(start, end) / step))
        for x, y in np.linspace(start, end, n + 1):
            graph.update(np.array([x, y, 0.0]), float(len(graph.positions)), around)


def test_nodes_are_made_every_node_distance_in_the_open():
    graph = TopologicalGraph(2.0)
    drive(graph, HALL, (1.5, 1.5), (8.5, 1.5))
    assert graph.positions == [(1.5, 1.5), (3.75, 1.5), (6.0, 1.5), (8.25, 1.5)]
    assert graph.edges == {(0, 1), (1, 2), (2, 3)}
    assert graph.current == 3
    assert graph.distances() == pytest.approx([6.75, 4.5, 2.25, 0.0])
    assert graph.uncertainties == [0.0, 1.0, 2.0, 3.0]


def test_a_node_out_of_sight_does_not_count():
    graph = TopologicalGraph(2.5)
    drive(graph, RING, (3.0, 1.5), (1.5, 1.5), (1.5, 2.9))
    assert len(graph.positions) == 2  # behind the corner, though 2.1 m away


def test_coming_back_joins_the_nodes_and_shortens_the_way():
    graph = TopologicalGraph(2.5)
    corners = (1.5, 1.5), (5.5, 1.5), (5.5, 4.5), (1.5, 4.5), (1.5, 4.2)
    drive(graph, RING, *corners)
    last = graph.current
    assert last not in (None, 0)
    before = graph.distances()[0]
    assert before > 8.0
    drive(graph, RING, (1.5, 4.2), (1.5, 1.5))
    assert graph.current == 0
    assert (0, last) in graph.edges
    assert graph.distances()[last] < 5.0


def test_driving_to_and_fro_adds_nothing():
    graph = TopologicalGraph(2.0)
    drive(graph, HALL, (1.5, 1.5), (8.5, 1.5))
    nodes, edges = list(graph.positions), set(graph.edges)
    drive(graph, HALL, (8.5, 1.5), (1.5, 1.5), (8.5, 1.5))
    assert (graph.positions, graph.edges) == (nodes, edges)


def test_an_empty_graph_has_no_distances():
    assert TopologicalGraph().distances() == []
