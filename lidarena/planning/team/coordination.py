"""The coordination diagram: robots keep to their independent paths and only choose when to go and when to wait.

O'Donnell & Lozano-Pérez 1989, prioritized as in Bennewitz & Burgard (section 3.2) and in LaValle, "Planning
Algorithms", chapter 7.2: for each robot in turn, which points of its path it can have reached at which time, past the
robots before it.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.planning.team.prioritized import longest_first, plan_alone
from lidarena.planning.team.reservations import move_between
from lidarena.planning.team.route import free_from
from lidarena.planning.team.search_arrays import Reservations, counts_at
from lidarena.planning.team.team_plan import TeamPlan, failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic


@leaf
def _schedule(
    path: NDArray[np.int32],
    length: int,
    back_up: bool,
    neighbours: NDArray[np.int32],
    reserved: Reservations,
    before: NDArray[np.int32],
    result: NDArray[np.int32],
) -> int:
    """The quickest timing of a path past what is reserved.

    Args:
        path: (at least length + 1,) places.
        length: Steps of the path without waiting.
        back_up: Whether the robot may also drive backwards along its path.
        neighbours: (n, 9) where moves lead.
        reserved: Moves that are taken.
        before: (times, length + 1) room: the index on the path a step earlier, -1 where unreachable.
        result: (times,) gets the places, one a time step.

    Returns:
        The number of steps, -1 if there is no timing.
    """
    rest = free_from(reserved, np.int64(path[length]))
    if rest < 0:
        return -1
    before[0, :] = -1
    before[0, 0] = 0
    for t in range(len(before) - 1):
        if before[t, length] >= 0 and t >= rest:
            index = length
            for when in range(t, -1, -1):
                result[when] = path[index]
                index = int(before[when, index])
            return t
        before[t + 1, :] = -1
        for s in range(length + 1):
            if before[t, s] < 0:
                continue
            here = np.int64(path[s])
            for ahead in range(-1 if back_up else 0, 2):
                to = s + ahead
                if to < 0 or to > length:
                    continue
                m = move_between(neighbours, here, np.int64(path[to]))
                taken = t < reserved.until[here] and counts_at(reserved, here, t) >> 4 * m & 15
                if not taken and t < reserved.since[here, m]:
                    before[t + 1, to] = s
    return -1


def plan_coordination(traffic: Traffic, back_up: bool = False) -> TeamPlan:
    """Coordinate a team on its independent paths, longest first.

    Args:
        traffic: The team, no robot placed.
        back_up: Whether robots may also drive backwards along their paths.
    """
    plan_alone(traffic)
    order = longest_first(traffic)
    graph = traffic.graph
    result = np.zeros(traffic.capacity, np.int32)
    for k, robot in enumerate(order):
        length = traffic.lengths[robot]
        steps = _schedule(
            traffic.paths[robot],
            length,
            back_up,
            graph.neighbours,
            traffic.reserved,
            np.empty((traffic.capacity, length + 1), np.int32),
            result,
        )
        if steps < 0:
            message = (
                f"Robot {robot} (priority {k + 1} of {len(traffic)}, longest first) has no timing on its own path"
                f" that passes the robots before it within {traffic.capacity} steps of the coordination diagram."
            )
            return failed_plan(traffic, message, order)
        traffic.paths[robot] = result
        traffic.lengths[robot] = steps
        traffic.place(np.array([robot]))
    waits = traffic.cost() - int(traffic.alone.sum())
    return solved_plan(traffic, f"The robots wait for {waits} steps on their independent paths.", order=order)
