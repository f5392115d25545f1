"""Simple temporal networks with uncertainty (Vidal and Fargier 1999): some durations are nature's, not ours."""

import math
from collections.abc import Iterable

import numpy as np

from lidarena.base.errors import TemporalError
from lidarena.temporal.back_propagation import NormalForm
from lidarena.temporal.edges import ContingentLink, shown, ticks
from lidarena.temporal.stn import STN, EdgeArrays


class STNU(STN):
    """A simple temporal network some of whose durations are only observed: the contingent links.

    As an `STN` (consistency, distances, minimal network) it takes them for requirements, as if we could choose.

    Args:
        points: The names of the points.
        name: What the network is called in files and pictures.

    Raises:
        TemporalError: A name that is empty, no text, or there twice.
    """

    kind = "STNU"

    def __init__(self, points: Iterable[str] = (), *, name: str = "") -> None:
        self._links: dict[str, ContingentLink] = {}
        super().__init__(points, name=name)

    @property
    def contingent_links(self) -> tuple[ContingentLink, ...]:
        """The contingent links, in the order in which they were added."""
        return tuple(self._links.values())

    @property
    def contingent_points(self) -> tuple[str, ...]:
        """The points whose times nature decides."""
        return tuple(self._links)

    def __repr__(self) -> str:
        return f"{super().__repr__()[:-1]}, {len(self._links)} contingent links>"

    def add_contingent_link(self, activation: str, contingent: str, lower: float, upper: float) -> None:
        """Let ``contingent`` follow ``activation`` after a duration in [lower, upper] that nature decides.

        A lower bound below 0, as fitted distributions have it, can be checked; it cannot be executed.

        Raises:
            TemporalError: An unknown point, bounds that are NaN, infinite or crossed, a point that ends another
                contingent link already, or links that activate each other in a circle, so that none ever begins.
        """
        tail, head = self._number(activation), self._number(contingent)
        what = f"of the contingent link from {activation!r} to {contingent!r}"
        self._check_bounds(what, lower, upper)
        if not -math.inf < lower <= upper < math.inf:
            raise TemporalError(f"the bounds {what} must be finite, got [{shown(lower)}, {shown(upper)}]")
        if tail == head:
            raise TemporalError(f"a contingent link is between two points, got {activation!r} twice")
        if contingent in self._links:
            earlier = self._links[contingent].activation
            raise TemporalError(f"{contingent!r} ends a contingent link from {earlier!r} already; it can end one only")
        circle = [contingent, activation]
        while circle[-1] in self._links and circle[-1] != contingent:
            circle.append(self._links[circle[-1]].activation)
        if circle[-1] == contingent:
            raise TemporalError(f"the contingent links activate each other in a circle: {' → '.join(circle[::-1])}")
        self._links[contingent] = ContingentLink(activation, float(lower), float(upper), contingent)
        self._arrays = None

    def edge_arrays(self) -> EdgeArrays:
        """The edges as arrays, kept until the network changes; the contingent links as requirements."""
        if self._arrays is None:
            own, links = super().edge_arrays(), self._links.values()
            start = np.array([self._numbers[link.activation] for link in links], np.int64)
            end = np.array([self._numbers[link.contingent] for link in links], np.int64)
            low = np.array([ticks(link.lower) for link in links], np.int64)
            high = np.array([ticks(link.upper) for link in links], np.int64)
            self._arrays = EdgeArrays(
                np.concatenate([own.tail, start, end]),
                np.concatenate([own.head, end, start]),
                np.concatenate([own.weight, high, -low]),
            )
        return self._arrays

    def normal_form(self) -> NormalForm:
        """The network as Morris (2014) propagates through it."""
        tail, head, weight = self.edge_arrays()
        count, links = len(self), len(self._links)
        own = tail.size - 2 * links
        start, end = tail[own : own + links], head[own : own + links]
        high, low = weight[own : own + links], -weight[own + links :]
        loose = high > low  # a duration that is fixed is a requirement; its own point A' is tied to A all the same
        primed = np.arange(count, count + links)
        fixed = ~loose
        return NormalForm(
            np.concatenate([tail[:own], start, primed, start[fixed], end[fixed]]),
            np.concatenate([head[:own], primed, start, end[fixed], start[fixed]]),
            np.concatenate([weight[:own], low, -low, low[fixed], -low[fixed]]),
            end,
            high - low,
            count,
        )
