"""What temporal networks are made of: edges, contingent links, and the cycles that make a network impossible."""

import math
from typing import NamedTuple

TICK = 1e-6
"""Times are compared as whole multiples of this, so that sums are exact; of seconds, a microsecond."""
LONGEST = 1e9
"""The largest bound: sums over thousands of such still fit into 64 bits of ticks."""


def ticks(time: float) -> int:
    """The whole number of ticks nearest to a time."""
    return round(time / TICK)


def shown(time: float) -> str:
    """A time as short as it can be written without loss: ``5`` rather than ``5.0``."""
    return f"{time:.0f}" if math.isfinite(time) and time == int(time) else f"{time:.12g}"


class ContingentLink(NamedTuple):
    """``contingent`` follows ``activation`` after a duration that nature draws from [lower, upper]."""

    activation: str
    lower: float
    upper: float
    contingent: str


class TemporalEdge(NamedTuple):
    """``head − tail ≤ weight``, or the lower-case or upper-case edge of a contingent link."""

    tail: str
    head: str
    weight: float
    kind: str = "requirement"
    """``requirement``, ``lower``, ``upper``, or ``derived``"""

    def __str__(self) -> str:
        if self.kind == "lower":
            return f"{self.head} may come only {shown(self.weight)} after {self.tail}"
        if self.kind == "upper":
            return f"{self.tail} may come as late as {shown(-self.weight)} after {self.head}"
        if self.weight < 0:
            return f"{self.tail} at least {shown(-self.weight)} after {self.head}"
        return f"{self.head} at most {shown(self.weight)} after {self.tail}"


class NegativeCycle(NamedTuple):
    """Constraints that contradict each other: walked round, they ask for a point before itself."""

    edges: tuple[TemporalEdge, ...]

    @property
    def length(self) -> float:
        """The sum of the weights, below zero: by how much the constraints miss each other."""
        return sum(ticks(edge.weight) for edge in self.edges) * TICK

    @property
    def points(self) -> tuple[str, ...]:
        """The points, in the order in which the cycle visits them."""
        return tuple(edge.tail for edge in self.edges)

    def __str__(self) -> str:
        path = " → ".join([*self.points, self.edges[0].tail])
        return f"{path} ({'; '.join(map(str, self.edges))}: {shown(-self.length)} too much)"
