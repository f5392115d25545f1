"""Large-neighbourhood repair: replan a few robots of a finished plan, keep what is no worse, until time is up.

After Li et al. 2021 ("Anytime multi-agent path finding via large neighborhood search"): a neighbourhood is a robot that
is late and the robots in its way, or robots chosen at random; equally good plans are accepted, so that the search
wanders along plateaus. One prioritized pass leaves 2 to 8% of the cost, most of which this finds.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.team.budget import Budget
from lidarena.planning.team.conflicts import find_blocking_agents
from lidarena.planning.team.traffic import Traffic

_SMALLEST, _LARGEST, _LARGEST_IN_CROWDS = 2, 6, 8
_DELAYED, _LONGEST_DELAY = 0.1, 8  # share of neighbourhoods whose first robot lets others pass before it leaves
_AT_RANDOM, _AT_RANDOM_IN_CROWDS, _CROWD = 0.25, 0.05, 32
"""Shares of neighbourhoods that are not built around a late robot, in small teams and in those of more robots than
``_CROWD``, where robots chosen at random have hardly ever to do with each other."""


class Repair:
    """Neighbourhoods of a team's plan.

    Args:
        traffic: The team, every robot placed; changed in place.
        rng: Chooses them.
    """

    def __init__(self, traffic: Traffic, rng: np.random.Generator) -> None:
        self._traffic, self._rng = traffic, rng

    def run(self, budget: Budget, patience: int) -> int:
        """Improve the plan until the budget is spent, nothing can be gained, or nothing was for a while.

        Args:
            budget: Time and iterations left.
            patience: Iterations in a row without a gain after which the plan counts as settled.

        Returns:
            Number of neighbourhoods that were tried.
        """
        traffic, least = self._traffic, int(self._traffic.alone.sum())
        idle = tried = 0
        while traffic.cost() > least and idle < patience and budget.take():
            group = self._neighbourhood()
            if self._rng.random() < _DELAYED:
                traffic.delays[group[0]] = self._rng.integers(1, _LONGEST_DELAY + 1)
            gain = traffic.replan(group)
            traffic.delays[group[0]] = 0
            idle = 0 if gain > 0 else idle + 1
            tried += 1
        return tried

    def _neighbourhood(self) -> NDArray[np.int64]:
        rng, team = self._rng, len(self._traffic)
        largest = _LARGEST if team <= _CROWD else _LARGEST_IN_CROWDS
        size = min(int(rng.integers(_SMALLEST, largest + 1)), team)
        first = self._late_robot()
        if rng.random() < (_AT_RANDOM if team <= _CROWD else _AT_RANDOM_IN_CROWDS):
            others = rng.permutation(team)
        else:
            near = self._blocking_agents(first)
            others = rng.permutation(np.flatnonzero(near))
            if len(others) + 1 < size:
                others = np.concatenate([others, rng.permutation(np.flatnonzero(~near))])
        others = others[others != first][: size - 1]
        group = np.concatenate([[first], others]).astype(np.int64)
        return rng.permutation(group) if rng.random() < 0.7 else group

    def _late_robot(self) -> int:
        """A robot that is late; in a crowd, where not all of them can be tried, the more often the later it is."""
        delays = self._traffic.lengths - self._traffic.alone
        late = np.flatnonzero(delays > 0)
        if len(self._traffic) <= _CROWD:
            return int(late[self._rng.integers(len(late))])
        shares = np.cumsum(delays[late])
        return int(late[np.searchsorted(shares, self._rng.random() * shares[-1], side="right")])

    def _blocking_agents(self, robot: int) -> NDArray[np.bool_]:
        traffic = self._traffic
        blocking = np.zeros(len(traffic), np.bool_)
        find_blocking_agents(
            np.int64(robot),
            self._rng.integers(traffic.lengths[robot] + 1) if self._rng.random() < 0.5 else np.int64(0),
            traffic.graph.cells,
            traffic.graph.neighbours,
            traffic.ahead[robot],
            traffic.paths,
            traffic.lengths,
            traffic.graph.apart,
            self._rng.integers(8, size=16),
            blocking,
            np.empty(traffic.alone[robot] + traffic.capacity + 2, np.int32),
        )
        return blocking
