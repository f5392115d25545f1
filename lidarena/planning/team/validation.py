"""Whether a plan is what it says: slow, short, and sharing nothing with the planners that it judges.

For tests and benchmarks. Walls, moves and distances are computed here from their definitions, one pair and one step at
a time, without the planners' tables, cells' numbers or kernels.
"""

import itertools
import math

import numpy as np
from numpy.typing import ArrayLike

from lidarena.planning.team.team_plan import TeamPlan

_SLACK = 1e-6


def validate_plan(
    plan: TeamPlan, grid: ArrayLike, starts: ArrayLike, goals: ArrayLike, connectivity: int = 8, radius: float = 0.0
) -> list[str]:
    """Return everything that is wrong with a plan that claims to be solved.

    Args:
        plan: The plan.
        grid: (rows, cols) bool, True = blocked.
        starts: (k, 2) [row, column].
        goals: (k, 2) [row, column].
        connectivity: 4 or 8 neighbours.
        radius: Of every robot [cells].

    Returns:
        One sentence for each fault; empty if there is none.
    """
    blocked = [[bool(cell) for cell in row] for row in np.asarray(grid)]
    paths = [[(int(r), int(c)) for r, c in path] for path in plan.paths]
    faults = []
    if not plan.solved:
        faults.append("the plan is not solved")
    if len(paths) != len(np.asarray(starts)):
        return [*faults, f"there are {len(paths)} paths for {len(np.asarray(starts))} robots"]
    for robot, (path, start, goal) in enumerate(zip(paths, np.asarray(starts), np.asarray(goals), strict=True)):
        if not path or path[0] != tuple(start) or path[-1] != tuple(goal):
            faults.append(f"robot {robot} does not go from its start to its goal")
        faults += _faults_of_path(robot, path, blocked, connectivity, radius)
    if not all(paths):
        return faults
    for (i, one), (j, other) in itertools.combinations(enumerate(paths), 2):
        faults += [f"robots {i} and {j} collide in step {t}" for t in _collisions(one, other, 2.0 * radius)]
    steps = sum(_steps(path) for path in paths)
    if plan.cost != steps:
        faults.append(f"the cost is said to be {plan.cost}; the paths have {steps} steps")
    if plan.lower_bound > plan.cost:
        faults.append(f"the lower bound {plan.lower_bound} is above the cost {plan.cost}")
    if plan.optimal != (plan.lower_bound == plan.cost):
        faults.append(f"optimal is {plan.optimal} with a bound of {plan.lower_bound} and a cost of {plan.cost}")
    return faults


def _steps(path: list[tuple[int, int]]) -> int:
    """Steps until the robot stays at its goal."""
    steps = len(path) - 1
    while steps > 0 and path[steps - 1] == path[steps]:
        steps -= 1
    return steps


def _faults_of_path(
    robot: int, path: list[tuple[int, int]], blocked: list[list[bool]], connectivity: int, radius: float
) -> list[str]:
    faults = []
    for t, cell in enumerate(path):
        if not _fits(cell, blocked, radius):
            faults.append(f"robot {robot} touches a wall at {cell} at time {t}")
    for t, ((r0, c0), (r1, c1)) in enumerate(itertools.pairwise(path)):
        rows, cols = abs(r1 - r0), abs(c1 - c0)
        if max(rows, cols) > 1 or (connectivity == 4 and rows + cols > 1):
            faults.append(f"robot {robot} jumps from {(r0, c0)} to {(r1, c1)} in step {t}")
        elif rows and cols and (blocked[r0][c1] or blocked[r1][c0]):
            faults.append(f"robot {robot} cuts a corner from {(r0, c0)} to {(r1, c1)} in step {t}")
    return faults


def _fits(cell: tuple[int, int], blocked: list[list[bool]], radius: float) -> bool:
    """Whether a disc on a cell's centre touches no blocked unit square and stays on the grid."""
    row, col = cell
    reach = math.ceil(radius + 0.5)
    for r in range(row - reach, row + reach + 1):
        for c in range(col - reach, col + reach + 1):
            inside = 0 <= r < len(blocked) and 0 <= c < len(blocked[0])
            if inside and not blocked[r][c]:
                continue
            gap = math.hypot(max(abs(r - row) - 0.5, 0.0), max(abs(c - col) - 0.5, 0.0))
            if gap < radius - _SLACK or (r, c) == cell:
                return False
    return True


def _collisions(one: list[tuple[int, int]], other: list[tuple[int, int]], apart: float) -> list[int]:
    """Steps in which two robots come closer than ``apart`` or meet, the endless last one included."""
    found = []
    for t in range(max(len(one), len(other))):
        a, b = (np.array(path[min(t, len(path) - 1)], float) for path in (one, other))
        c, d = (np.array(path[min(t + 1, len(path) - 1)], float) for path in (one, other))
        gap, change = b - a, (d - c) - (b - a)
        speed = float(change @ change)
        when = min(max(-float(gap @ change) / speed, 0.0), 1.0) if speed > 0 else 0.0
        nearest = math.hypot(*(gap + when * change))
        if nearest < apart - _SLACK or nearest < _SLACK:
            found.append(t)
    return found
