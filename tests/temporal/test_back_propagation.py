import numpy as np

from lidarena.temporal import STNU
from lidarena.temporal.back_propagation import NormalForm, Propagation, back_propagate
from tests.temporal.networks import build

NONE = np.empty(0, np.int64)


def form(*edges: tuple[int, int, int]) -> NormalForm:
    tail, head, weight = np.array(edges, np.int64).T.copy()
    return NormalForm(tail, head, weight, NONE, NONE, 4)


def paths(found: Propagation, node: int) -> dict[int, int]:
    rows = slice(found.start[node], found.stop[node])
    return dict(zip(found.tail[rows].tolist(), found.length[rows].tolist(), strict=True))


def test_paths_are_shortened_until_they_are_not_negative() -> None:
    found = back_propagate(form((1, 0, -5), (2, 1, 3), (3, 2, 4)))
    assert found.controllable and list(found.stop - found.start) == [3, 0, 0, 0]
    assert paths(found, 0) == {1: -5, 2: -2, 3: 2}


def test_what_is_not_negative_is_not_gone_through() -> None:
    found = back_propagate(form((1, 0, -5), (2, 1, 6), (3, 2, 4)))
    assert paths(found, 0) == {1: -5, 2: 1}


def test_a_cycle_leaves_the_nodes_that_were_under_way() -> None:
    found = back_propagate(form((1, 0, -5), (0, 1, 4)))
    assert not found.controllable and found.again in found.pending
    assert not back_propagate(form((1, 0, -5), (2, 1, -1), (0, 2, 5))).controllable


def test_a_lower_case_edge_is_gone_through_unless_it_is_its_own() -> None:
    assert back_propagate(build(["A", "C"], [], [("A", 1, 9, "C")]).normal_form()).controllable
    network = build(["A", "C", "X"], [("X", 2, None, "C")], [("A", 1, 9, "C")])
    found = back_propagate(network.normal_form())
    assert paths(found, 2)[0] == -1_000_000  # X at least 2 before C, and C may come only 1 after A
    assert back_propagate(STNU().normal_form()).controllable
