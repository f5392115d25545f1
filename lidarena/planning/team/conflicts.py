"""Which robots of a team come too close to each other, when, and who stands in whose way."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.team.moves import too_close


@leaf
def first_conflict(
    cells: NDArray[np.int64],
    one: NDArray[np.int32],
    steps_one: int,
    other: NDArray[np.int32],
    steps_other: int,
    apart: float,
    begin: int,
) -> int:
    """The first step from ``begin`` on in which two robots conflict; -1 if they never do.

    Args:
        cells: (n, 2) [row, column] of the places.
        one: Places of a path, one a time step; it rests at the place of index ``steps_one``.
        steps_one: Steps of that path.
        other: As ``one``.
        steps_other: As ``steps_one``.
        apart: Sum of the two radii [cells].
        begin: First step to look at.
    """
    for t in range(begin, max(steps_one, steps_other, begin + 1)):
        a, b = one[min(t, steps_one)], other[min(t, steps_other)]
        c, d = one[min(t + 1, steps_one)], other[min(t + 1, steps_other)]
        row, col = float(cells[b, 0] - cells[a, 0]), float(cells[b, 1] - cells[a, 1])
        rows = float(cells[d, 0] - cells[c, 0]) - row
        cols = float(cells[d, 1] - cells[c, 1]) - col
        if too_close(row, col, rows, cols, apart):
            return t
    return -1


@kernel
def conflict_times(
    cells: NDArray[np.int64], paths: NDArray[np.int32], lengths: NDArray[np.int64], apart: float
) -> NDArray[np.int64]:
    """Each pair's first step in which it conflicts, (k, k), symmetric; -1 where it never does.

    Args:
        cells: (n, 2) [row, column] of the places.
        paths: (k, capacity) places, one a time step.
        lengths: (k,) steps of each path.
        apart: Sum of two radii [cells].
    """
    team = len(lengths)
    times = np.full((team, team), -1, np.int64)
    for i in range(team):
        for j in range(i):
            t = first_conflict(cells, paths[i], lengths[i], paths[j], lengths[j], apart, np.int64(0))
            times[i, j] = t
            times[j, i] = t
    return times


@leaf
def find_blocking_agents(
    robot: int,
    begin: int,
    cells: NDArray[np.int64],
    neighbours: NDArray[np.int32],
    ahead: NDArray[np.int32],
    paths: NDArray[np.int32],
    lengths: NDArray[np.int64],
    apart: float,
    choices: NDArray[np.int64],
    blocking: NDArray[np.bool_],
    way: NDArray[np.int32],
) -> None:
    """Mark the robots with which one would conflict if from time ``begin`` on it took a shortest way to its goal.

    Args:
        robot: The one.
        begin: When it leaves its path, at most its length.
        cells: (n, 2) of the places.
        neighbours: (n, 9) where moves lead.
        ahead: (n,) what the rest of the way costs it.
        paths: (k, capacity) of the team.
        lengths: (k,) of the team.
        apart: Sum of two radii [cells].
        choices: (m,) random numbers that choose among equally short ways.
        blocking: (k,) gets True for the robots.
        way: (m,) scratch for the steps of the shortest way, at least as many as ``ahead`` tells and two more.
    """
    here, arrival = np.int64(paths[robot, begin]), begin
    way[0] = here
    while ahead[here] > 0:
        turn = choices[arrival % len(choices)]
        for k in range(8):
            there = np.int64(neighbours[here, 1 + (k + turn) % 8])
            if there >= 0 and ahead[there] >> 12 < ahead[here] >> 12:
                here = there
                break
        arrival += 1
        way[arrival - begin] = here
    final = arrival
    for other in range(len(lengths)):
        final = max(final, lengths[other])
    for other in range(len(lengths)):
        t = begin
        while other != robot and t < final:
            a, mine = paths[other, min(t, lengths[other])], way[min(t, arrival) - begin]
            row, col = cells[a, 0] - cells[mine, 0], cells[a, 1] - cells[mine, 1]
            far = int(max(abs(row), abs(col)) - max(apart, 1.0)) // 2  # each comes nearer by a cell a step
            if far > 0:
                t += far
                continue
            b, next_mine = paths[other, min(t + 1, lengths[other])], way[min(t + 1, arrival) - begin]
            rows = cells[b, 0] - cells[next_mine, 0] - row
            cols = cells[b, 1] - cells[next_mine, 1] - col
            if too_close(float(row), float(col), float(rows), float(cols), apart):
                blocking[other] = True
                break
            t += 1
