"""The joint optimum for two robots: A* over pairs of places."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel
from lidarena.planning.team.moves import MOVES, too_close
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.team_plan import TeamPlan, failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic

_STATES_A_SECOND = 1_000_000
_MOST_OPEN = 2**24


@kernel
def _conflict_bits(apart: float, moves: NDArray[np.int64], reach: int) -> NDArray[np.bool_]:
    """Whether moves conflict: (row + reach, column + reach, first's move, second's move), second seen from first."""
    side = 2 * reach + 1
    bits = np.zeros((side, side, 9, 9), np.bool_)
    for r in range(side):
        for c in range(side):
            for a in range(9):
                for b in range(9):
                    rows, cols = float(moves[b, 0] - moves[a, 0]), float(moves[b, 1] - moves[a, 1])
                    bits[r, c, a, b] = too_close(float(r - reach), float(c - reach), rows, cols, apart)
    return bits


@kernel
def _search(  # noqa: C901 - the loop of a search
    neighbours: NDArray[np.int32],
    cells: NDArray[np.int64],
    ahead: NDArray[np.int32],
    ends: NDArray[np.int64],
    conflict: NDArray[np.bool_],
    most: int,
    open_room: int,
    paths: NDArray[np.int32],
) -> tuple[int, int, int]:
    """A* over states (place of one, place of the other, who rests for good: nobody, the one, the other).

    A robot at its goal may rest there for good; from then on its time costs nothing.

    Returns:
        Steps of both (-1, -1 if there is no plan, -2, -2 if the search gave up) and how many states were expanded.
    """
    places = len(cells)
    reach = conflict.shape[0] // 2
    spent = np.zeros(3 * places * places, np.int32)  # cost so far + 1, 0 = not met
    before = np.zeros(3 * places * places, np.int32)
    keys, items = np.empty(open_room, np.int64), np.empty(open_room, np.int32)
    start = (ends[0, 0] * places + ends[1, 0]) * 3
    spent[start], before[start] = 1, -1
    size = push(keys, items, np.int64(0), np.int64(0), start)
    expanded = 0
    while size > 0:
        state, key = np.int64(items[0]), keys[0]
        size = pop(keys, items, size)
        one, other, rests = state // 3 // places, state // 3 % places, state % 3
        cost = np.int64(spent[state] - 1)
        if state != start and key >> 31 > cost + ahead[0, one] + ahead[1, other]:
            continue  # a cheaper way here was found after this entry
        if ahead[0, one] == 0 and ahead[1, other] == 0:
            steps = _trace(before, state, places, paths)
            return steps[0], steps[1], expanded
        expanded += 1
        if expanded > most or size + 90 > open_room:
            return -2, -2, expanded
        row, col = cells[other, 0] - cells[one, 0], cells[other, 1] - cells[one, 1]
        near = abs(row) <= reach and abs(col) <= reach
        for phase in range(3):  # go on, or let one of them rest from now on
            if phase != rests and (rests != 0 or (ahead[0, one] if phase == 1 else ahead[1, other]) != 0):
                continue
            for a in range(1 if phase == 1 else 9):
                to = np.int64(neighbours[one, a])
                if to < 0:
                    continue
                for b in range(1 if phase == 2 else 9):
                    other_to = np.int64(neighbours[other, b])
                    if other_to < 0 or (near and conflict[row + reach, col + reach, a, b]):
                        continue
                    new = cost + (4096 if phase else 8192) + (1 if a > 4 else 0) + (1 if b > 4 else 0)
                    following = (to * places + other_to) * 3 + phase
                    if spent[following] == 0 or new + 1 < spent[following]:
                        spent[following] = new + 1
                        before[following] = state
                        bound = new + ahead[0, to] + ahead[1, other_to]
                        size = push(keys, items, size, (bound << 31) - new, following)
    return -1, -1, expanded


@kernel
def _trace(before: NDArray[np.int32], state: int, places: int, paths: NDArray[np.int32]) -> tuple[int, int]:
    """Write the two paths (2, capacity); return when each came to its goal for good, -2 without room."""
    length = 0
    at = state
    while before[at] >= 0:
        at = int(before[at])
        length += 1
    if length >= paths.shape[1]:
        return -2, -2
    at = state
    for t in range(length, -1, -1):
        paths[0, t], paths[1, t] = at // 3 // places, at // 3 % places
        at = int(before[at])
    one, other = length, length
    while one > 0 and paths[0, one - 1] == paths[0, one]:
        one -= 1
    while other > 0 and paths[1, other - 1] == paths[1, other]:
        other -= 1
    return one, other


def plan_joint(traffic: Traffic, seconds: float) -> TeamPlan:
    """The optimal plan of two robots.

    Args:
        traffic: Two robots, none placed.
        seconds: Time limit; the search expands a million states a second.
    """
    graph = traffic.graph
    reach = int(np.ceil(graph.apart)) + 2
    if 3 * len(graph) ** 2 >= 2**31:
        return failed_plan(
            traffic, f"Joint A* has no room for {len(graph)} places squared; 'cbs' finds the optimum on large maps."
        )
    one, other, expanded = _search(
        graph.neighbours,
        graph.cells,
        traffic.ahead,
        traffic.ends,
        _conflict_bits(graph.apart, MOVES, np.int64(reach)),
        np.int64(min(seconds, 1e6) * _STATES_A_SECOND),
        np.int64(_MOST_OPEN),
        traffic.paths,
    )
    if one < 0:
        what = "there is no plan for robots 0 and 1 together" if one == -1 else "the limit was reached"
        return failed_plan(traffic, f"Joint A* ended after {expanded} states: {what}.")
    traffic.lengths[:] = one, other
    traffic.place(np.arange(2))
    return solved_plan(traffic, f"Joint A* expanded {expanded} states.", lower_bound=traffic.cost())
