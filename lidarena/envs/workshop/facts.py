"""What a workshop tells of itself: who does what, what is done, and how well the two work together."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.infos import Info
from lidarena.envs.workshop.actions import allowed
from lidarena.envs.workshop.kernels import AWAY, DONE, LEAVING
from lidarena.envs.workshop.task import HUMAN, ROBOT, TaskArrays

if TYPE_CHECKING:
    from lidarena.envs.workshop.recognition import Recognizer
    from lidarena.envs.workshop.state import WorkshopCore

Floats = NDArray[np.float64]
NEVER = -1.0
"""In place of a time that is not known yet."""


def describe(core: "WorkshopCore", recognizer: "Recognizer | None" = None) -> Info:
    """Where everybody is and what is done, as arrays over worlds; times of work are told once an action has ended."""
    s, task = core.workers, core.task
    doing = np.maximum(s.action, -1)
    if recognizer is not None:
        doing[:, HUMAN] = recognizer.guess()
    done = s.status == DONE
    free = allowed(task.arrays, s.status)
    return Info(
        {
            "time": core.time,
            "pose": s.poses.copy(),
            "path_length": s.path.copy(),
            "collision": s.contacts > 0,
            "radius": np.full(core.worlds, task.radii[ROBOT]),
            "success": done.all(axis=1),
            "doing": doing,
            "phase": s.phase.copy(),
            "stop": s.stop.copy(),
            "since": core.time[:, None] - s.changed,
            "human_present": (s.phase[:, HUMAN] != AWAY) & (s.action[:, HUMAN] != LEAVING),
            "status": s.status.copy(),
            "agent": s.agent.copy(),
            "begun": np.where(np.isnan(s.begun), NEVER, s.begun),
            "placed": np.where(np.isnan(s.placed), NEVER, s.placed),
            "ended": np.where(np.isnan(s.ended), NEVER, s.ended),
            "worked": np.where(done, s.worked, NEVER),
            "unplanned": s.unplanned.sum(axis=1),
            "allowed_human": free[:, HUMAN],
            "allowed_robot": free[:, ROBOT],
        }
    )


def measure(core: "WorkshopCore") -> Info:
    """How well it goes, as arrays over worlds; of a finished episode the measures."""
    s, task = core.workers, core.task
    time, done = core.time, s.status == DONE
    whole = np.maximum(time, 1e-9)
    return Info(
        {
            "completion": done.mean(axis=1),
            "makespan": time,
            "deadline_met": done.all(axis=1) & (time <= task.deadline),
            "human_idle": s.idle[:, HUMAN] / whole,
            "robot_idle": s.idle[:, ROBOT] / whole,
            "concurrent": s.together / whole,
            "functional_delay": functional_delay(task.arrays, s.agent, s.begun, s.ended) / whole,
            "bounds_broken": bounds_broken(task.arrays, s.agent, s.worked, done),
            "separation": s.least_gap.copy(),
        }
    )


def functional_delay(task: TaskArrays, agent: NDArray[np.int64], begun: Floats, ended: Floats) -> Floats:
    """Sum of the gaps between the end of one agent's action and the beginning of the other's that depended on it [s].

    Negative where the other began before that end (Hoffman 2019).

    Args:
        task: What depends on what.
        agent: (worlds, n).
        begun: (worlds, n) [s]; NaN before.
        ended: (worlds, n) [s]; NaN before.
    """
    delay = np.zeros(len(agent))
    for j in range(task.before.shape[0]):
        earlier = np.flatnonzero(task.before[:, j])
        if not len(earlier):
            continue
        ends = np.where(np.isnan(ended[:, earlier]), -np.inf, ended[:, earlier])
        last = earlier[ends.argmax(axis=1)]
        rows = np.arange(len(agent))
        gap = begun[:, j] - ended[rows, last]
        delay += np.where((agent[:, j] >= 0) & (agent[rows, last] != agent[:, j]) & np.isfinite(gap), gap, 0.0)
    return delay


def bounds_broken(task: TaskArrays, agent: NDArray[np.int64], worked: Floats, done: NDArray[np.bool_]) -> Floats:
    """Share of the human's finished actions whose work took less or more than its bounds, (worlds,).

    Args:
        task: Whose bounds.
        agent: (worlds, n).
        worked: (worlds, n) [s].
        done: (worlds, n).
    """
    low, high = (np.where(task.capable[0], one[0], one[1]) for one in (task.lower, task.upper))
    human = done & (agent == HUMAN)
    outside = human & ((worked < low - 1e-9) | (worked > high + 1e-9))
    share: Floats = outside.sum(axis=1) / np.maximum(human.sum(axis=1), 1)
    return share
