"""What a planner of a team returns."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.team.traffic import Traffic


@dataclass(frozen=True)
class TeamPlan:
    """Paths of a team, or the reason why there are none.

    Attributes:
        solved: Whether every robot reaches its goal and stays there, and no two come too close.
        paths: For each robot (T, 2) int cells [row, column], one a time step, from its start to its goal, where it
            stays for ever after; (0, 2) for a robot without a path. ``independent_astar`` returns its paths also where
            they conflict.
        cost: Steps of all robots together until they stay at their goals: the cells that they traverse plus the steps
            that they wait (Bennewitz & Burgard's score, section 3.2); a diagonal counts as one. inf if a path is
            missing.
        lower_bound: No plan costs less: the sum of the shortest paths, each planned alone, or more if the method
            has proved more.
        optimal: Whether it is certified that no plan costs less.
        message: One sentence: what was done; if nothing was found, which robot failed after what search.
        order: The robots by falling priority, where the method has priorities.
    """

    solved: bool
    paths: list[NDArray[np.int64]]
    cost: float
    lower_bound: float
    optimal: bool
    message: str
    order: tuple[int, ...] = ()


def solved_plan(
    traffic: Traffic, message: str, lower_bound: int | None = None, order: NDArray[np.int64] | None = None
) -> TeamPlan:
    """The plan in which every robot takes its path of ``traffic``."""
    least = int(traffic.alone.sum()) if lower_bound is None else lower_bound
    priorities = () if order is None else tuple(int(robot) for robot in order)
    return TeamPlan(
        True, traffic.cells(), float(traffic.cost()), float(least), traffic.cost() <= least, message, priorities
    )


def failed_plan(traffic: Traffic, message: str, order: NDArray[np.int64] | None = None) -> TeamPlan:
    """The plan of a team of which only the robots that are placed in ``traffic`` have a path."""
    nothing = np.empty((0, 2), np.int64)
    paths = [path if placed else nothing for path, placed in zip(traffic.cells(), traffic.placed, strict=True)]
    priorities = () if order is None else tuple(int(robot) for robot in order)
    return TeamPlan(False, paths, math.inf, float(traffic.alone.sum()), False, message, priorities)
