"""The dispatcher of Strassmair and Taylor: drop the plans that contradict what was seen, update, rank, act."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.keyword_checks import check_switch
from lidarena.baselines.registry import register
from lidarena.baselines.workshop.robot_interface import Scheduler, Situation, under_way
from lidarena.envs.workshop.compiler.compiled import CompiledTask, compile_task
from lidarena.envs.workshop.compiler.networks import CONTROLLABLE, INCONSISTENT, categorize, plan_network
from lidarena.envs.workshop.compiler.schedule import Snapshot, predict, predict_all, search_plans
from lidarena.envs.workshop.task import HUMAN, ROBOT

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHECKED = 12
"""Of the plans that agree with what was seen, the networks of so many are checked, those of least makespan first."""
_NODES = 20_000
"""Beginnings of plans that a search looks at in one decision."""
_HARDLY = 1e-6
"""A deadline is missed from so long after it on [s]: the checks' own tolerance."""


class PlanDispatcher(Scheduler):
    """Chooses among plans by their temporal networks.

    Args:
        env: A workshop environment.
        motion: Whether ways take time in the plans.

    Attributes:
        compiled: The plans.
        category: Of the plan that the last decision followed, see ``networks.CATEGORIES``.
        unmatched: Decisions of this episode at which no listed plan agreed with what was seen.
    """

    def __init__(self, env: Any, motion: bool) -> None:
        super().__init__(env)
        check_switch("motion", motion)
        self.compiled: CompiledTask = compile_task(self.task, self.separation, motion)
        self._problem, self._motion = self.compiled.problem, self.compiled.motion
        self.category, self.unmatched = CONTROLLABLE, 0

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode."""
        self.category, self.unmatched = CONTROLLABLE, 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the number of the robot's next action, or of waiting."""
        now = Situation.read(info)
        if not len(now.may):
            return now.wait
        snapshot = self.snapshot(now, self._problem, self._motion)
        plans = self.candidates(now, snapshot)
        return self.choose(now, snapshot, plans)

    def choose(self, now: Situation, snapshot: Snapshot, plans: Ints) -> int:
        """The robot's next action, or to wait.

        Args:
            now: What is seen.
            snapshot: The same for the compiler.
            plans: What is left of those that agree with it (K, 2, n), the quickest first.
        """
        raise NotImplementedError

    def candidates(self, now: Situation, snapshot: Snapshot) -> Ints:
        """What is left of the plans that agree with what was seen (K, 2, n), the quickest first.

        Timing drops none. Where the list is not complete, or no plan in it agrees, the beginning that was seen is gone
        on from by search.
        """
        plans = self._agreeing(now) if self.compiled.complete else None
        if plans is not None and not len(plans):
            self.unmatched += 1
        if plans is None or not len(plans):
            return search_plans(self._problem, snapshot, CHECKED, _NODES)[1]
        return plans[np.argsort(predict_all(self._problem, snapshot, plans), kind="stable")]

    def _agreeing(self, now: Situation) -> Ints:
        """The listed plans that agree in allocation and order, without what has been begun."""
        plans = self.compiled.plans
        orders = [now.order_of(agent) for agent in (HUMAN, ROBOT)]
        agree = np.ones(len(plans), np.bool_)
        for agent, order in enumerate(orders):
            agree &= (plans[:, agent, : len(order)] == order).all(axis=1)
        left = np.full((int(agree.sum()), 2, plans.shape[2]), -1, np.int64)
        for agent, order in enumerate(orders):
            left[:, agent, : plans.shape[2] - len(order)] = plans[agree, agent, len(order) :]
        return left

    def rank(self, now: Situation, snapshot: Snapshot, plans: Ints) -> list[tuple[int, int]]:
        """Category and number of the plans that come into question, the best first: until one is controllable."""
        found = []
        for category, number in self.categories(now, snapshot, plans):
            found.append((category, number))
            if category == CONTROLLABLE:
                break
        return sorted(found)

    def categories(self, now: Situation, snapshot: Snapshot, plans: Ints) -> Iterator[tuple[int, int]]:
        """Category and number of the plans that come into question, one after the other."""
        running = {action: self.left_of(now, action) for action in under_way(now).tolist()}
        is_late = now.time > self.task.deadline + _HARDLY  # then no network is consistent
        for number, plan in enumerate(plans[:CHECKED]):
            if is_late:
                yield INCONSISTENT, number
                continue
            schedule = predict(self._problem, snapshot, plan)
            network = plan_network(self.task, plan, schedule, snapshot, now.time, running)
            yield categorize(network), number

    def next_of(self, now: Situation, plan: Ints) -> int:
        """The robot's next action by a plan; to wait if it has none that may begin."""
        action = int(plan[ROBOT, 0])
        return action if action >= 0 and now.mask[action] else now.wait


@register("stnu", family="workshop")
class TemporalDispatcher(PlanDispatcher):
    """Ranks dynamically controllable plans above consistent ones above inconsistent ones, then by makespan.

    At every decision: (1) plans whose allocation or order contradict what was seen are dropped, (2) the others are
    updated by the observed times, (3) ranked, (4) the best one's next action of the robot is begun. None is dropped for
    being late, so there always is a plan. While the human is not at an action the robot does not wait for it.
    """

    def __init__(self, env: Any, *, motion: bool = True) -> None:
        """Make it for a workshop environment.

        Args:
            env: The environment.
            motion: Whether ways take time in the plans; False takes no notice of space.
        """
        super().__init__(env, motion)

    def choose(self, now: Situation, snapshot: Snapshot, plans: Ints) -> int:
        """Follow the best plan; where none is left take the action of the longest chain."""
        if not len(plans):
            return int(now.may[self.task.arrays.tail[now.may].argmax()])
        if not now.human_acts:
            going = np.array([self.next_of(now, plan) != now.wait for plan in plans])
            plans = plans[going] if going.any() else plans
        ranked = self.rank(now, snapshot, plans)
        self.category, best = ranked[0]
        choice = self.next_of(now, plans[best])
        if choice == now.wait and not now.human_acts:
            return int(now.may[self.task.arrays.tail[now.may].argmax()])
        return choice
