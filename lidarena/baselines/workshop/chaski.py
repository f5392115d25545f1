"""Chaski (Shah et al. 2011): acts by plans that are still feasible, and has none when the human has left them."""

from typing import Any

from lidarena.baselines.registry import register
from lidarena.baselines.workshop.robot_interface import Situation, under_way
from lidarena.baselines.workshop.stnu import Ints, PlanDispatcher
from lidarena.envs.workshop.compiler.networks import CONSISTENT
from lidarena.envs.workshop.compiler.schedule import Snapshot
from lidarena.envs.workshop.task import HUMAN


@register("chaski", family="workshop")
class FeasiblePlans(PlanDispatcher):
    """Takes human and robot for equal partners who both keep to feasible plans.

    Only plans stay whose network is consistent, with everybody free to choose durations within the bounds; the one of
    least makespan is followed. Where none is left, since the deadline cannot be met any more or an action under way is
    overdue, there is no plan: the robot waits for one to come back.

    Attributes:
        stranded: Decisions of this episode without a plan.
    """

    def __init__(self, env: Any, *, motion: bool = False) -> None:
        """Make it for a workshop environment.

        Args:
            env: The environment.
            motion: Whether ways take time in the plans; Chaski itself takes no notice of space.
        """
        super().__init__(env, motion)
        self.stranded = 0

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode."""
        super().reset(seed)
        self.stranded = 0

    def choose(self, now: Situation, snapshot: Snapshot, plans: Ints) -> int:
        """Follow the quickest plan that is feasible; where none is, wait."""
        ranked = iter(()) if self._overdue(now) else self.categories(now, snapshot, plans)
        feasible = next((one for one in ranked if one[0] <= CONSISTENT), None)
        if feasible is None:
            self.stranded += 1
            return now.wait
        self.category, best = feasible
        return self.next_of(now, plans[best])

    def _overdue(self, now: Situation) -> bool:
        """Whether the human has taken longer than the bounds of what it does allow."""
        mine = [action for action in under_way(now).tolist() if now.agent[action] == HUMAN]
        return any(self.left_of(now, action)[1] < 0.0 for action in mine)
