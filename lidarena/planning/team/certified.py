"""The optimum of a team, certified where the budget allows: prioritized search from above, conflicts from below."""

import math

import numpy as np

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.cbs import ConflictBasedSearch
from lidarena.planning.team.joint import plan_joint
from lidarena.planning.team.repair import Repair
from lidarena.planning.team.search import find_order
from lidarena.planning.team.team_plan import TeamPlan, failed_plan, solved_plan
from lidarena.planning.team.traffic import Traffic

_SHARE_OF_SEARCH = 0.2
_SHARE_OF_PAIR = 0.3  # of the time, before two robots are planned jointly instead: dead ends are hard for conflicts
_PATIENCE = 200


def plan_certified(traffic: Traffic, seconds: float, iterations: int | None, rng: np.random.Generator) -> TeamPlan:
    """Conflict-based search under the cost of a plan of prioritized search.

    Args:
        traffic: The team, no robot placed.
        seconds: Time limit; a fifth of it goes to prioritized search if that needs it.
        iterations: Greatest number of neighbourhoods, and of nodes; None = any.
        rng: For prioritized search.
    """
    budget = Budget(seconds)
    order, placed, _ = find_order(traffic, Budget(seconds * _SHARE_OF_SEARCH, iterations), rng, budget)
    known: int | None = None
    if placed == len(order):
        Repair(traffic, rng).run(Budget(seconds * _SHARE_OF_SEARCH, iterations), _PATIENCE)
        known = traffic.cost()
    paths, lengths = traffic.paths.copy(), traffic.lengths.copy()
    everyone = np.arange(len(traffic))
    traffic.remove(everyone)
    share = _SHARE_OF_PAIR if len(traffic) == 2 else 1.0
    found = ConflictBasedSearch(traffic, known).run(Budget(budget.left() * share, iterations))
    if len(traffic) == 2 and not found.found and found.lower_bound != known:
        joint = plan_joint(traffic, budget.left())
        if joint.solved or known is None:
            return joint
    if not found.found:
        traffic.paths[:], traffic.lengths[:] = paths, lengths
    if known is None and not found.found:
        robot = int(order[placed])
        return failed_plan(
            traffic,
            f"Conflict-based search ended after {found.nodes} nodes without a plan, and robot {robot} found no way in"
            f" prioritized search.",
        )
    traffic.place(everyone)
    bound = min(found.lower_bound, traffic.cost())
    proved = "certified as optimal" if bound == traffic.cost() else f"not certified: the bound is {bound}"
    gap = "" if math.isclose(bound, traffic.cost()) else f", {traffic.cost() / bound - 1:.1%} below"
    source = "conflict-based" if found.found else "prioritized"
    return solved_plan(
        traffic, f"The plan of {source} search is {proved}{gap}, after {found.nodes} nodes.", lower_bound=bound
    )
