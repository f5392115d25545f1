"""The temporal network of a plan: human actions as contingent links, robot actions and the deadline as requirements."""

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.workshop.compiler.schedule import Schedule, Snapshot
from lidarena.envs.workshop.task import HUMAN, ROBOT, WorkshopTask
from lidarena.temporal import STNU, check_controllability

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CONTROLLABLE, CONSISTENT, INCONSISTENT = range(3)
CATEGORIES = ("dynamically controllable", "consistent", "inconsistent")
"""What a plan can be, the best first: the robot can ensure the deadline; both together can; nobody can."""
WAY_SLACK = 1.1
"""Ways take up to so many times the time that was acquired."""
_LEAST = 0.1
"""What is overdue takes at least so much longer [s]."""


def plan_network(
    task: WorkshopTask, plan: Ints, schedule: Schedule, snapshot: Snapshot | None = None, now: float = 0.0,
    running: dict[int, tuple[float, float]] | None = None,
) -> STNU:  # fmt: skip
    """Return the network of a plan, or of what is left of it.

    Args:
        task: What is to be done.
        plan: (2, n) sequences of what is left, -1 behind the last one.
        schedule: Of that plan, for the ways.
        snapshot: What has been done so far; None at the beginning.
        now: Time since the episode began [s].
        running: Least and greatest time that is left of the actions under way, by their numbers [s].

    Returns:
        An ``STNU`` that begins ``now``. An action has the points ``.start``, ``.ready`` (at its last location),
        ``.place`` (the work there begins) and ``.end``.
    """
    network = STNU(["now", "finish"], name=task.name)
    network.add_requirement("now", "finish", 0.0)
    network.add_requirement("now", "finish", upper=task.deadline - now)  # below 0 once it has passed: inconsistent
    under_way = running or {}
    for action, (low, high) in under_way.items():
        _add_running(network, task, action, low, high)
    for agent in (HUMAN, ROBOT):
        earlier = [f"{task.actions[a]}.end" for a in under_way if _is_of(task, a, agent, snapshot, schedule)]
        last = earlier[0] if earlier else "now"
        for action in plan[agent][plan[agent] >= 0].tolist():
            _add_action(network, task, action, agent, schedule.ways[action])
            network.add_requirement(last, f"{task.actions[action]}.start", 0.0)
            last = f"{task.actions[action]}.end"
        network.add_requirement(last, "finish", 0.0)
    _add_precedence(network, task)
    _add_constraints(network, task, snapshot, now)
    return network


def _is_of(task: WorkshopTask, action: int, agent: int, snapshot: Snapshot | None, schedule: Schedule) -> bool:
    """Whether an action under way is that of an agent: the one who will be free when it ends."""
    return snapshot is not None and bool(snapshot.free[agent] == snapshot.ended[action])


def _add_running(network: STNU, task: WorkshopTask, action: int, low: float, high: float) -> None:
    name = task.actions[action]
    network.add_point(f"{name}.end")
    low, high = max(low, 0.0), max(high, _LEAST)
    network.add_contingent_link("now", f"{name}.end", min(low, high), high)


def _add_action(network: STNU, task: WorkshopTask, action: int, agent: int, ways: Floats) -> None:
    name, arrays = task.actions[action], task.arrays
    for point in ("start", "ready", "place", "end"):
        network.add_point(f"{name}.{point}")
    stops = int(arrays.stop_count[action])
    last = float(arrays.share[action, stops - 1])
    walk = float(np.nansum(ways[:stops]))
    low, high = float(arrays.lower[agent, action]), float(arrays.upper[agent, action])
    parts = [
        (f"{name}.start", f"{name}.ready", walk + low * (1.0 - last), WAY_SLACK * walk + high * (1.0 - last)),
        (f"{name}.place", f"{name}.end", low * last, high * last),
    ]
    for begin, end, least, most in parts:
        if agent == HUMAN:
            network.add_contingent_link(begin, end, least, most)
        else:
            network.add_requirement(begin, end, least, most)
    network.add_requirement(f"{name}.ready", f"{name}.place", 0.0)


def _add_precedence(network: STNU, task: WorkshopTask) -> None:
    for i, j in np.argwhere(task.arrays.before).tolist():
        before, after = task.actions[i], task.actions[j]
        if f"{after}.place" not in network or f"{before}.end" not in network:
            continue
        network.add_requirement(f"{before}.end", f"{after}.place", 0.0)
        if f"{before}.start" in network:
            network.add_requirement(f"{before}.start", f"{after}.start", 0.0)


def _add_constraints(network: STNU, task: WorkshopTask, snapshot: Snapshot | None, now: float) -> None:
    """Constraints between what is left, and from what is done to what is left."""
    times = {} if snapshot is None else _times_of(task, snapshot, now)
    for one in task.config.constraints:
        low, high = one.lower, one.upper
        start, end = one.start, one.end
        if start in times and end not in network:
            continue
        if start in times:
            ago = now - times[start]
            low, high = (None if bound is None else bound - ago for bound in (low, high))
            start = "now"
        if end in times or start not in network or end not in network:
            continue
        network.add_requirement(start, end, low)
        network.add_requirement(start, end, upper=high)


def _times_of(task: WorkshopTask, snapshot: Snapshot, now: float) -> dict[str, float]:
    """When the points of the constraints happened that have happened."""
    found = {}
    for number, name in enumerate(task.actions):
        for which, times in (("start", snapshot.begun), ("end", snapshot.ended)):
            if times[number] <= now:
                found[f"{name}.{which}"] = float(times[number])
    return found


def categorize(network: STNU) -> int:
    """Return ``CONTROLLABLE``, ``CONSISTENT`` or ``INCONSISTENT``."""
    if not network.is_consistent():
        return INCONSISTENT
    return CONTROLLABLE if check_controllability(network) else CONSISTENT
