"""All joint moves of a small team, the most promising first, and LaCAM's search by them.

Where a few robots fill nearly all places, what priority inheritance suggests leads astray: depth first, the search then
goes from arrangement to arrangement without ever coming near the goals. Here it goes on from the arrangement whose
robots have the least way left, less and less so the more often it has done so; and at the same time breadth
first back from the goals, until one search meets the other.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.team.lacam_nodes import (
    LacamNodes,
    add_node,
    connect,
    empty_nodes,
    find_slot,
    with_more_room,
)
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.pibt import TeamStep, hits_decided, team_step
from lidarena.planning.team.search_arrays import GraphArrays

GOES_ON, FOUND, EXHAUSTED, FULL = 0, 1, 2, 3
"""Why a search stopped."""
_ALL_TRIED = 127
_FIRST = 1024
_TRIES_A_STEP = 4
"""Joint moves from an arrangement after which one whose robots have a step more to go is as promising."""

_NODES_A_TRY = 64
"""Breadth first, so many newer configurations get their turn before one gets another: most of the joint moves of one
lead to where others lead."""

OpenNodes = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int64]]
"""A heap: keys, configurations; how many there are, and the other search's configuration that was met (2,)."""


@leaf
def _following_move(robot: int, move: int, graph: GraphArrays, ahead: NDArray[np.int32], step: TeamStep) -> int:
    """The move that comes after one where a robot's moves are ranked by what they leave of its way; 9 after the last.

    ``move`` -1 asks for the first.
    """
    here, best = step.here[robot], np.int64(9)
    least, bound = np.int64(2**62), np.int64(-1)
    if move >= 0:
        bound = np.int64(ahead[robot, graph.neighbours[here, move]]) * 16 + move
    for m in range(9):
        there = graph.neighbours[here, m]
        if there >= 0:
            key = np.int64(ahead[robot, there]) * 16 + m
            if bound < key < least:
                best, least = np.int64(m), key
    return int(best)


@leaf
def next_joint_move(
    number: int, nodes: LacamNodes, graph: GraphArrays, ahead: NDArray[np.int32], step: TeamStep
) -> bool:
    """Decide on the next of all joint moves from a configuration in which nobody is hit; False after the last.

    Args:
        number: Of the configuration; its robots are in ``step.here`` and ``step.occupant``.
        nodes: Remember which was the last.
        graph: Where moves lead, and which conflict.
        ahead: (k, n) cost of the rest of each robot's way.
        step: Gets the moves.
    """
    team = nodes.places.shape[1]
    joint, order = nodes.joint[number], nodes.order[number]
    if joint[0] == _ALL_TRIED:
        return False
    step.moves[:] = -1
    d = 0
    if joint[0] >= 0:
        d = team - 1
        for before in range(d):
            step.moves[order[before]] = joint[before]
    while d >= 0:
        robot = np.int64(order[d])
        step.moves[robot] = -1
        move = _following_move(robot, np.int64(joint[d]), graph, ahead, step)
        while move < 9 and hits_decided(robot, move, graph, step):
            move = _following_move(robot, move, graph, ahead, step)
        if move == 9:
            joint[d] = -1
            d -= 1
            continue
        joint[d], step.moves[robot] = move, move
        if d == team - 1:
            return True
        d += 1
        joint[d] = -1
    joint[0] = _ALL_TRIED  # a search that comes back must not begin anew
    return False


def open_nodes(nodes: LacamNodes, breadth: bool = False) -> OpenNodes:
    """The configurations from which joint moves are left to try, with room for all that there is room for."""
    room = len(nodes.parent) + 1
    heap = np.empty(room, np.int64), np.empty(room, np.int32), np.zeros(2, np.int64)
    for number in range(int(nodes.sizes[0])):
        if nodes.joint[number, 0] != _ALL_TRIED:
            key = np.int64(number if breadth else nodes.ahead[number] * _TRIES_A_STEP)
            heap[2][0] = push(heap[0], heap[1], heap[2][0], key, number)
    return heap


@leaf
def has_room(nodes: LacamNodes) -> bool:
    """Whether another configuration and two steps to it can be entered."""
    free = nodes.sizes[0] + 1 < len(nodes.parent) and nodes.sizes[1] + 2 < len(nodes.edges)
    return bool(free and nodes.sizes[2] + 2 < len(nodes.stack))


