"""When two robots have to swap places in a passage, and whether they can (Okumura 2023, "Improving LaCAM", section 4).

In a passage as wide as one robot, two that want to get past each other push each other to and fro for ever. Where a
third way opens on the one side, the one that is to be passed follows the other away from its goal until it is there.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf

if TYPE_CHECKING:
    from lidarena.planning.team.pibt import TeamStep


@leaf
def _ways_on(
    place: int,
    back: int,
    neighbours: NDArray[np.int32],
    occupant: NDArray[np.int32],
    goals: NDArray[np.int64],
    degree: NDArray[np.int64],
) -> tuple[int, int]:
    """How many ways lead on from a place other than ``back``, and the last of them, -1 without one.

    Dead ends in which a robot has arrived are no ways on.
    """
    count, last = 0, np.int64(-1)
    for m in range(1, 9):
        there = np.int64(neighbours[place, m])
        if there < 0 or there == back:
            continue
        other = occupant[there]
        if degree[there] == 1 and other >= 0 and goals[other] == there:
            continue
        count += 1
        last = there
    return count, int(last)


@leaf
def _is_required(
    pusher: int,
    puller: int,
    begin: int,
    end: int,
    neighbours: NDArray[np.int32],
    ahead: NDArray[np.int32],
    step: "TeamStep",
) -> bool:
    """Whether two robots cannot both get on unless they swap: the pusher is at ``begin``, the puller at ``end``."""
    behind, front = begin, end
    for _ in range(len(neighbours)):
        if ahead[pusher, front] >= ahead[pusher, behind]:
            break
        count, on = _ways_on(front, behind, neighbours, step.occupant, step.goals, step.degree)
        if count >= 2:
            return False
        if count == 0:
            break
        behind, front = front, on
    wants_back = ahead[puller, behind] < ahead[puller, front]
    return bool(wants_back) and bool(ahead[pusher, behind] == 0 or ahead[pusher, front] < ahead[pusher, behind])


@leaf
def _is_possible(begin: int, end: int, neighbours: NDArray[np.int32], step: "TeamStep") -> bool:
    """Whether the passage that leads from ``begin`` over ``end`` comes to a place with a third way."""
    behind, front = begin, end
    for _ in range(len(neighbours)):
        if front == begin:
            return False
        count, on = _ways_on(front, behind, neighbours, step.occupant, step.goals, step.degree)
        if count != 1:
            return count >= 2
        behind, front = front, on
    return False


@leaf
def swap_partner(
    robot: int, best: int, neighbours: NDArray[np.int32], ahead: NDArray[np.int32], step: "TeamStep"
) -> int:
    """The robot with which one has to swap places, so that it should back off and be followed; -1 if there is none.

    Args:
        robot: The one.
        best: The place it would like to go to.
        neighbours: (n, 9) where moves lead.
        ahead: (k, n) cost of the rest of each robot's way.
        step: Where the robots are and what is decided.
    """
    here = np.int64(step.here[robot])
    if best == here:
        return -1
    other = np.int64(step.occupant[best])
    required = other >= 0 and step.moves[other] < 0
    required = required and _is_required(robot, int(other), int(here), best, neighbours, ahead, step)
    if required and _is_possible(best, int(here), neighbours, step):
        return int(other)
    for m in range(1, 9):  # a third robot that waits to get past from the other side
        there = np.int64(neighbours[here, m])
        if there < 0 or there == best:
            continue
        other = np.int64(step.occupant[there])
        required = other >= 0 and _is_required(int(other), robot, int(here), best, neighbours, ahead, step)
        if required and _is_possible(best, int(here), neighbours, step):
            return int(other)
    return -1
