"""How two robots that conflict are kept apart: two constraints, one of which every plan without conflicts obeys.

The constraints of conflict-based search forbid one move of one robot each; with discs as large as several cells, a
conflict would come back in hundreds of variants. So the moment and the point where the two are closest are taken, and
each robot is forbidden *every* move that at this moment is within a radius of this point: two that both were would
overlap (mutually disjunctive constraints, Li et al. 2019, "Multi-agent path finding for large agents"). A robot that
conflicts with one at its goal either never comes close from then on, or the other arrives later.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.team.grid_graph import GridGraph
from lidarena.planning.team.moves import CLOSE, MOVES, nearest_approach
from lidarena.planning.team.reservations import row_of
from lidarena.planning.team.search_arrays import Reservations


class Constraint(NamedTuple):
    """Moves that one robot must not do.

    Attributes:
        robot: The robot.
        time: The step.
        moves: (n, 2) places, and bits of the moves from there.
        forever: Whether they are also forbidden in all later steps.
    """

    robot: int
    time: int
    moves: NDArray[np.int64]
    forever: bool


@leaf
def forbid(moves: NDArray[np.int64], time: int, forever: bool, reserved: Reservations) -> None:
    """Enter a constraint into reservation tables, in which nothing else but constraints may stand."""
    for k in range(len(moves)):
        place = moves[k, 0]
        if forever:
            for b in range(9):
                if moves[k, 1] >> b & 1:
                    reserved.since[place, b] = min(reserved.since[place, b], time)
        else:
            row = row_of(reserved, place, time)
            for b in range(9):
                if moves[k, 1] >> b & 1:
                    reserved.counts[row, time & 15] |= np.int64(1) << np.int64(4 * b)
            reserved.until[place] = max(reserved.until[place], time + 1)


@leaf
def permit(moves: NDArray[np.int64], time: int, forever: bool, reserved: Reservations) -> None:
    """Empty what ``forbid`` has entered."""
    for k in range(len(moves)):
        place = moves[k, 0]
        reserved.since[place, :] = 2**30
        reserved.until[place] = 0
        if not forever:
            reserved.counts[row_of(reserved, place, time), time & 15] = 0


def split(
    graph: GridGraph,
    ends: NDArray[np.int64],
    robots: tuple[int, int],
    time: int,
    steps: NDArray[np.int64],
    resting: int,
) -> tuple[Constraint, Constraint]:
    """The two constraints that a conflict leads to.

    Args:
        graph: The graph.
        ends: (k, 2) start and goal places.
        robots: The two that conflict.
        time: The step in which they do.
        steps: (2, 2) places of each at the step's beginning and end.
        resting: Which of the two, 0 or 1, is at its goal for good by ``time``; -1 = neither.
    """
    if resting >= 0:
        rests, moves = robots[resting], robots[1 - resting]
        goal = ends[rests, 1]
        return (
            Constraint(moves, time, _near_goal(graph, int(goal)), True),
            Constraint(rests, time, np.array([[goal, 1]], np.int64), False),
        )
    one, other = graph.cells[steps].astype(np.float64)  # (begin and end, row and column) each
    (r0, c0), (r1, c1) = one.tolist()
    (p0, q0), (p1, q1) = other.tolist()
    when = nearest_approach(p0 - r0, q0 - c0, (p1 - p0) - (r1 - r0), (q1 - q0) - (c1 - c0))
    row = (r0 + p0 + when * (r1 - r0 + p1 - p0)) / 2
    col = (c0 + q0 + when * (c1 - c0 + q1 - q0)) / 2
    moves_there = _through(graph, when, row, col)
    return Constraint(robots[0], time, moves_there, False), Constraint(robots[1], time, moves_there, False)


def _through(graph: GridGraph, when: float, row: float, col: float) -> NDArray[np.int64]:
    """Every move that leads within a radius of a point at a moment of the step."""
    reach = int(np.ceil(graph.radius)) + 2
    rows, cols = graph.index.shape
    found = []
    for r in range(max(int(row) - reach, 0), min(int(row) + reach + 1, rows)):
        for c in range(max(int(col) - reach, 0), min(int(col) + reach + 1, cols)):
            place = graph.index[r, c]
            if place < 0:
                continue
            away = (r + when * MOVES[:, 0] - row) ** 2 + (c + when * MOVES[:, 1] - col) ** 2
            close = away < max(graph.radius**2 - CLOSE / 4, CLOSE / 4)
            bits = int(np.sum((close & (graph.neighbours[place] >= 0)) << np.arange(9)))
            if bits:
                found.append((place, bits))
    return np.array(found, np.int64).reshape(-1, 2)


def _near_goal(graph: GridGraph, goal: int) -> NDArray[np.int64]:
    """Every move that conflicts with a robot which waits at a place."""
    entries = graph.entries[graph.begins[0] : graph.begins[1]]
    places = graph.padded[graph.at[goal] + entries[:, 0]]
    moves: NDArray[np.int64] = np.stack([places, entries[:, 1]], axis=1)[places >= 0].astype(np.int64)
    return moves