@kernel
def search_best_first(
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    nodes: LacamNodes,
    step: TeamStep,
    ranks: NDArray[np.int64],
    heap: OpenNodes,
    other: LacamNodes,
    breadth: bool,
    iterations: int,
) -> int:
    """Go on for so many joint moves, or until a configuration that ``other`` has met; return why it stopped.

    Arguments and result as those of ``lacam``'s depth-first search; ``heap`` as ``open_nodes`` makes it. The
    configuration in which both met is the last of ``nodes``. ``breadth``: breadth first instead.
    """
    keys, items, size = heap
    places = np.zeros(len(step.goals), np.int32)
    for _ in range(iterations):
        if size[0] == 0:
            return 2
        if not has_room(nodes):
            return 3
        here, key = np.int64(items[0]), keys[0]
        size[0] = pop(keys, items, size[0])
        for robot in range(len(places)):
            step.here[robot] = nodes.places[here, robot]
            step.occupant[step.here[robot]] = robot
        made = next_joint_move(here, nodes, graph, ahead, step)
        for robot in range(len(places)):
            step.occupant[step.here[robot]] = -1
        if not made:
            continue
        size[0] = push(keys, items, size[0], key + (_NODES_A_TRY if breadth else 1), here)
        for robot in range(len(places)):
            places[robot] = graph.neighbours[step.here[robot], step.moves[robot]]
        slot, met = find_slot(nodes, places)
        if met >= 0:
            connect(nodes, here, met, step.goals)
            continue
        number = add_node(nodes, places, slot, here, ahead, step.goals, ranks)
        rank = np.int64(number) if breadth else np.int64(nodes.ahead[number]) * _TRIES_A_STEP
        size[0] = push(keys, items, size[0], rank, number)
        nodes.stack[nodes.sizes[2]] = number
        nodes.sizes[2] += 1
        size[1] = find_slot(other, places)[1]
        if size[1] >= 0:
            return 1
    return 0


class JointSearch:
    """The search from one end: from the starts, or back from the goals, since every step can be undone.

    Args:
        graph: Where moves lead, and which conflict.
        ahead: (k, n) cost of each robot's way to the other end.
        nodes: Configurations met so far, the first the end from which it begins.
        step: Room for the steps of the team.
        ranks: (k,) see ``lacam_nodes.add_node``.
        most: Configurations that there may be.
        breadth: Whether to search breadth first.

    Attributes:
        nodes: The configurations.
        is_full: Whether there is no room for more.
    """

    def __init__(
        self,
        graph: GraphArrays,
        ahead: NDArray[np.int32],
        nodes: LacamNodes,
        step: TeamStep,
        ranks: NDArray[np.int64],
        most: int,
        breadth: bool = False,
    ) -> None:
        self._breadth, self.is_full = breadth, False
        self._graph, self._ahead, self._step, self._ranks, self._most = graph, ahead, step, ranks, most
        self.nodes, self._heap = nodes, open_nodes(nodes, breadth)

    @classmethod
    def back(
        cls,
        graph: GraphArrays,
        to_starts: NDArray[np.int32],
        ends: NDArray[np.int64],
        ranks: NDArray[np.int64],
        most: int,
    ) -> "JointSearch":
        """The search back from the goals; ``to_starts`` (k, n) are the ways to the starts, ``ends`` (k, 2) places."""
        nodes, step = empty_nodes(len(ends), _FIRST, 2 * _FIRST), team_step(graph, ends[:, 0], 1)
        goals = np.ascontiguousarray(ends[:, 1], np.int32)
        nodes.order[0] = np.arange(len(ends))
        add_node(nodes, goals, find_slot(nodes, goals)[0], -1, to_starts, step.goals, ranks)
        return cls(graph, to_starts, nodes, step, ranks, most, breadth=True)

    def run(self, other: "JointSearch", iterations: int) -> int:
        """Go on for so many joint moves; return GOES_ON, FOUND where it met the other search, EXHAUSTED or FULL."""
        status = search_best_first(
            self._graph,
            self._ahead,
            self.nodes,
            self._step,
            self._ranks,
            self._heap,
            other.nodes,
            self._breadth,
            iterations,
        )
        if status == FULL and len(self.nodes.parent) < self._most:
            self._grow()
            return GOES_ON
        self.is_full = status == FULL
        return status

    def _grow(self) -> None:
        room = min(2 * len(self.nodes.parent), self._most)
        self.nodes = with_more_room(self.nodes, room, 2 * len(self.nodes.edges))
        keys, items, size = self._heap  # with how often each was gone on from, which open_nodes does not know
        more = len(self.nodes.parent) + 1 - len(keys)
        self._heap = np.pad(keys, (0, more)), np.pad(items, (0, more)), size

    def join(self, other: "JointSearch", from_here: bool) -> None:
        """Enter the way from where both met on to the other one's end, and that end as the goal.

        Args:
            other: The search back from the goals.
            from_here: Whether this search met the other, not the other this one.
        """
        here, at = int(self.nodes.sizes[0]) - 1, int(self._heap[2][1])
        if not from_here:
            here, at = int(other._heap[2][1]), int(other.nodes.sizes[0]) - 1
        while other.nodes.parent[at] >= 0:
            at = int(other.nodes.parent[at])
            if not has_room(self.nodes):
                self._grow()
            places = other.nodes.places[at]
            slot, met = find_slot(self.nodes, places)
            if met >= 0:
                connect(self.nodes, here, met, self._step.goals)
                here = int(met)
                continue
            here = int(add_node(self.nodes, places, slot, here, self._ahead, self._step.goals, self._ranks))
            self.nodes.stack[self.nodes.sizes[2]] = here
            self.nodes.sizes[2] += 1
        self.nodes.sizes[3] = here
