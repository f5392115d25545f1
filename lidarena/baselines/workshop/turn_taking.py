"""Turn-taking: the robot does one action whenever the human has done one."""

from typing import Any

import numpy as np

from lidarena.baselines.registry import register
from lidarena.baselines.workshop.robot_interface import Scheduler, Situation
from lidarena.envs.workshop.kernels import DONE
from lidarena.envs.workshop.task import HUMAN, ROBOT

PATIENCE = 10.0
"""A human who has done nothing for so long has passed [s]."""


@register("turn_taking", family="workshop")
class TurnTaking(Scheduler):
    """Takes a turn when the human has ended an action, or is not at one; else it stands by.

    The stop-and-go collaboration in which the robot acts at the human's command: one action a turn, the one with the
    longest chain behind it.
    """

    def __init__(self, env: Any) -> None:
        """Make it for a workshop environment."""
        super().__init__(env)
        self._seen = 0

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode."""
        self._seen = 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the number of the robot's next action, or of waiting."""
        now = Situation.read(info)
        ended = int(((now.status == DONE) & (now.agent == HUMAN)).sum())
        passed = not now.human_acts and float(now.since[HUMAN]) >= PATIENCE
        stuck = now.human_acts and not self._helps(now)
        if not len(now.may) or not (ended > self._seen or passed or stuck):
            return now.wait
        self._seen = ended
        tail = self.task.arrays.tail[now.may]
        return int(now.may[np.argmax(tail)])

    def _helps(self, now: Situation) -> bool:
        """Whether the human can end what it does without the robot beginning anything."""
        before = np.flatnonzero(self.task.arrays.before[:, now.doing[HUMAN]])
        open_ = now.status[before] == 0
        return not bool((open_ & self.task.arrays.capable[ROBOT, before]).any())
