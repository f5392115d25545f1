"""The nodes of LaCAM's search: configurations of a team, how they were reached, and what has been tried from them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

SMALL_TEAM = 12
"""Robots up to which all joint moves are gone through where constraints on a few robots have led nowhere."""


class LacamNodes(NamedTuple):
    """Arrays for up to ``m`` configurations of k robots and ``e`` steps between them.

    Attributes:
        places: (m, k) int32 where the robots are.
        order: (m, k) int16 robots by falling priority.
        elapsed: (m, k) int16 steps since each robot was last at its goal: its priority.
        parent: (m,) int32 the configuration before on the cheapest way known, -1 at the start.
        spent: (m,) int64 cost of that way: steps of robots that are not resting at their goals.
        ahead: (m,) int64 bound of the cost from there on: the robots' ways alone.
        tried: (m,) int64 combinations of constraints that have been tried.
        joint: (m, k) int8 the joint move tried last where all are gone through, -1 before; (m, 0) for large teams.
        edge: (m,) int32 the last step that was found from a configuration, -1 none.
        edges: (e, 2) int32 where a step leads, and the step found before it.
        stack: (e,) int32 configurations in the order of the depth-first search.
        slots: (s,) int32 hash table: number of a configuration plus one, 0 free.
        queue: (m,) int32 scratch; ``queued`` (m,) bool says who is in it.
        queued: See ``queue``.
        sizes: (4,) int64 numbers of configurations, of edges and of stacked ones; configuration at the goals, -1 none.
    """

    places: NDArray[np.int32]
    order: NDArray[np.int16]
    elapsed: NDArray[np.int16]
    parent: NDArray[np.int32]
    spent: NDArray[np.int64]
    ahead: NDArray[np.int64]
    tried: NDArray[np.int64]
    joint: NDArray[np.int8]
    edge: NDArray[np.int32]
    edges: NDArray[np.int32]
    stack: NDArray[np.int32]
    slots: NDArray[np.int32]
    queue: NDArray[np.int32]
    queued: NDArray[np.bool_]
    sizes: NDArray[np.int64]


def empty_nodes(team: int, nodes: int, edges: int) -> LacamNodes:
    """Room for so many configurations and steps."""
    return LacamNodes(
        places=np.zeros((nodes, team), np.int32),
        order=np.zeros((nodes, team), np.int16),
        elapsed=np.zeros((nodes, team), np.int16),
        parent=np.full(nodes, -1, np.int32),
        spent=np.zeros(nodes, np.int64),
        ahead=np.zeros(nodes, np.int64),
        tried=np.zeros(nodes, np.int64),
        joint=np.full((nodes, team if team <= SMALL_TEAM else 0), -1, np.int8),
        edge=np.full(nodes, -1, np.int32),
        edges=np.zeros((edges, 2), np.int32),
        stack=np.zeros(edges, np.int32),
        slots=np.zeros(1 << (2 * nodes).bit_length(), np.int32),
        queue=np.zeros(nodes, np.int32),
        queued=np.zeros(nodes, np.bool_),
        sizes=np.array([0, 0, 0, -1], np.int64),
    )


def with_more_room(old: LacamNodes, nodes: int, edges: int) -> LacamNodes:
    """The same configurations with room for more."""
    count, steps, stacked, _ = old.sizes.tolist()
    new = empty_nodes(old.places.shape[1], nodes, edges)
    for name in ("places", "order", "elapsed", "parent", "spent", "ahead", "tried", "joint", "edge"):
        getattr(new, name)[:count] = getattr(old, name)[:count]
    new.edges[:steps], new.stack[:stacked], new.sizes[:] = old.edges[:steps], old.stack[:stacked], old.sizes
    _enter_all(new)
    return new


@leaf
def _enter_all(nodes: LacamNodes) -> None:
    for number in range(nodes.sizes[0]):
        slot, _ = find_slot(nodes, nodes.places[number])
        nodes.slots[slot] = number + 1


@leaf
def find_slot(nodes: LacamNodes, places: NDArray[np.int32]) -> tuple[int, int]:
    """The slot of the hash table for a configuration (k,), and its number, -1 if it has not been met."""
    mask = np.uint64(len(nodes.slots) - 1)
    mixed = np.uint64(14695981039346656037)
    for robot in range(len(places)):
        mixed = (mixed ^ np.uint64(places[robot])) * np.uint64(1099511628211)
    mixed ^= mixed >> np.uint64(29)
    slot = np.int64(mixed & mask)
    while nodes.slots[slot] > 0:
        number = np.int64(nodes.slots[slot] - 1)
        same = True
        for robot in range(len(places)):
            if nodes.places[number, robot] != places[robot]:
                same = False
                break
        if same:
            return int(slot), int(number)
        slot = np.int64((np.uint64(slot) + np.uint64(1)) & mask)
    return int(slot), -1


@leaf
def _cost_between(nodes: LacamNodes, one: int, other: int, goals: NDArray[np.int64]) -> int:
    """Robots that do not rest at their goals in the step between two configurations."""
    cost = 0
    for robot in range(len(goals)):
        if nodes.places[one, robot] != goals[robot] or nodes.places[other, robot] != goals[robot]:
            cost += 1
    return cost


@leaf
def connect(nodes: LacamNodes, one: int, other: int, goals: NDArray[np.int64]) -> None:
    """Note that a step leads from a configuration to one that was met, and pass on what becomes cheaper by it."""
    step = nodes.sizes[1]
    nodes.edges[step, 0], nodes.edges[step, 1] = other, nodes.edge[one]
    nodes.edge[one] = step
    nodes.sizes[1] += 1
    cost = nodes.spent[one] + _cost_between(nodes, one, other, goals)
    if cost >= nodes.spent[other]:
        return
    nodes.spent[other], nodes.parent[other] = cost, one
    room = len(nodes.queue)
    nodes.queue[0], nodes.queued[other] = other, True
    head, waiting = 0, 1
    while waiting > 0:
        here = nodes.queue[head]
        head, waiting = (head + 1) % room, waiting - 1
        nodes.queued[here] = False
        e = nodes.edge[here]
        while e >= 0:
            there = nodes.edges[e, 0]
            cost = nodes.spent[here] + _cost_between(nodes, here, there, goals)
            if cost < nodes.spent[there]:
                nodes.spent[there], nodes.parent[there] = cost, here
                if not nodes.queued[there]:
                    nodes.queue[(head + waiting) % room] = there
                    nodes.queued[there] = True
                    waiting += 1
            e = nodes.edges[e, 1]


@leaf
def add_node(
    nodes: LacamNodes,
    places: NDArray[np.int32],
    slot: int,
    parent: int,
    ahead: NDArray[np.int32],
    goals: NDArray[np.int64],
    ranks: NDArray[np.int64],
) -> int:
    """Enter a configuration (k,) that was met for the first time, from ``parent``; return its number.

    A robot that is not at its goal gains priority with every step; one that is loses all of it. Equal priorities rank
    by ``ranks`` (k,).
    """
    number = nodes.sizes[0]
    nodes.sizes[0] += 1
    nodes.slots[slot] = number + 1
    nodes.parent[number] = parent
    rest = np.int64(0)
    for robot in range(len(places)):
        nodes.places[number, robot] = places[robot]
        rest += ahead[robot, places[robot]] // 4096
        waited = np.int64(nodes.elapsed[parent, robot]) + 1 if parent >= 0 else 0
        nodes.elapsed[number, robot] = 0 if places[robot] == goals[robot] else min(waited, 32000)
    nodes.ahead[number] = rest
    nodes.spent[number] = 0
    for i in range(len(places)):  # nearly sorted already
        one = np.int64(nodes.order[max(parent, 0), i])
        key = np.int64(nodes.elapsed[number, one]) * 65536 + ranks[one]
        j = i
        while j > 0:
            other = np.int64(nodes.order[number, j - 1])
            if np.int64(nodes.elapsed[number, other]) * 65536 + ranks[other] >= key:
                break
            nodes.order[number, j] = other
            j -= 1
        nodes.order[number, j] = one
    if parent >= 0:
        nodes.spent[number] = nodes.spent[parent] + _cost_between(nodes, parent, number, goals)
        step = nodes.sizes[1]
        nodes.edges[step, 0], nodes.edges[step, 1] = number, nodes.edge[parent]
        nodes.edge[parent] = step
        nodes.sizes[1] += 1
    return int(number)
