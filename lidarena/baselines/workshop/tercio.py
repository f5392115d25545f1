"""Tercio (Gombolay et al. 2013): a mixed-integer program allocates, a sequencer orders; ways take no time in it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, LinearConstraint, milp

from lidarena.baselines.registry import register
from lidarena.baselines.workshop.robot_interface import Scheduler, Situation
from lidarena.envs.workshop.compiler.compiled import plan_problem
from lidarena.envs.workshop.compiler.motion import acquire_motion
from lidarena.envs.workshop.kernels import OPEN
from lidarena.envs.workshop.task import HUMAN, ROBOT

Floats = NDArray[np.float64]


@register("tercio", family="workshop")
class AllocatedSequence(Scheduler):
    """Allocates what is left such that the busier of the two is done soonest, at every decision anew.

    Of the robot's share the action with the longest chain behind it comes next whose location is not too near to where
    the human works. Ways take no time in its plans.
    """

    def __init__(self, env: Any) -> None:
        """Make it for a workshop environment."""
        super().__init__(env)
        self._near = acquire_motion(self.task, self.separation).near
        self._problem = plan_problem(self.task, acquire_motion(self.task, self.separation, space=False))

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the number of the robot's next action, or of waiting."""
        now = Situation.read(info)
        may = now.may
        if not len(may):
            return now.wait
        own = may[self.allocate(now)[may] == ROBOT]
        clear = np.array([not self._too_near(now, action) for action in own.tolist()], np.bool_)
        if clear.any():
            own = own[clear]
        elif now.human_acts:
            return now.wait
        elif not len(own):
            own = may
        return int(own[self._problem.tail[own].argmax()])

    def allocate(self, now: Situation) -> NDArray[np.int64]:
        """Who is to do each action (n,): minimize z with z ≥ load of each agent, by a mixed-integer program."""
        opens = np.flatnonzero(now.status == OPEN)
        usual = self._problem.usual
        loads = np.array([self._load(now, agent) for agent in (HUMAN, ROBOT)])
        owner = now.agent.copy()
        count = len(opens)
        low, high = np.zeros(count + 1), np.ones(count + 1)  # x = 1: the robot does it; z last
        high[count] = np.inf
        low[:count] = ~self._problem.capable[HUMAN, opens]
        high[:count] = self._problem.capable[ROBOT, opens]
        human, robot = np.nan_to_num(usual[HUMAN, opens]), np.nan_to_num(usual[ROBOT, opens])
        rows = np.stack([np.append(human, 1.0), np.append(-robot, 1.0)])
        least = np.array([loads[HUMAN] + human.sum(), loads[ROBOT]])
        cost = np.append(1e-6 * np.arange(count), 1.0)
        found = milp(
            cost, constraints=LinearConstraint(rows, least, np.inf), bounds=Bounds(low, high),
            integrality=np.append(np.ones(count), 0),
        )  # fmt: skip
        assert found.x is not None  # somebody can do each action
        owner[opens] = np.where(found.x[:count] > 0.5, ROBOT, HUMAN)
        return owner

    def _load(self, now: Situation, agent: int) -> float:
        """Time for which an agent is still at what it does, by usual durations [s]."""
        action = int(now.doing[agent])
        if action < 0:
            return 0.0
        usual = float(np.nanmin(self._problem.usual[:, action]))
        return max(usual - (now.time - float(now.begun[action])), 0.0)

    def _too_near(self, now: Situation, action: int) -> bool:
        """Whether an action is at a location that the human is, or will be, too near to in what it does now."""
        doing, arrays = int(now.doing[HUMAN]), self.task.arrays
        if doing < 0:
            return False
        theirs = arrays.stops[doing][arrays.stops[doing] >= 0]
        mine = arrays.stops[action][arrays.stops[action] >= 0]
        return bool(self._near[np.ix_(theirs, mine)].any())
