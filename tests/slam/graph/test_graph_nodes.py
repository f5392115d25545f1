"""Nodes keep their order, and what is tied to them, whatever is removed."""

import numpy as np

from lidarena.slam.graph.graph_nodes import GraphNodes


def filled(count: int) -> GraphNodes:
    nodes = GraphNodes()
    for k in range(count):
        nodes.append(3 * k, np.full(3, float(k)), 0.5 * k, np.array([k, -k], float))
        if k:
            nodes.tie(k, 3 * k - 3, np.array([1.0, 0.0, 0.0]), np.eye(3) * k)
    return nodes


def test_they_grow() -> None:
    nodes = filled(600)
    columns = nodes.columns
    assert nodes.count == 600 and columns.numbers[-1] == 1797
    np.testing.assert_array_equal(columns.poses[:, 1], np.arange(600.0))
    np.testing.assert_array_equal(columns.sources[:3], [0, 0, 3])
    assert columns.information[599, 0, 0] == 599.0


def test_what_is_removed_leaves_the_others_as_they_were() -> None:
    nodes = filled(6)
    nodes.remove([1, 4])
    np.testing.assert_array_equal(nodes.columns.numbers, [0, 6, 9, 15])
    np.testing.assert_array_equal(nodes.columns.views[:, 0], [0, 2, 3, 5])
    np.testing.assert_array_equal(nodes.places(np.array([9, 15, 0])), [2, 3, 0])
    nodes.append(99, np.zeros(3), 1.0, np.zeros(2))
    assert nodes.columns.numbers[-1] == 99 and nodes.columns.sources[-1] == 99


def test_what_is_written_into_the_columns_stays() -> None:
    nodes = filled(3)
    nodes.columns.poses[:] = 7.0
    assert (nodes.columns.poses == 7.0).all()
