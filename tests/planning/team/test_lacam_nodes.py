import heapq

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.planning.team.lacam_nodes import add_node, connect, empty_nodes, find_slot, with_more_room

GOALS = np.array([0, 0], np.int64)
RANKS = np.array([1, 0], np.int64)
AHEAD = np.stack([np.arange(40), np.arange(40)]).astype(np.int32) * 4096


def filled(configurations, parents, room=64):
    """Nodes with these configurations, each first met from its parent."""
    nodes = empty_nodes(2, room, 8 * room)
    nodes.order[0] = [0, 1]
    for places, parent in zip(configurations, parents, strict=True):
        array = np.array(places, np.int32)
        slot, met = find_slot(nodes, array)
        assert met == -1
        add_node(nodes, array, slot, np.int64(parent), AHEAD, GOALS, RANKS)
    return nodes


CONFIGURATIONS = st.lists(st.tuples(st.integers(0, 39), st.integers(0, 39)), min_size=2, max_size=30, unique=True)


@settings(max_examples=25, deadline=None)
@given(CONFIGURATIONS)
def test_every_configuration_is_found_again_also_in_a_larger_room(configurations) -> None:
    nodes = filled(configurations, [-1, *range(len(configurations) - 1)])
    for larger in (nodes, with_more_room(nodes, 128, 2048)):
        for number, places in enumerate(configurations):
            assert find_slot(larger, np.array(places, np.int32))[1] == number
        assert find_slot(larger, np.array([77, 77], np.int32))[1] == -1
        assert larger.sizes[0] == len(configurations)
        assert np.array_equal(larger.parent[: len(configurations)], nodes.parent[: len(configurations)])


@settings(max_examples=40, deadline=None)
@given(CONFIGURATIONS, st.data())
def test_costs_are_those_of_the_shortest_ways_over_the_steps_found(configurations, data) -> None:
    count = len(configurations)
    parents = [-1] + [data.draw(st.integers(0, n - 1)) for n in range(1, count)]
    nodes = filled(configurations, parents)
    steps = {(parent, n) for n, parent in enumerate(parents) if n}
    for one, other in data.draw(st.lists(st.tuples(*[st.integers(0, count - 1)] * 2), max_size=40)):
        if (one, other) not in steps:
            steps.add((one, other))
            connect(nodes, np.int64(one), np.int64(other), GOALS)
    pairs = {step: zip(configurations[step[0]], configurations[step[1]], strict=True) for step in steps}
    cost = {step: sum(pair != (0, 0) for pair in both) for step, both in pairs.items()}
    best, queue = {0: 0}, [(0, 0)]
    while queue:
        spent, here = heapq.heappop(queue)
        for a, b in steps:
            if a == here and spent + cost[a, b] < best.get(b, 10**9):
                best[b] = spent + cost[a, b]
                heapq.heappush(queue, (best[b], b))
    assert nodes.spent[:count].tolist() == [best[n] for n in range(count)]


def test_who_is_not_at_its_goal_gains_priority_with_every_step() -> None:
    nodes = filled([(3, 5), (2, 0), (1, 0), (1, 4)], [-1, 0, 1, 2])
    assert nodes.elapsed[:4].tolist() == [[0, 0], [1, 0], [2, 0], [3, 1]]
    assert nodes.order[:4].tolist() == [[0, 1]] * 4
    nodes = filled([(3, 5), (0, 4), (1, 3)], [-1, 0, 1])
    assert nodes.order[:3].tolist() == [[0, 1], [1, 0], [1, 0]]
    assert nodes.ahead[:3].tolist() == [8, 4, 4] and nodes.spent[:3].tolist() == [0, 2, 4]
