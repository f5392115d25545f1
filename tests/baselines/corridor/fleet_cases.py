"""Teams without a world: plans on an empty floor, and robots that do exactly what they are told, or less."""

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.corridor.robot_interface import FleetState
from lidarena.planning.team.plan import plan_team
from lidarena.planning.team.team_plan import TeamPlan

Floats = NDArray[np.float64]
CELL = 0.2


def points(path: NDArray[np.int64]) -> Floats:
    """Centres x, y [m] of cells [row, column]."""
    centres: Floats = (path[:, ::-1] + 0.5) * CELL
    return centres


def still(poses: Floats, time: float = 0.0, arrived: tuple[int, ...] = ()) -> FleetState:
    """A team at poses (k, 3), or points (k, 2) from which they look to the right; those arrived are not active."""
    full = np.zeros((len(poses), 3))
    full[:, : poses.shape[1]] = poses
    there = np.isin(np.arange(len(poses)), arrived)
    return FleetState(full, np.zeros((len(poses), 2)), ~there, there, time)


def drive(poses: Floats, commands: Floats, period: float = 0.2, pieces: int = 4) -> list[Floats]:
    """Poses (k, 3) some moments apart while everybody obeys."""
    seen, pose = [], poses.copy()
    for _ in range(pieces):
        middle = pose[:, 2] + 0.5 * commands[:, 1] * period / pieces
        pose[:, 0] += commands[:, 0] * np.cos(middle) * period / pieces
        pose[:, 1] += commands[:, 0] * np.sin(middle) * period / pieces
        pose[:, 2] += commands[:, 1] * period / pieces
        seen.append(pose.copy())
    return seen


def busy_plan(seed: int, radius: float = 1.0) -> TeamPlan:
    """A plan for five robots of a radius [cells] on a floor with a wall and a gap in it, through which many go."""
    grid = np.zeros((20, 20), bool)
    grid[10, :8] = grid[10, 13:] = True
    ends = np.array([(3, 3), (3, 10), (3, 16), (16, 4), (16, 15)])
    goals = ends[np.random.default_rng(seed).permutation(5)]
    plan = plan_team(grid, ends, goals, "prioritized_search", 8, radius, np.inf, iterations=40, seed=seed)
    assert plan.solved
    return plan
