"""Whether a team on a few places has a plan at all, and one if it has: without a search over all its arrangements.

Nine robots on 16 places can stand in four thousand million ways, but take only 11,440 sets of places. Those are
searched breadth first. A step that comes back to a set tells a permutation of the robots that can be had, by a loop
from the starts; a plan exists exactly if the permutation that is asked for is among the products of those (Kornhauser,
Miller & Spirakis 1984, "Coordinating pebble motion on graphs, the diameter of permutation groups, and applications").
Steps of one robot and of rings of robots are enough where robots are no larger than a cell: of a step of several, one
after the other can go, unless they follow each other in a ring.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.team.grid_graph import GridGraph

MOST_PLACES, MOST_ROBOTS, _MOST_SETS = 20, 9, 13_000
_MOST_RING_STEPS = 4_000_000  # then it is not certain any more that there is no plan
_SHORT_LOOPS = 12  # loops of which a plan is composed, if they suffice
_ONES = np.array([bits.bit_count() for bits in range(2**MOST_ROBOTS)])


class Sets(NamedTuple):
    """The sets of places that a team can take, and the loops from the starts over them.

    Shapes: s sets, k robots, p permutations of k.

    Attributes:
        number: (2**places,) of each set by its bits, -1 where it was not met.
        where: (s, k) place of each robot when the set was met first.
        before: (s,) set from which it was met.
        depth: (s,) steps from the starts.
        lengths: (p,) steps of the shortest loop that permutes the robots so; 0 = none.
        turns: (p,) set from which that loop's step goes back towards the starts.
        moved: (p, k) places of the robots after it.
    """

    number: NDArray[np.int32]
    where: NDArray[np.int64]
    before: NDArray[np.int64]
    depth: NDArray[np.int64]
    lengths: NDArray[np.int32]
    turns: NDArray[np.int32]
    moved: NDArray[np.int8]


@dataclass(frozen=True)
class Verdict:
    """What is known of a team.

    Attributes:
        paths: (k, T) places, if there is a plan.
        impossible: Whether it is certain that there is none.
    """

    paths: NDArray[np.int32] | None
    impossible: bool


def is_small(graph: GridGraph, robots: int) -> bool:
    """Whether there are few enough sets of places for :func:`decide`."""
    places = len(graph)
    return places <= MOST_PLACES and robots <= MOST_ROBOTS and math.comb(places, robots) <= _MOST_SETS


@leaf
def rank_of(permutation: NDArray[np.int64]) -> int:
    """The number of a permutation (k,) in lexicographic order."""
    rank, team, met = np.int64(0), len(permutation), np.int64(0)
    for i in range(team):
        rank = rank * (team - i) + permutation[i] - _ONES[met & ((np.int64(1) << permutation[i]) - 1)]
        met |= np.int64(1) << permutation[i]
    return int(rank)


@leaf
def write_permutation(rank: int, permutation: NDArray[np.int64]) -> None:
    """The inverse of :func:`rank_of`."""
    team = len(permutation)
    for i in range(team - 1, -1, -1):
        permutation[i] = rank % (team - i)
        rank //= team - i
    for i in range(team - 1, -1, -1):
        for j in range(i + 1, team):
            if permutation[j] >= permutation[i]:
                permutation[j] += 1


@leaf
def _note(here: int, there: NDArray[np.int64], count: int, sets: Sets, permutation: NDArray[np.int64]) -> int:
    """Enter the arrangement (k,) to which a step from a set leads: a new set, or a loop. Return the number of sets."""
    bits = np.int64(0)
    for robot in range(len(there)):
        bits |= np.int64(1) << there[robot]
    met = np.int64(sets.number[bits])
    if met < 0:
        sets.number[bits] = count
        for robot in range(len(there)):
            sets.where[count, robot] = there[robot]
        sets.before[count], sets.depth[count] = here, sets.depth[here] + 1
        return count + 1
    for robot in range(len(there)):
        for role in range(len(there)):
            if sets.where[met, role] == there[robot]:
                permutation[robot] = role
    rank, length = rank_of(permutation), sets.depth[here] + sets.depth[met] + 1
    if rank > 0 and (sets.lengths[rank] == 0 or sets.lengths[rank] > length):
        sets.lengths[rank], sets.turns[rank] = length, here
        for robot in range(len(there)):
            sets.moved[rank, robot] = there[robot]
    return count


@leaf
def _fits(ring: NDArray[np.int64], moves: NDArray[np.int64], size: int, bits: NDArray[np.int64]) -> bool:
    """Whether the last move of a ring conflicts with none of those before."""
    fits = True
    for i in range(size - 1):
        fits = fits and not bits[ring[size - 1], moves[size - 1], ring[i]] >> moves[i] & 1
    return fits


@leaf
def _leaves_alone(
    ring: NDArray[np.int64], moves: NDArray[np.int64], size: int, at: NDArray[np.int64], bits: NDArray[np.int64]
) -> bool:
    """Whether moves from ``size`` places conflict with nobody who stays; ``at`` (n,) is who is where, -1 nobody."""
    for i in range(size):
        for other in range(len(at)):
            stays = at[other] >= 0
            for j in range(size):
                stays = stays and ring[j] != other
            if stays and bits[ring[i], moves[i], other] & 1:
                return False
    return True


@leaf
def _step_alone(
    here: int,
    count: int,
    neighbours: NDArray[np.int32],
    bits: NDArray[np.int64],
    sets: Sets,
    at: NDArray[np.int64],
    scratch: NDArray[np.int64],
) -> int:
    """Enter what the moves of single robots from a set lead to; return the number of sets."""
    there, team = scratch[0], sets.where.shape[1]
    for robot in range(team):
        scratch[2, 0] = sets.where[here, robot]
        for m in range(1, 9):
            goal = neighbours[scratch[2, 0], m]
            scratch[3, 0] = m
            if goal >= 0 and at[goal] < 0 and _leaves_alone(scratch[2], scratch[3], np.int64(1), at, bits):
                for other in range(team):
                    there[other] = sets.where[here, other]
                there[robot] = goal
                count = _note(here, there[:team], count, sets, scratch[1, :team])
    return count


@leaf
def _step_in_rings(
    here: int,
    count: int,
    neighbours: NDArray[np.int32],
    bits: NDArray[np.int64],
    sets: Sets,
    at: NDArray[np.int64],
    scratch: NDArray[np.int64],
) -> int:
    """Enter what it leads to when three robots or more of a set follow each other in a ring; the number of sets.

    ``scratch[4, 0]`` is how many steps of this search are left.
    """
    there, ring, moves, team = scratch[0], scratch[2], scratch[3], sets.where.shape[1]
    for first in range(len(at)):
        ring[0], moves[0], size = first, 0, 1 if at[first] >= 0 else 0
        while size > 0 and scratch[4, 0] > 0:
            scratch[4, 0] -= 1
            moves[size - 1] += 1
            if moves[size - 1] > 8:
                size -= 1
                continue
            following = np.int64(neighbours[ring[size - 1], moves[size - 1]])
            if following < first or at[following] < 0 or not _fits(ring, moves, size, bits):
                continue
            if following == first and size > 2 and _leaves_alone(ring, moves, size, at, bits):
                for other in range(team):
                    there[other] = sets.where[here, other]
                for i in range(size):
                    there[at[ring[i]]] = ring[(i + 1) % size]
                count = _note(here, there[:team], count, sets, scratch[1, :team])
            new = True
            for i in range(size):
                new = new and ring[i] != following
            if new:
                ring[size], moves[size] = following, 0
                size += 1
    return count


@kernel
def survey(neighbours: NDArray[np.int32], bits: NDArray[np.int64], sets: Sets, ring_steps: int) -> tuple[int, bool]:
    """Search the sets of places breadth first, ``sets.where[0]`` being the starts.

    Args:
        neighbours: (n, 9) where moves lead.
        bits: (n, 9, n) for each move the moves of a robot in another place that conflict with it.
        sets: Output.
        ring_steps: How long to look for rings.

    Returns:
        How many sets there are; whether all rings were found.
    """
    places, team = len(neighbours), sets.where.shape[1]
    scratch, at = np.zeros((5, places + 1), np.int64), np.zeros(places, np.int64)
    scratch[4, 0] = ring_steps
    start = np.int64(0)
    for robot in range(team):
        start |= np.int64(1) << sets.where[0, robot]
    sets.number[start] = 0
    count, head = 1, np.int64(0)
    while head < count:
        at[:] = -1
        for robot in range(team):
            at[sets.where[head, robot]] = robot
        count = _step_alone(head, count, neighbours, bits, sets, at, scratch)
        count = _step_in_rings(head, count, neighbours, bits, sets, at, scratch)
        head += 1
    return count, bool(scratch[4, 0] > 0)


@kernel
def needed_loops(loops: NDArray[np.int64], team: int, permutations: int) -> NDArray[np.int64]:
    """Which of some loops generate all that they do: the first that do.

    Args:
        loops: (m,) ranks of permutations.
        team: Robots that they permute.
        permutations: How many there are of a team.

    Returns:
        Ranks of those loops.
    """
    elements, done = np.zeros((permutations, team), np.int64), np.zeros(permutations, np.int32)
    met, product = np.zeros(permutations, np.bool_), np.zeros(team, np.int64)
    used, needed, generators, count = np.zeros((64, team), np.int64), np.zeros(64, np.int64), 0, 1
    met[0], elements[0] = True, np.arange(team)
    for loop in loops:
        if met[loop]:
            continue
        write_permutation(loop, used[generators])
        needed[generators] = loop
        generators += 1
        e = 0
        while e < count:
            for g in range(done[e], generators):
                for robot in range(team):
                    product[robot] = used[g, elements[e, robot]]
                rank = rank_of(product)
                if not met[rank]:
                    met[rank], elements[count] = True, product
                    count += 1
            done[e] = generators
            e += 1
    return needed[:generators].copy()


@kernel
def word_of(target: int, loops: NDArray[np.int64], team: int, permutations: int) -> tuple[bool, NDArray[np.int64]]:
    """The fewest of some loops, one after the other, that permute the robots as asked for.

    Args:
        target: Rank of the permutation.
        loops: (m,) ranks.
        team: Robots that they permute.
        permutations: How many there are of a team.

    Returns:
        Whether there are any; the loops' ranks, in their order.
    """
    elements, before = np.zeros((permutations, team), np.int64), np.zeros((permutations, 2), np.int64)
    at, product = np.full(permutations, -1, np.int64), np.zeros(team, np.int64)
    used = np.zeros((len(loops), team), np.int64)
    for number in range(len(loops)):
        write_permutation(loops[number], used[number])
    at[0], elements[0], count, head = 0, np.arange(team), 1, 0
    while at[target] < 0 and head < count:
        for number in range(len(loops)):
            for robot in range(team):
                product[robot] = used[number, elements[head, robot]]
            rank = rank_of(product)
            if at[rank] < 0:
                at[rank], elements[count] = count, product
                before[count, 0], before[count, 1] = head, loops[number]
                count += 1
        head += 1
    word, size, element = np.zeros(permutations, np.int64), 0, at[target]
    while element > 0:
        word[size] = before[element, 1]
        element = before[element, 0]
        size += 1
    return at[target] >= 0, word[:size][::-1].copy()


def decide(graph: GridGraph, ends: NDArray[np.int64]) -> Verdict:
    """Find a plan for a team on a few places, or that there is none.

    Args:
        graph: See :func:`is_small`.
        ends: (k, 2) start and goal places.
    """
    places, team = len(graph), len(ends)
    permutations = math.factorial(team)
    most = math.comb(places, team)
    sets = Sets(
        number=np.full(2**places, -1, np.int32),
        where=np.zeros((most, team), np.int64),
        before=np.full(most, -1, np.int64),
        depth=np.zeros(most, np.int64),
        lengths=np.zeros(permutations, np.int32),
        turns=np.zeros(permutations, np.int32),
        moved=np.zeros((permutations, team), np.int8),
    )
    sets.where[0] = ends[:, 0]
    _, all_rings = survey(graph.neighbours, _conflict_bits(graph), sets, np.int64(_MOST_RING_STEPS))
    certain = all_rings and graph.apart <= 1.0
    final = int(sets.number[np.bitwise_or.reduce(1 << ends[:, 1])])
    if final < 0:
        return Verdict(None, certain)
    wanted = np.argmax(sets.where[final][None, :] == ends[:, 1][:, None], axis=1).astype(np.int64)
    loops = np.flatnonzero(sets.lengths)
    loops = loops[np.argsort(sets.lengths[loops], kind="stable")].astype(np.int64)
    target, counts = np.int64(rank_of(wanted)), (np.int64(team), np.int64(permutations))
    found, word = word_of(target, loops[:_SHORT_LOOPS], *counts)
    if not found:
        found, word = word_of(target, needed_loops(loops, *counts), *counts)
    if not found:
        return Verdict(None, certain)
    return Verdict(_without_detours(_compose(word, final, sets)), False)


def load_kernels() -> None:
    """Decide a team of which there is no plan, so that everything is compiled before somebody's time limit runs."""
    decide(GridGraph(np.zeros((1, 3), np.bool_), 4, 0.0), np.array([(0, 2), (2, 0)]))


