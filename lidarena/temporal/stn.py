"""Simple temporal networks (Dechter, Meiri and Pearl 1991): points in time and bounds on their differences."""

import math
from collections.abc import Iterable
from difflib import get_close_matches
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import TemporalError, suggest
from lidarena.temporal.back_propagation import FAR
from lidarena.temporal.edges import LONGEST, TICK, NegativeCycle, TemporalEdge, shown
from lidarena.temporal.shortest_paths import all_distances, find_negative_cycle

Ints = NDArray[np.int64]


class EdgeArrays(NamedTuple):
    """The edges as arrays: edge ``e`` says that ``head − tail ≤ weight``."""

    tail: Ints
    """(m,)"""
    head: Ints
    """(m,)"""
    weight: Ints
    """(m,) [ticks]"""


class STN:
    """A simple temporal network: points, and bounds on how long one comes after another.

    Of several bounds on the same two points the tightest holds.

    Args:
        points: The names of the points.
        name: What the network is called in files and pictures.

    Raises:
        TemporalError: A name that is empty, no text, or there twice.
    """

    kind = "STN"

    def __init__(self, points: Iterable[str] = (), *, name: str = "") -> None:
        self.name = name
        self._numbers: dict[str, int] = {}
        self._edges: dict[tuple[int, int], float] = {}
        self._arrays: EdgeArrays | None = None
        for point in points:
            self.add_point(point)

    @property
    def points(self) -> tuple[str, ...]:
        """The names of the points, in the order in which they were added."""
        return tuple(self._numbers)

    @property
    def edges(self) -> tuple[TemporalEdge, ...]:
        """The edges of the requirements: ``head − tail ≤ weight``."""
        names = self.points
        return tuple(TemporalEdge(names[tail], names[head], weight) for (tail, head), weight in self._edges.items())

    def __contains__(self, point: str) -> bool:
        return point in self._numbers

    def __len__(self) -> int:
        return len(self._numbers)

    def __repr__(self) -> str:
        title = f" {self.name!r}" if self.name else ""
        return f"<{self.kind}{title}: {len(self)} points, {len(self._edges)} edges>"

    def add_point(self, point: str) -> None:
        """Add a point in time.

        Raises:
            TemporalError: A name that is empty, no text, or there already.
        """
        if not isinstance(point, str) or not point.strip():
            raise TemporalError(f"a point's name must be a text that is not empty, got {point!r}")
        if point in self._numbers:
            raise TemporalError(f"the point {point!r} is there already; every point needs a name of its own")
        self._numbers[point] = len(self._numbers)
        self._arrays = None

    def add_requirement(self, start: str, end: str, lower: float | None = None, upper: float | None = None) -> None:
        """Ask that ``lower ≤ end − start ≤ upper``; without a number there is no bound on that side.

        A point that must come before or after itself is a negative cycle of one edge, which the checks then name.

        Raises:
            TemporalError: An unknown point, a bound that is NaN or huge, or a lower bound above the upper one.
        """
        tail, head = self._number(start), self._number(end)
        low, high = -math.inf if lower is None else lower, math.inf if upper is None else upper
        self._check_bounds(f"from {start!r} to {end!r}", low, high)
        if tail == head and low <= 0 <= high:
            return
        if math.isfinite(high):
            self._tighten(tail, head, high)
        if math.isfinite(low):
            self._tighten(head, tail, -low)

    def bounds(self, start: str, end: str) -> tuple[float, float]:
        """The bounds on ``end − start`` that were asked for; infinite where there is none."""
        tail, head = self._number(start), self._number(end)
        return -self._edges.get((head, tail), math.inf), self._edges.get((tail, head), math.inf)

    def negative_cycle(self) -> NegativeCycle | None:
        """Requirements that contradict each other; None where all can be met together."""
        arrays = self.edge_arrays()
        names = self.points
        found = find_negative_cycle(*arrays, len(self))
        edges = [
            TemporalEdge(names[arrays.tail[one]], names[arrays.head[one]], float(arrays.weight[one] * TICK))
            for one in found
        ]
        return NegativeCycle(tuple(edges)) if edges else None

    def is_consistent(self) -> bool:
        """Whether there are times for all points that meet every requirement."""
        return self.negative_cycle() is None

    def distances(self) -> NDArray[np.float64]:
        """The distance graph's shortest paths (n, n): ``[i, j]`` is the tightest bound on point j − point i.

        Raises:
            TemporalError: The network is inconsistent; the message names the negative cycle.
        """
        cycle = self.negative_cycle()
        if cycle is not None:
            raise TemporalError(f"the network has no solution: {cycle}")
        distance = all_distances(*self.edge_arrays(), len(self))
        result: NDArray[np.float64] = np.where(distance >= FAR, np.inf, distance * TICK)
        return result

    def minimal_network(self) -> "STN":
        """The same solutions with every bound as tight as it can be (Dechter, Meiri and Pearl 1991).

        Raises:
            TemporalError: The network is inconsistent; the message names the negative cycle.
        """
        distance = self.distances()
        minimal = STN(self.points, name=self.name)
        for tail, head in zip(*np.nonzero(np.isfinite(distance)), strict=True):
            if tail != head:
                minimal._tighten(int(tail), int(head), float(distance[tail, head]))
        return minimal

    def earliest_times(self) -> dict[str, float]:
        """The earliest solution that starts at 0: no point before 0, and every point as early as it can be.

        Raises:
            TemporalError: The network is inconsistent; the message names the negative cycle.
        """
        distance = self.distances()
        earliest = np.maximum(0.0, -distance.min(axis=1)) if len(self) else np.empty(0)
        return dict(zip(self.points, earliest.tolist(), strict=True))

    def edge_arrays(self) -> EdgeArrays:
        """The edges as arrays, kept until the network changes."""
        if self._arrays is None:
            ends = np.array(list(self._edges), np.int64).reshape(-1, 2)
            weights = np.array(list(self._edges.values()), np.float64)
            self._arrays = EdgeArrays(
                np.ascontiguousarray(ends[:, 0]), np.ascontiguousarray(ends[:, 1]), _as_ticks(weights)
            )
        return self._arrays

    def _tighten(self, tail: int, head: int, weight: float) -> None:
        key = (tail, head)
        if weight < self._edges.get(key, math.inf):
            self._edges[key] = float(weight)
            self._arrays = None

    def _number(self, point: str) -> int:
        number = self._numbers.get(point)
        if number is None:
            raise unknown_point(point, self._numbers)
        return number

    @staticmethod
    def _check_bounds(what: str, lower: float, upper: float) -> None:
        for bound in (lower, upper):
            if isinstance(bound, bool) or not isinstance(bound, int | float | np.number) or math.isnan(bound):
                raise TemporalError(f"a bound {what} must be a number, got {bound!r}")
            if math.isfinite(bound) and abs(bound) > LONGEST:
                raise TemporalError(f"a bound {what} must be within ±{LONGEST:.0e}, got {bound!r}")
        if lower > upper or lower == math.inf or upper == -math.inf:
            raise TemporalError(f"the lower bound {what} must not be above the upper, got {_pair(lower, upper)}")


def unknown_point(point: object, points: Iterable[str]) -> TemporalError:
    """The refusal of a point that there is not: some of those that there are, and the nearest one."""
    names = list(points)
    near = get_close_matches(str(point), names, n=1)
    return TemporalError(f"unknown point {point!r}{suggest(str(point), {*near, *names[:20]})}")


def _pair(lower: float, upper: float) -> str:
    return f"[{shown(float(lower))}, {shown(float(upper))}]"


def _as_ticks(times: NDArray[np.float64]) -> Ints:
    return np.rint(times / TICK).astype(np.int64)
