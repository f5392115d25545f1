"""A workshop as its schedulers see it: what is done, who does what, when each will be free."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.registration import owner_of
from lidarena.envs.workshop.compiler.motion import WorkspaceMotion
from lidarena.envs.workshop.compiler.schedule import PlanProblem, Snapshot
from lidarena.envs.workshop.kernels import AWAY, DONE, OPEN, RUNNING, WALKING, WORKING
from lidarena.envs.workshop.task import HUMAN, ROBOT, WorkshopTask
from lidarena.envs.workshop.walking import way_length

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ABSENCE = 30.0
"""Somebody who is away is expected back after this time [s]."""
LEFT = 1.0
"""Work that takes longer than usual is expected to end in this time [s]."""


@dataclass(frozen=True)
class Situation:
    """What a scheduler is told.

    Attributes:
        time: Since the episode began [s].
        status: (n,) 0 open, 1 under way, 2 done.
        agent: (n,) who does it or did it.
        begun: (n,) [s]; NaN of what is open.
        ended: (n,) [s]; NaN of what is not done.
        doing: (2,) number of an action or -1.
        stop: (2,) at which of its locations.
        phase: (2,) see ``kernels``.
        since: (2,) for how long [s].
        places: (2, 2) where both are [m].
        mask: (n + 1,) what the robot may do.
    """

    time: float
    status: Ints
    agent: Ints
    begun: Floats
    ended: Floats
    doing: Ints
    stop: Ints
    phase: Ints
    since: Floats
    places: Floats
    mask: NDArray[np.bool_]

    @classmethod
    def read(cls, info: dict[str, Any]) -> "Situation":
        """Read an ``info``."""
        return cls(
            float(info["time"]), info["status"], info["agent"], info["begun"], info["ended"], info["doing"],
            info["stop"], info["phase"], info["since"], info["pose"][:, :2], np.asarray(info["action_mask"]),
        )  # fmt: skip

    @property
    def wait(self) -> int:
        """Number of the action that waits."""
        return len(self.status)

    @property
    def human_acts(self) -> bool:
        """Whether the human is at an action."""
        return bool(self.doing[HUMAN] >= 0)

    @property
    def may(self) -> Ints:
        """Numbers of the actions that the robot may begin."""
        return np.flatnonzero(self.mask[:-1])

    def order_of(self, agent: int) -> Ints:
        """What an agent has begun so far, in that order."""
        own = np.flatnonzero((self.status != OPEN) & (self.agent == agent))
        return own[np.argsort(self.begun[own], kind="stable")]


class Scheduler:
    """What the schedulers share: the task, its ways, and the expected state of things.

    Args:
        env: A workshop environment, or a batch of which one world is driven.
    """

    def __init__(self, env: Any) -> None:
        owner = owner_of(env, "task")
        self.task: WorkshopTask = owner.task
        self.separation = float(owner.options.separation)
        self.finished = False

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode."""

    def snapshot(self, now: Situation, problem: PlanProblem, motion: WorkspaceMotion) -> Snapshot:
        """What has been done so far and what is expected of what is under way, in the terms of schedules."""
        arrays = self.task.arrays
        begun = np.where(now.status == OPEN, np.inf, now.begun)
        ended = np.where(now.status == DONE, now.ended, np.inf)
        free, place = np.full(2, now.time), np.full(2, -1, np.int64)
        stays = np.full((2, arrays.stops.shape[1], 3), -1.0)
        if now.phase[HUMAN] == AWAY:
            free[HUMAN] += ABSENCE
        waiting = [a for a in (HUMAN, ROBOT) if now.doing[a] >= 0]
        for agent in sorted(waiting, key=lambda a: arrays.before[now.doing[1 - a], now.doing[a]] * 1):
            self._expect(now, problem, motion, agent, (free, place, ended, stays))
        first = np.zeros((2, len(self.task.locations)))
        if motion.time.any():
            first = np.stack([self.ways_from(agent, now.places[agent]) for agent in (HUMAN, ROBOT)])
        return Snapshot(free, place, first, begun, ended, stays)

    def _expect(
        self, now: Situation, problem: PlanProblem, motion: WorkspaceMotion, agent: int,
        out: tuple[Floats, Ints, Floats, Floats],
    ) -> None:  # fmt: skip
        """When an agent will be free, and where."""
        free, place, ended, stays = out
        action, arrays = int(now.doing[agent]), self.task.arrays
        usual = np.nan_to_num(problem.usual[agent, action], nan=float(np.nanmin(problem.usual[:, action])))
        time, spaced = now.time, motion.time.any()
        for k in range(int(now.stop[agent]), int(arrays.stop_count[action])):
            there, work = int(arrays.stops[action, k]), usual * arrays.share[action, k]
            if k > now.stop[agent]:
                time += motion.time[agent, int(arrays.stops[action, k - 1]), there, -1]
            elif now.phase[agent] == WALKING and spaced:
                time += self.ways_from(agent, now.places[agent])[there]
            elif now.phase[agent] == WORKING:
                work = max(work - float(now.since[agent]), LEFT)
            if k == arrays.stop_count[action] - 1 and now.phase[agent] != WORKING:
                before = np.flatnonzero(arrays.before[:, action])
                time = max([time, *(e for e in ended[before].tolist() if np.isfinite(e))])
            stays[agent, k] = there, time, time + work
            time += work
            place[agent] = there
        free[agent] = ended[action] = time

    def ways_from(self, agent: int, place: Floats) -> Floats:
        """(L,) time of the ways from a place to every location, alone on the floor [s]."""
        field, grid = self.task.arrays.field[:, agent], self.task.grid
        return np.array([way_length(grid, f, place[0], place[1]) for f in field]) / self.task.speeds[agent]

    def left_of(self, now: Situation, action: int) -> tuple[float, float]:
        """Least and greatest time that is left of an action under way, by its bounds [s]; negative if it is overdue."""
        arrays, agent = self.task.arrays, int(now.agent[action])
        who = agent if arrays.capable[agent, action] else 1 - agent
        low, high = float(arrays.lower[who, action]), float(arrays.upper[who, action])
        share = float(arrays.share[action, now.stop[agent] :].sum())
        spent = float(now.since[agent]) if now.phase[agent] == WORKING else 0.0
        ways = sum(
            self.task.walks[agent, arrays.stops[action, k - 1], arrays.stops[action, k]]
            for k in range(int(now.stop[agent]) + 1, int(arrays.stop_count[action]))
        )
        if now.phase[agent] == WALKING:
            ways += self.ways_from(agent, now.places[agent])[arrays.stops[action, now.stop[agent]]]
        return low * share - spent + ways, high * share - spent + 1.1 * ways


def under_way(now: Situation) -> Ints:
    """Numbers of the actions under way."""
    return np.flatnonzero(now.status == RUNNING)
