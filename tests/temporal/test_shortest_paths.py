import numpy as np

from lidarena.temporal.back_propagation import FAR
from lidarena.temporal.shortest_paths import all_distances, find_negative_cycle


def test_a_negative_cycle_is_walked_in_order() -> None:
    tail, head = np.array([0, 1, 2, 3]), np.array([1, 2, 0, 0])
    assert list(find_negative_cycle(tail, head, np.array([1, 1, -2, 0]), 4)) == []
    cycle = list(find_negative_cycle(tail, head, np.array([1, 1, -3, 0]), 4))
    assert sorted(cycle) == [0, 1, 2]
    assert all(head[one] == tail[other] for one, other in zip(cycle, cycle[1:] + cycle[:1], strict=True))


def test_distances_go_through_other_nodes() -> None:
    distance = all_distances(np.array([0, 1]), np.array([1, 2]), np.array([4, -1]), 3)
    assert distance.tolist() == [[0, 4, 3], [FAR, 0, -1], [FAR, FAR, 0]]
