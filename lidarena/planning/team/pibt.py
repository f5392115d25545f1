"""The next step of a whole team by priority inheritance with backtracking (PIBT, Okumura et al. 2022), discs included.

Every robot takes the move that brings it nearest to its goal, in order of priority. Where another robot without a move
would be hit if it stayed, it inherits the priority and has to make room first; if it cannot, the move is not possible.
For points at most one robot is in the way of a move, which is Okumura's case. Discs may have several in their way: then
all that was decided for the sake of a move is taken back with it (backtracking), up to a number of trials, after which
nobody is pushed any more.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, kernel, leaf
from lidarena.planning.team.pibt_swap import swap_partner
from lidarena.planning.team.search_arrays import GraphArrays

UNDECIDED = -1
_TRIALS, _TRIALS_A_ROBOT = 100, 20  # moves that discs may try in a step before they stop pushing each other


class TeamStep(NamedTuple):
    """What is known and decided of one step of a team; k robots, n places.

    Attributes:
        here: (k,) int32 places at the beginning of the step.
        occupant: (n,) int32 robot in each place, -1 nobody.
        moves: (k,) int64 the moves decided on, ``UNDECIDED`` where there is none yet.
        goals: (k,) int64 places.
        degree: (n,) int64 places next to each.
        candidates: (k, 9) int64 moves of a robot that is deciding, the best first.
        keys: (9,) int64 scratch: what ranks them.
        counts: (k, 4) int64 of a deciding robot: number of candidates; the next one; decisions made before it began;
            robot that follows it in a swap, -1 nobody.
        frames: (k + 1,) int64 robots that decide, each for the sake of the one before it.
        trail: (k + 1,) int64 robots in the order of their decisions.
        state: (4,) int64 number of decisions in ``trail``; trials left; whether several robots may be in the way of a
            move; whether robots look for swaps.
        random: (1,) uint64 state of the generator that breaks ties.
    """

    here: NDArray[np.int32]
    occupant: NDArray[np.int32]
    moves: NDArray[np.int64]
    goals: NDArray[np.int64]
    degree: NDArray[np.int64]
    candidates: NDArray[np.int64]
    keys: NDArray[np.int64]
    counts: NDArray[np.int64]
    frames: NDArray[np.int64]
    trail: NDArray[np.int64]
    state: NDArray[np.int64]
    random: NDArray[np.uint64]


def team_step(graph: GraphArrays, goals: NDArray[np.int64], seed: int) -> TeamStep:
    """Room for the steps of a team that goes to ``goals`` (k,)."""
    team, places = len(goals), len(graph.neighbours)
    several = max(_most_in_the_way(graph, m) for m in range(1, 9)) > 1
    return TeamStep(
        here=np.zeros(team, np.int32),
        occupant=np.full(places, -1, np.int32),
        moves=np.full(team, UNDECIDED, np.int64),
        goals=goals.astype(np.int64),
        degree=(graph.neighbours[:, 1:] >= 0).sum(axis=1).astype(np.int64),
        candidates=np.zeros((team, 9), np.int64),
        keys=np.zeros(9, np.int64),
        counts=np.zeros((team, 4), np.int64),
        frames=np.zeros(team + 1, np.int64),
        trail=np.zeros(team + 1, np.int64),
        state=np.array([0, 0, several, not several], np.int64),
        random=np.array([seed * 2 + 1], np.uint64),
    )


def _most_in_the_way(graph: GraphArrays, move: int) -> int:
    """How many places there are in which a robot that waits would be hit by a move, the own one left out."""
    if move + 1 >= len(graph.begins):
        return 0
    entries = graph.entries[graph.begins[move] : graph.begins[move + 1]]
    return int(np.sum((entries[:, 1] & 1 == 1) & (entries[:, 0] != 0)))


@inlined
def random_below(random: NDArray[np.uint64], bound: int) -> int:
    """A number from 0 to ``bound`` - 1, ``bound`` below 2**24 (xorshift)."""
    x = random[0]
    x ^= x << np.uint64(13)
    x ^= x >> np.uint64(7)
    x ^= x << np.uint64(17)
    random[0] = x
    return int(x >> np.uint64(40)) % bound


@leaf
def hits_decided(robot: int, move: int, graph: GraphArrays, step: TeamStep) -> bool:
    """Whether a move would hit a robot whose move is decided."""
    base = graph.at[step.here[robot]]
    for e in range(graph.begins[move], graph.begins[move + 1]):
        place = graph.padded[base + graph.entries[e, 0]]
        if place >= 0:
            other = step.occupant[place]
            decided = step.moves[other] if other >= 0 and other != robot else -1
            if decided >= 0 and graph.entries[e, 1] >> decided & 1:
                return True
    return False


@leaf
def in_the_way(robot: int, graph: GraphArrays, step: TeamStep) -> int:
    """A robot without a move that the move of ``robot`` would hit if it waited; -1 nobody, -2 a decided one is hit."""
    base, move, found = graph.at[step.here[robot]], step.moves[robot], -1
    for e in range(graph.begins[move], graph.begins[move + 1]):
        place = graph.padded[base + graph.entries[e, 0]]
        if place >= 0:
            other = step.occupant[place]
            if other >= 0 and other != robot:
                decided = step.moves[other]
                if graph.entries[e, 1] >> max(decided, 0) & 1:
                    if decided >= 0:
                        return -2
                    found = int(other)
    return found


@leaf
def _begin_frame(robot: int, graph: GraphArrays, ahead: NDArray[np.int32], step: TeamStep) -> None:
    """Rank a robot's moves: what brings it nearest to its goal, ties at random."""
    here, count = step.here[robot], 0
    for m in range(9):
        there = graph.neighbours[here, m]
        if there < 0:
            continue
        key = np.int64(ahead[robot, there] >> 12) * 4096 + (ahead[robot, there] & 4095) // 2048 * 2048
        key += random_below(step.random, 2048)
        i = count
        while i > 0 and step.keys[i - 1] > key:
            step.keys[i], step.candidates[robot, i] = step.keys[i - 1], step.candidates[robot, i - 1]
            i -= 1
        step.keys[i], step.candidates[robot, i] = key, m
        count += 1
    partner = -1
    if step.state[3]:
        best = graph.neighbours[here, step.candidates[robot, 0]]
        partner = swap_partner(robot, best, graph.neighbours, ahead, step)
    if partner >= 0:
        for i in range(count // 2):
            j = count - 1 - i
            one = step.candidates[robot, i]
            step.candidates[robot, i], step.candidates[robot, j] = step.candidates[robot, j], one
    step.counts[robot, 0], step.counts[robot, 1] = count, 0
    step.counts[robot, 2], step.counts[robot, 3] = step.state[0], partner


@leaf
def _take_back(mark: int, step: TeamStep) -> None:
    """Take back all decisions after the first ``mark`` ones."""
    while step.state[0] > mark:
        step.state[0] -= 1
        step.moves[step.trail[step.state[0]]] = -1


@inlined
def _settle(robot: int, step: TeamStep) -> None:
    step.trail[step.state[0]] = robot
    step.state[0] += 1


@leaf
def _pull_partner(robot: int, graph: GraphArrays, step: TeamStep) -> None:
    """Let the partner of a swap follow into the place that a robot leaves by its first choice."""
    partner = step.counts[robot, 3]
    if partner < 0 or step.counts[robot, 1] != 1 or step.moves[partner] >= 0 or step.moves[robot] == 0:
        return
    for m in range(1, 9):
        if graph.neighbours[step.here[partner], m] == step.here[robot]:
            step.moves[partner] = m
            if in_the_way(partner, graph, step) == -1:
                _settle(partner, step)
            else:
                step.moves[partner] = -1


@leaf
def _next_candidate(robot: int, graph: GraphArrays, step: TeamStep) -> bool:
    """Choose the next of a robot's moves that hits nobody whose move is decided; False if there is none left."""
    while step.counts[robot, 1] < step.counts[robot, 0]:
        move = step.candidates[robot, step.counts[robot, 1]]
        step.counts[robot, 1] += 1
        if not hits_decided(robot, move, graph, step):
            step.moves[robot] = move
            return True
    return False


@leaf
def _decide(first: int, graph: GraphArrays, ahead: NDArray[np.int32], step: TeamStep) -> bool:
    """Decide on the move of a robot and of all that have to make room for it; False if there is none."""
    several, depth = step.state[2] > 0, 0
    step.frames[0] = first
    _begin_frame(first, graph, ahead, step)
    while depth >= 0:
        robot = step.frames[depth]
        if step.moves[robot] >= 0:
            other = in_the_way(robot, graph, step)
            if other >= 0:
                depth += 1
                step.frames[depth] = other
                _begin_frame(other, graph, ahead, step)
                continue
            if other == -1:
                _settle(robot, step)
                _pull_partner(robot, graph, step)
                depth -= 1
                continue
            if several:
                _take_back(step.counts[robot, 2], step)
            step.moves[robot] = -1
        if _next_candidate(robot, graph, step):
            step.state[1] -= 1
            if several and step.state[1] < 0:
                return False
            continue
        depth -= 1
        if several:
            if depth < 0:
                return False
            _take_back(step.counts[step.frames[depth], 2], step)
            step.moves[step.frames[depth]] = -1
        else:  # it stays, and the one before it sees that its own move is not possible
            step.moves[robot] = 0
            _settle(robot, step)
    return True


@leaf
def _decide_without_pushing(robot: int, graph: GraphArrays, ahead: NDArray[np.int32], step: TeamStep) -> bool:
    """Decide on the best move that hits nobody, neither if those without a move wait."""
    _begin_frame(robot, graph, ahead, step)
    while _next_candidate(robot, graph, step):
        if in_the_way(robot, graph, step) == -1:
            return True
        step.moves[robot] = -1
    return False


@kernel
def next_configuration(
    order: NDArray[np.int16],
    constraints: NDArray[np.int64],
    depth: int,
    graph: GraphArrays,
    ahead: NDArray[np.int32],
    step: TeamStep,
) -> bool:
    """Decide on a move of every robot, into ``step.moves``; False if these constraints allow none that was found.

    Args:
        order: (k,) robots, first the one with the highest priority.
        constraints: (k,) moves that the first ``depth`` robots of ``order`` have to do.
        depth: Number of constraints.
        graph: Where moves lead, and which conflict.
        ahead: (k, n) cost of the rest of each robot's way.
        step: Where the robots are: ``here`` and ``occupant``.
    """
    team = len(order)
    step.state[0], step.state[1] = 0, _TRIALS + _TRIALS_A_ROBOT * team
    step.moves[:] = -1
    for d in range(depth):
        robot = np.int64(order[d])
        if hits_decided(robot, constraints[d], graph, step):
            return False
        step.moves[robot] = constraints[d]
    pushed = True
    for d in range(depth, team):
        robot = np.int64(order[d])
        if step.moves[robot] < 0 and not _decide(robot, graph, ahead, step):
            pushed = False
            break
    if not pushed:
        for d in range(depth, team):
            step.moves[order[d]] = -1
        for d in range(depth, team):
            if not _decide_without_pushing(np.int64(order[d]), graph, ahead, step):
                return False
    valid = True
    for one in range(team):
        valid = valid and not hits_decided(one, int(step.moves[one]), graph, step)
    return valid
