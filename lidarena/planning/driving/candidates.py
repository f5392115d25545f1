"""Where the explorers of many worlds may go next: the frontiers, and places that they know, with the ways to them."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, merged_kernel
from lidarena.planning.driving.goals import GoalAccounts, is_given_up
from lidarena.planning.driving.state import Drive
from lidarena.planning.grid.frontiers import flood_frontiers, measure_frontier, nearest_cell, nearest_free
from lidarena.planning.grid.way_lengths import LEG, first_leg, way_lengths

FRONTIER, PLACE = 0, 1
"""Kinds of candidates: a frontier, or a place where the robot has been."""
BEYOND = 1e3
"""The way to what cannot be reached counts as so long [m]."""
AWAY = 2.0
"""Places to which the way is shorter are no candidates: the robot is there [m]."""
COARSE = 4
"""Ways between candidates are found on blocks of so many cells a side."""
_FAR_GOAL = 3.0  # a frontier whose nearest reachable cell is farther away than this is behind something [m]
_SAME_FRONTIER = 1.0  # a frontier with a cell so near to the goal is the one that was driven to [m]


class Candidates(NamedTuple):
    """At most K places a world, the nearest by way first.

    Attributes:
        number: (W,) how many there are.
        found: (W,) bool, whether there is any frontier, be it given up.
        apart: (W,) bool, whether there is any to which no way comes near.
        kind: (W, K) ``FRONTIER`` or ``PLACE``.
        goals: (W, K, 2, 2) where to go for it: to its middle, or to its end nearest to the robot; x, y [m].
        usable: (W, K, 2) bool, which of the two are of use.
        cell: (W, K, 2) row and column of the first of these in the ground.
        edge: (W, K, 2) row and column of an unknown cell of the frontier.
        size: (W, K) of the frontier [m].
        straight: (W, K) straight distance from the robot to its nearest cell [m].
        way: (W, K) length of the way there [m].
        turn: (W, K) angle from the robot's heading to the beginning of the way, from 0 to pi.
        between: (W, K, K) of the way from one to the other [m]; to itself the mean of those from everywhere.
        pursued: (W,) the one that is driven to, -1 if none is.
        log_d: (W, K) ln of D-optimality when the robot was there first.
        since: (W, K) how long ago that is [s].
    """

    number: NDArray[np.int64]
    found: NDArray[np.bool_]
    apart: NDArray[np.bool_]
    kind: NDArray[np.int64]
    goals: NDArray[np.float64]
    usable: NDArray[np.bool_]
    cell: NDArray[np.int64]
    edge: NDArray[np.int64]
    size: NDArray[np.float64]
    straight: NDArray[np.float64]
    way: NDArray[np.float64]
    turn: NDArray[np.float64]
    between: NDArray[np.float64]
    pursued: NDArray[np.int64]
    log_d: NDArray[np.float64]
    since: NDArray[np.float64]


def empty_candidates(worlds: int, most: int) -> Candidates:
    """Allocate room for so many a world."""
    return Candidates(
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.bool_),
        np.zeros(worlds, np.bool_),
        np.zeros((worlds, most), np.int64),
        np.zeros((worlds, most, 2, 2)),
        np.zeros((worlds, most, 2), np.bool_),
        np.zeros((worlds, most, 2), np.int64),
        np.zeros((worlds, most, 2), np.int64),
        np.zeros((worlds, most)),
        np.zeros((worlds, most)),
        np.zeros((worlds, most)),
        np.zeros((worlds, most)),
        np.zeros((worlds, most, most)),
        np.full(worlds, -1, np.int64),
        np.zeros((worlds, most)),
        np.zeros((worlds, most)),
    )


@merged_kernel
def lengths_from_robot(w: int, drive: Drive) -> NDArray[np.float64]:
    """Length of the way from the robot to every cell of the ground (rows, columns) [m], as of the newest survey."""
    ground = drive.ground
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    return ground.way[w, : rows * columns].reshape(rows, columns)


@merged_kernel
def _goal_cells(
    cells: NDArray[np.int32], centre: tuple[float, float], row: int, column: int, reachable: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.float64], float]:
    """Where to go for a frontier (2, 2), how far off that is (2,), and the distance from the robot to it, in cells."""
    goals, off = np.empty((2, 2), np.int64), np.empty(2)
    nearest, best = 0, np.inf
    for i in range(cells.shape[0]):
        away = float((cells[i, 0] - row) ** 2 + (cells[i, 1] - column) ** 2)
        if away < best:
            nearest, best = i, away
    goals[0, 0], goals[0, 1] = nearest_cell(reachable, centre[0], centre[1])
    off[0] = math.hypot(goals[0, 0] - centre[0], goals[0, 1] - centre[1])
    end_r, end_c = float(cells[nearest, 0]), float(cells[nearest, 1])
    goals[1, 0], goals[1, 1] = nearest_cell(reachable, end_r, end_c)
    off[1] = math.hypot(goals[1, 0] - end_r, goals[1, 1] - end_c)
    return goals, off, math.sqrt(best)


@merged_kernel
def _insert(w: int, way: float, candidates: Candidates) -> int:
    """Make room for a candidate among those of a world, which are kept in the order of their ways; -1 if it is last."""
    most, count = candidates.way.shape[1], int(candidates.number[w])
    at = count
    while at > 0 and way < candidates.way[w, at - 1]:
        at -= 1
    if at == most:
        return -1
    last = min(count, most - 1)
    for k in range(last, at, -1):
        candidates.kind[w, k] = candidates.kind[w, k - 1]
        candidates.goals[w, k] = candidates.goals[w, k - 1]
        candidates.usable[w, k] = candidates.usable[w, k - 1]
        candidates.cell[w, k] = candidates.cell[w, k - 1]
        candidates.edge[w, k] = candidates.edge[w, k - 1]
        candidates.size[w, k] = candidates.size[w, k - 1]
        candidates.straight[w, k] = candidates.straight[w, k - 1]
        candidates.way[w, k] = candidates.way[w, k - 1]
        candidates.log_d[w, k] = candidates.log_d[w, k - 1]
        candidates.since[w, k] = candidates.since[w, k - 1]
    candidates.number[w] = min(count + 1, most)
    candidates.way[w, at] = way
    if candidates.pursued[w] >= at:
        candidates.pursued[w] += 1
        if candidates.pursued[w] >= most:
            candidates.pursued[w] = -1
    return at


@merged_kernel
def find_frontier_candidates(
    w: int, least: float, lengths: NDArray[np.float64], drive: Drive, accounts: GoalAccounts, candidates: Candidates
) -> None:
    """Fill in the frontiers of at least so many metres that are not given up; those that were there are forgotten.

    Args:
        w: World.
        least: Size [m].
        lengths: (rows, columns) of the ways from the robot [m].
        drive: With the newest survey.
        accounts: Of the goals.
        candidates: Output.
    """
    ground, side = drive.ground, drive.ground.frame[w, 2]
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    occupancy = ground.occupancy[w, : rows * columns].reshape(rows, columns)
    reachable = ground.reachable[w, : rows * columns].reshape(rows, columns)
    candidates.number[w], candidates.pursued[w] = 0, -1
    candidates.found[w] = candidates.apart[w] = False
    row, column = nearest_free(occupancy, ground.cell[w, 0], ground.cell[w, 1])
    if row < 0:
        return
    _, cells, ends = flood_frontiers(occupancy, row, column)
    nearest = _SAME_FRONTIER / side
    for f in range(len(ends) - 1):
        own = cells[ends[f] : ends[f + 1]]
        if len(own) * side < least - 1e-9:
            continue
        _, middle_r, middle_c = measure_frontier(own, ground.cell[w, 0], ground.cell[w, 1])
        centre = (middle_r, middle_c)
        goals, off, straight = _goal_cells(own, centre, ground.cell[w, 0], ground.cell[w, 1], reachable)
        if goals[0, 0] < 0:
            return  # nothing can be reached at all
        candidates.found[w] = True
        candidates.apart[w] |= off.min() * side > _FAR_GOAL
        x = (goals[:, 1] + 0.5) * side + ground.frame[w, 0]
        y = (goals[:, 0] + 0.5) * side + ground.frame[w, 1]
        usable = np.empty(2, np.bool_)
        for k in range(2):
            usable[k] = off[k] * side <= _FAR_GOAL and not is_given_up(w, x[k], y[k], accounts)
        away = _distance_to_pursued(w, own, drive, accounts)
        is_pursued = away <= nearest
        if is_pursued:
            nearest, candidates.pursued[w] = away, -1  # none is, where that one has been given up
        if not usable.any():
            continue
        at = _insert(w, min(lengths[goals[0, 0], goals[0, 1]], BEYOND), candidates)
        if is_pursued:
            candidates.pursued[w] = at
        if at < 0:
            continue
        candidates.kind[w, at] = FRONTIER
        candidates.cell[w, at] = goals[0]
        candidates.edge[w, at] = own[0]
        candidates.usable[w, at] = usable
        candidates.goals[w, at, :, 0] = x
        candidates.goals[w, at, :, 1] = y
        candidates.size[w, at], candidates.straight[w, at] = len(own) * side, straight * side
        candidates.log_d[w, at], candidates.since[w, at] = 0.0, 0.0


@merged_kernel
def _distance_to_pursued(w: int, cells: NDArray[np.int32], drive: Drive, accounts: GoalAccounts) -> float:
    """Distance in cells from a frontier to the goal that is pursued, inf if none is."""
    if not accounts.has_pursued[w]:
        return np.inf
    frame, extent = drive.ground.frame[w], drive.ground.extent[w]
    row = min(max(math.floor((accounts.pursued[w, 1] - frame[1]) / frame[2]), 0), extent[2] - 1)
    column = min(max(math.floor((accounts.pursued[w, 0] - frame[0]) / frame[2]), 0), extent[3] - 1)
    best = np.inf
    for i in range(cells.shape[0]):
        best = min(best, float((cells[i, 0] - row) ** 2 + (cells[i, 1] - column) ** 2))
    return math.sqrt(best)


@merged_kernel
def add_place(
    w: int,
    x: float,
    y: float,
    log_d: float,
    since: float,
    lengths: NDArray[np.float64],
    drive: Drive,
    candidates: Candidates,
) -> None:
    """Add a place where the robot has been, if it can be reached and is two metres away."""
    ground, frame = drive.ground, drive.ground.frame[w]
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    row = min(max(math.floor((y - frame[1]) / frame[2]), 0), rows - 1)
    column = min(max(math.floor((x - frame[0]) / frame[2]), 0), columns - 1)
    reachable = ground.reachable[w, : rows * columns].reshape(rows, columns)
    row, column = nearest_cell(reachable, float(row), float(column))
    if row < 0 or not AWAY < lengths[row, column] < BEYOND:
        return
    at = _insert(w, lengths[row, column], candidates)
    if at < 0:
        return
    candidates.kind[w, at], candidates.cell[w, at, 0], candidates.cell[w, at, 1] = PLACE, row, column
    candidates.goals[w, at, :, 0] = (column + 0.5) * frame[2] + frame[0]
    candidates.goals[w, at, :, 1] = (row + 0.5) * frame[2] + frame[1]
    candidates.usable[w, at, 0], candidates.usable[w, at, 1] = True, False
    candidates.size[w, at], candidates.log_d[w, at], candidates.since[w, at] = 0.0, log_d, since
    candidates.straight[w, at] = lengths[row, column]


@merged_kernel
def measure_turns(
    w: int, pose: NDArray[np.float64], lengths: NDArray[np.float64], drive: Drive, candidates: Candidates
) -> None:
    """Fill in how far the robot must turn before it can set out for each candidate."""
    frame = drive.ground.frame[w]
    for k in range(candidates.number[w]):
        row, column = first_leg(lengths, candidates.cell[w, k, 0], candidates.cell[w, k, 1], LEG)
        x, y = (column + 0.5) * frame[2] + frame[0] - pose[0], (row + 0.5) * frame[2] + frame[1] - pose[1]
        angle = math.atan2(y, x) - pose[2]
        candidates.turn[w, k] = abs(angle - 2.0 * math.pi * round(angle / (2.0 * math.pi)))


@kernel
def _blocks(cost: NDArray[np.float64], reachable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Blocks of ``COARSE`` × ``COARSE`` cells, True where any of theirs can be reached."""
    rows, columns = cost.shape
    coarse = np.zeros((-(-rows // COARSE), -(-columns // COARSE)), np.bool_)
    for r in range(rows):
        for c in range(columns):
            if reachable[r, c]:
                coarse[r // COARSE, c // COARSE] = True
    return coarse


@merged_kernel
def measure_ways_between(w: int, radius: float, drive: Drive, candidates: Candidates) -> None:
    """Fill in the ways between the candidates, on blocks of cells.

    On the diagonal: the mean way to a candidate from all free blocks within ``radius`` of the robot, less the robot's
    own way there: the distance advantage (Ericson, Pedro, Jensfelt 2025).

    Args:
        w: World.
        radius: [m].
        drive: With the newest survey.
        candidates: With ``number`` and ``cell``.
    """
    ground = drive.ground
    rows, columns = ground.extent[w, 2], ground.extent[w, 3]
    coarse = _blocks(
        ground.cost[w, : rows * columns].reshape(rows, columns),
        ground.reachable[w, : rows * columns].reshape(rows, columns),
    )
    side, count = COARSE * ground.frame[w, 2], candidates.number[w]
    own_r, own_c = ground.cell[w, 0] // COARSE, ground.cell[w, 1] // COARSE
    for k in range(count):
        lengths = way_lengths(coarse, candidates.cell[w, k, 0] // COARSE, candidates.cell[w, k, 1] // COARSE)
        for j in range(count):
            r, c = candidates.cell[w, j, 0] // COARSE, candidates.cell[w, j, 1] // COARSE
            candidates.between[w, k, j] = min(lengths[r, c] * side, BEYOND)
        total, blocks = 0.0, 0
        for r in range(lengths.shape[0]):
            for c in range(lengths.shape[1]):
                near = (r - own_r) ** 2 + (c - own_c) ** 2 <= (radius / side) ** 2
                if near and coarse[r, c] and lengths[r, c] < np.inf:
                    total += lengths[r, c] * side
                    blocks += 1
        own = lengths[own_r, own_c] * side
        reached = blocks > 0 and own < np.inf
        candidates.between[w, k, k] = total / blocks - own if reached else -BEYOND
