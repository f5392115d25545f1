"""What the robot, or the human, observes: a block of numbers for every action, and some of the whole."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.envs.workshop.kernels import DONE, IDLE, OPEN, RUNNING, WAITING, is_allowed
from lidarena.envs.workshop.records import Records
from lidarena.envs.workshop.task import HUMAN, TaskArrays
from lidarena.envs.workshop.walking import TICK, WalkGrid, way_length

OBSERVATIONS = ("features",)
PER_ACTION = 15
"""Numbers for each action."""
OF_ALL = 14
"""Numbers beside."""
LARGEST = 10.0
"""No number is larger."""
_WAY, _WORK = 20.0, 30.0
"""Times of ways and of work are observed over these [s]."""


@leaf
def observe(task: TaskArrays, grid: WalkGrid, s: Records, deadline: float, me: int, out: NDArray[np.float32]) -> None:
    """Fill ``out`` (worlds, n · PER_ACTION + OF_ALL) with what agent ``me`` observes; see ``WorkshopEnv``."""
    count = s.actions.shape[1]
    for w in range(out.shape[0]):
        time = s.world[w].ticks * TICK
        for k in range(count):
            row = out[w, k * PER_ACTION : (k + 1) * PER_ACTION]
            row[:] = 0.0
            row[0] = s.actions[w, k].status == OPEN
            row[1] = s.actions[w, k].status == RUNNING and s.actions[w, k].agent == me
            row[2] = s.actions[w, k].status == RUNNING and s.actions[w, k].agent == 1 - me
            row[3] = is_allowed(task, s, w, me, k)
            row[4] = is_allowed(task, s, w, 1 - me, k)
            if s.actions[w, k].status == DONE:
                continue
            row[5] = task.tail[k] / deadline
            for side in range(2):
                agent = me if side == 0 else 1 - me
                if not task.capable[agent, k]:
                    continue
                field = task.field[task.stops[k, 0], agent]
                way = way_length(grid, field, s.poses[w, agent, 0], s.poses[w, agent, 1])
                seconds = way * TICK / task.step[agent] + task.trip[agent, k]
                row[6 + 2 * side] = seconds / _WAY
                row[7 + 2 * side] = np.sqrt(task.lower[agent, k] * task.upper[agent, k]) / _WORK
            if s.actions[w, k].status == RUNNING:
                row[10] = (time - s.actions[w, k].begun) / _WORK
                row[11] = not np.isnan(s.actions[w, k].placed)
            row[13] = s.actions[w, k].passed_over / 3.0
            row[14] = s.actions[w, k].declined / 3.0
            for i in range(count):
                row[12] += (task.before[i, k] and s.actions[w, i].status != DONE) / 3.0
        _observe_all(task, s, w, deadline, me, out[w, count * PER_ACTION :])
        for i in range(out.shape[1]):
            out[w, i] = min(max(out[w, i], -LARGEST), LARGEST)


@leaf
def _observe_all(task: TaskArrays, s: Records, w: int, deadline: float, me: int, row: NDArray[np.float32]) -> None:
    """Fill ``row`` (OF_ALL,)."""
    other, time = 1 - me, s.world[w].ticks * TICK
    row[:] = 0.0
    row[0] = time / deadline
    row[1 + s.agents[w, other].phase] = 1.0
    taken, usual, seen, longest = 0.0, 0.0, 0.0, 0.0
    for k in range(s.actions.shape[1]):
        if s.actions[w, k].status == DONE and s.actions[w, k].agent == HUMAN:
            who = HUMAN if task.capable[HUMAN, k] else 1 - HUMAN
            taken += s.actions[w, k].worked
            usual += np.sqrt(task.lower[who, k] * task.upper[who, k])
            seen += 1.0
        elif s.actions[w, k].status != DONE:
            longest = max(longest, task.tail[k])
            row[8] += 1.0 / s.actions.shape[1]
    row[6] = taken / usual if usual > 0.0 else 1.0
    row[7] = seen / 5.0
    row[9] = longest / deadline
    row[10] = np.hypot(s.poses[w, 0, 0] - s.poses[w, 1, 0], s.poses[w, 0, 1] - s.poses[w, 1, 1]) / 10.0
    row[11] = s.agents[w, me].phase == IDLE
    row[12] = s.agents[w, other].idle / deadline
    row[13] = s.agents[w, me].phase == WAITING
