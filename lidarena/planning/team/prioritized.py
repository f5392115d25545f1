"""Bennewitz & Burgard's planner: independent paths, then space-time search for who conflicts with a robot before."""

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.team.conflicts import conflict_times
from lidarena.planning.team.deviation import DeviationCosts
from lidarena.planning.team.grid_graph import STEP
from lidarena.planning.team.team_plan import TeamPlan, failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic


def longest_first(traffic: Traffic) -> NDArray[np.int64]:
    """Bennewitz & Burgard's priorities: the robots by falling cost of the way alone, equal ones by number."""
    return np.argsort(-traffic.alone, kind="stable").astype(np.int64)


def plan_alone(traffic: Traffic) -> None:
    """Give every robot its shortest path, as if it were alone; nobody is placed in the tables."""
    for robot in range(len(traffic)):
        traffic.plan(np.array([robot]))
        traffic.remove(np.array([robot]))


def conflicts_of(traffic: Traffic) -> NDArray[np.int64]:
    """Each pair's first conflicting step (k, k), -1 where there is none."""
    graph = traffic.graph
    return conflict_times(graph.cells, traffic.paths, traffic.lengths, graph.apart)


def plan_independent(traffic: Traffic) -> TeamPlan:
    """A* for every robot alone; solved only if their paths happen not to conflict."""
    plan_alone(traffic)
    times = conflicts_of(traffic)
    pairs = np.argwhere(np.triu(times >= 0))
    if not len(pairs):
        return solved_plan(traffic, "The independent paths do not conflict.")
    i, j = min(pairs.tolist(), key=lambda pair: int(times[pair[0], pair[1]]))
    message = f"{len(pairs)} pairs of independent paths conflict, first robots {i} and {j} in step {times[i, j]}."
    plan = solved_plan(traffic, message)
    return TeamPlan(False, plan.paths, plan.cost, plan.lower_bound, False, message)


def plan_prioritized(traffic: Traffic, deviation: DeviationCosts | None = None) -> TeamPlan:
    """Bennewitz & Burgard's method: longest first, a robot is replanned only if it conflicts with one before it.

    Where robots may deviate from their paths, paths conflict already if the risk on the way is worth a step or more.

    Args:
        traffic: The team, no robot placed.
        deviation: What it costs to be where earlier robots may deviate to, eq. for C_t^k in section 2.
    """
    plan_alone(traffic)
    order = longest_first(traffic)
    replanned = 0
    for k, robot in enumerate(order):
        times = conflicts_of(traffic)[robot, order[:k]]
        risky = deviation is not None and deviation.charge(traffic, int(robot)) >= STEP
        if k and ((times >= 0).any() or risky):
            replanned += 1
            if not traffic.plan(np.array([robot])):
                message = (
                    f"Robot {robot} (priority {k + 1} of {len(traffic)}, longest first) found no way past the robots"
                    f" before it in space-time A* ({traffic.expanded} states)."
                )
                return failed_plan(traffic, message, order)
        else:
            traffic.place(np.array([robot]))
        if deviation is not None:
            deviation.add(traffic, int(robot))
    return solved_plan(traffic, f"{replanned} of {len(traffic)} robots were replanned.", order=order)
