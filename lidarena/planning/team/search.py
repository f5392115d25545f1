"""Prioritized planning that searches for its order, and then repairs the plan.

A robot that finds no way moves to the front and the team is planned again (failure-driven promotion; two or three
rounds nearly always suffice); if that comes back to an order that was tried, the next one is random. What was found is
improved by large-neighbourhood repair.

Some problems no order of priority solves: two robots that meet half-way between them and the only place to dodge. So
the robots of a random order, some of them, first wait at their starts.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.team.arrangements import Verdict, decide, is_small
from lidarena.planning.team.budget import Budget
from lidarena.planning.team.lacam import Lacam, steps_of, why_not
from lidarena.planning.team.prioritized import longest_first
from lidarena.planning.team.repair import Repair
from lidarena.planning.team.team_plan import TeamPlan, failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic

PATIENCE = 300
"""Neighbourhoods without a gain after which a plan counts as settled; large teams have more of them."""
_PATIENCE_A_ROBOT = 4
_SHARE_OF_ORDERS, _MOST_ORDERS = 0.25, 64  # of the time, before LaCAM looks for a plan
_SHARE_WITH_A_PLAN = 0.3  # of the time left, for LaCAM to find a better one than is known
_SHARE_OF_CONFIGURATIONS, _MOST_SLICES = 0.7, 100  # of the time left, to improve on LaCAM's plan
_PART = 16  # robots that are planned between two looks at the clock
_DELAYED = 0.5  # share of the robots of a random order that wait at their starts


def _plan_in_parts(traffic: Traffic, order: NDArray[np.int64], budget: Budget) -> int:
    """Plan robots in an order, with a look at the clock now and then; return how many were placed."""
    placed = 0
    while placed < len(order):
        part = order[placed : placed + _PART]
        done = traffic.plan(part)
        placed += done
        if done < len(part) or budget.spent():
            break
    return placed


def find_order(
    traffic: Traffic, budget: Budget, rng: np.random.Generator, whole: Budget | None = None
) -> tuple[NDArray[np.int64], int, int]:
    """Plan a team with failure-driven promotion.

    Args:
        traffic: The team, no robot placed; afterwards everyone, or as many as the last order let through.
        budget: Time and orders left; the first order is always tried.
        rng: For the orders after one that comes back.
        whole: Time after which even the first order is given up; None = that of ``budget``.

    Returns:
        The last order; how many of its robots were placed; how many orders were tried.
    """
    order, tried = longest_first(traffic), 0
    seen = set()
    while True:
        tried += 1
        placed = _plan_in_parts(traffic, order, whole or budget)
        traffic.delays[:] = 0
        if placed == len(order) or len(order) == 1 or not budget.take():
            return order, placed, tried
        seen.add(order.tobytes())
        traffic.remove(order[:placed])
        failed = order[placed]
        order = np.concatenate([[failed], order[order != failed]])
        if order.tobytes() in seen:
            order = rng.permutation(order)
            late = rng.random(len(order)) < _DELAYED
            traffic.delays[:] = np.where(late, rng.integers(1, traffic.alone.max() + 2, len(order)), 0)


def plan_search(traffic: Traffic, budget: Budget, rng: np.random.Generator) -> TeamPlan:
    """Promotion, then repair, within a budget."""
    order, placed, tried = find_order(traffic, budget.part(_SHARE_OF_ORDERS, _MOST_ORDERS), rng, budget)
    by = f"order {tried}"
    search: Lacam | None = None
    if placed < len(order):
        traffic.remove(order[:placed])
        search, by, why = _find_any(traffic, budget, rng)
        if by == "":
            message = (
                f"{why} Before, robot {order[placed]} found no way past the robots before it"
                f" in the last of {tried} orders of priority (failure-driven promotion, then random orders and delays)."
            )
            return failed_plan(traffic, message, order)
        by = f"{by} after {tried} orders of priority"
        order = np.empty(0, np.int64)
    first = traffic.cost()
    neighbourhoods = _improve(traffic, search, budget, rng)
    message = (
        f"Solved by {by} at cost {first}; {neighbourhoods} neighbourhoods were replanned,"
        f" which saved {first - traffic.cost()} steps."
    )
    return solved_plan(traffic, message, order=order)


def _find_any(traffic: Traffic, budget: Budget, rng: np.random.Generator) -> tuple[Lacam | None, str, str]:
    """Adopt any plan, where no order of priority gives one.

    Returns:
        LaCAM's search if the plan is its own; what found the plan, "" for nothing; why there is none.
    """
    verdict = decide(traffic.graph, traffic.ends) if is_small(traffic.graph, len(traffic)) else Verdict(None, False)
    if verdict.impossible:
        return None, "", "There is no plan: no steps over the sets of places that the team can take lead to its goals."
    search, whole = Lacam(traffic, int(rng.integers(2**31))), budget.again()
    known = verdict.paths is not None
    status = search.run(whole.part(_SHARE_WITH_A_PLAN, _MOST_SLICES) if known else whole, first=True)
    if search.found:
        traffic.adopt(*search.paths())
        return search, "LaCAM", ""
    if verdict.paths is None:
        return None, "", why_not(status, search.steps)
    traffic.adopt(verdict.paths, steps_of(verdict.paths))
    return None, "a search over the sets of places that can be taken", ""


def _improve(traffic: Traffic, search: Lacam | None, budget: Budget, rng: np.random.Generator) -> int:
    """Repair a plan; one of LaCAM's, once that settles, in turns with its search. Return the neighbourhoods tried."""
    patience, everyone = PATIENCE + _PATIENCE_A_ROBOT * len(traffic), np.arange(len(traffic))
    neighbourhoods = Repair(traffic, rng).run(budget, patience)
    if search is None or traffic.cost() <= traffic.alone.sum():
        return neighbourhoods
    search.run(budget.part(_SHARE_OF_CONFIGURATIONS, _MOST_SLICES), first=False)
    paths, lengths = search.paths()
    if lengths.sum() < traffic.cost():
        traffic.remove(everyone)
        traffic.adopt(paths, lengths)
        neighbourhoods += Repair(traffic, rng).run(budget, patience)
    return neighbourhoods