def _conflict_bits(graph: GridGraph) -> NDArray[np.int64]:
    """For each move (n, 9) which moves of a robot in another place (n,) conflict with it, as bits."""
    bits = np.zeros((len(graph), 9, len(graph)), np.int64)
    for move in range(len(graph.begins) - 1):
        for offset, others, _ in graph.entries[graph.begins[move] : graph.begins[move + 1]]:
            near = graph.padded[graph.at + offset]
            here = np.flatnonzero(near >= 0)
            bits[here, move, near[here]] = others
    return bits


def _compose(word: NDArray[np.int64], final: int, sets: Sets) -> NDArray[np.int64]:
    """The arrangements (T, k) that lead over loops and then to the set ``final``."""
    team = sets.where.shape[1]
    role, permutation = np.arange(team), np.zeros(team, np.int64)
    way = [sets.where[0]]
    for loop in word.tolist():
        way += [sets.where[number][role] for number in _way_to(int(sets.turns[loop]), sets)]
        moved = sets.moved[loop].astype(np.int64)
        way.append(moved[role])
        write_permutation(np.int64(loop), permutation)
        role = permutation[role]
        back = _way_to(int(sets.number[np.bitwise_or.reduce(1 << moved)]), sets)
        way += [sets.where[number][role] for number in back[::-1]]
        way.append(sets.where[0][role])
    way += [sets.where[number][role] for number in _way_to(final, sets)]
    return np.array(way)


def _way_to(number: int, sets: Sets) -> list[int]:
    """The sets from the starts, which are left out, to one."""
    way = []
    while number > 0:
        way.append(number)
        number = int(sets.before[number])
    return way[::-1]


def _without_detours(way: NDArray[np.int64]) -> NDArray[np.int32]:
    """The places (k, T) of arrangements (T, k) without what lies between two visits of the same one."""
    last = {arrangement.tobytes(): t for t, arrangement in enumerate(way)}
    kept, t = [], 0
    while t < len(way):
        kept.append(t)
        t = last[way[t].tobytes()] + 1
    return np.ascontiguousarray(way[kept].T, np.int32)
