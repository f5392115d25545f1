"""A place is known once it was visited often enough, looking the same way."""

import numpy as np

from lidarena.slam.graph.graph_nodes import GraphNodes
from lidarena.slam.graph.known_places import known_from, loosened


def laps(times: int, there_and_back: bool = False) -> GraphNodes:
    """Visits of one corridor of 50 keyframes, one after the other."""
    nodes = GraphNodes()
    for k in range(50 * times):
        lap, along = divmod(k, 50)
        turned = there_and_back and lap % 2 == 1
        pose = np.array([0.25 * (49 - along if turned else along), 0.01 * lap, np.pi if turned else 0.0])
        nodes.append(k, pose, 0.25 * k, np.zeros(2))
    return nodes


def test_a_first_visit_is_not_known() -> None:
    columns = laps(1).columns
    assert all(known_from(columns, place, place, 1) == -1 for place in range(50))


def test_visits_are_counted_and_the_nearest_node_is_told() -> None:
    columns = laps(3).columns
    assert known_from(columns, 100, 120, 2) in (20, 70)
    assert known_from(columns, 100, 120, 3) == -1


def test_who_looked_the_other_way_saw_something_else() -> None:
    columns = laps(3, there_and_back=True).columns
    assert known_from(columns, 100, 120, 1) == 20
    assert known_from(columns, 100, 120, 2) == -1


def test_a_step_from_a_dropped_keyframe_is_known_less_surely() -> None:
    information = np.diag([1e4, 1e2, 1e4])
    loose = loosened(information, 0.5 * np.pi)
    covariance = np.linalg.inv(loose)
    np.testing.assert_allclose(np.diag(covariance), [1e-2 + 9e-4, 1e-4 + 9e-4, 1e-4 + 1e-4])
