"""Real-time execution (Morris 2014; RTE* of Hunsberger and Posenato 2023): decide from what has happened so far."""

import math
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from lidarena.base.errors import TemporalError
from lidarena.temporal.dispatchable import DispatchableNetwork, Wait
from lidarena.temporal.edges import TICK, TemporalEdge, shown, ticks
from lidarena.temporal.stn import STN, unknown_point
from lidarena.temporal.stnu import STNU


class TimeWindow(NamedTuple):
    """When a point may be executed."""

    point: str
    earliest: float
    latest: float
    """Infinite where nothing bounds it"""


class RealTimeExecution:
    """Execute a dispatchable network: told what happened and when, it says what may be executed next and when.

    A point is enabled once all points that must come before it have come. As long as every point is executed within its
    window, no later than the first window closes, and nature keeps its bounds, no requirement is violated. What happens
    outside of them is not refused, for nature may do so: it is noted in `violations`, and the execution goes on.

    Args:
        network: The dispatchable form, see `make_dispatchable`.
        start: The time at which the execution begins; nothing is executed earlier.
    """

    def __init__(self, network: DispatchableNetwork, start: float = 0.0) -> None:
        self.network, self.now = network, float(start)
        self.times: dict[str, float] = {}
        """When each point happened that has happened so far"""
        self.violations: list[str] = []
        """What was violated so far, one sentence each"""
        self._nature = {link.contingent: link for link in network.contingent_links}
        self._lower = dict.fromkeys(network.points, ticks(start))
        self._upper: dict[str, float] = dict.fromkeys(network.points, math.inf)
        self._leaving: defaultdict[str, list[TemporalEdge]] = defaultdict(list)
        self._entering: defaultdict[str, list[TemporalEdge]] = defaultdict(list)
        self._waits: defaultdict[str, list[Wait]] = defaultdict(list)
        for edge in network.edges:
            self._leaving[edge.tail].append(edge)
            self._entering[edge.head].append(edge)
        for wait in network.waits:
            self._waits[wait.point].append(wait)

    @property
    def done(self) -> bool:
        """Whether every point has happened."""
        return len(self.times) == len(self.network.points)

    def awaited(self) -> tuple[TimeWindow, ...]:
        """The contingent points that have been activated and not yet observed, with their bounds."""
        links = [link for link in self._nature.values() if link.activation in self.times]
        return tuple(
            TimeWindow(link.contingent, begin + link.lower, begin + link.upper)
            for link in links
            if link.contingent not in self.times
            for begin in (self.times[link.activation],)
        )

    def enabled(self) -> tuple[TimeWindow, ...]:
        """The points that may be executed next, with their windows, the one that may be first at the front."""
        open_points = [point for point in self.network.points if point not in self.times and point not in self._nature]
        windows = [self._window(point) for point in open_points if self._is_enabled(point)]
        return tuple(sorted(windows, key=lambda window: (window.earliest, window.latest)))

    def deadline(self) -> float:
        """By when something must have been executed or observed: the first end of a window; infinite without one."""
        waiting = (point for point in self.network.points if point not in self.times and point not in self._nature)
        return min((self._upper[point] * TICK for point in waiting), default=math.inf)

    def next(self) -> TimeWindow | None:
        """What to execute next, unless something is observed before; None if only nature can act."""
        return next(iter(self.enabled()), None)

    def execute(self, point: str, time: float) -> None:
        """Tell that a point was executed.

        Raises:
            TemporalError: An unknown point, one that has happened or that nature executes, or a time in the past.
        """
        self._check(point, time)
        if point in self._nature:
            raise TemporalError(f"{point!r} is nature's to execute; tell when it was seen by observe()")
        if not self._is_enabled(point):
            missing = [edge.head for edge in self._leaving[point] if edge.weight < 0 and edge.head not in self.times]
            missing += [one.activation for one in self._waits[point] if self._is_ahead(one)]
            self.violations.append(f"{point} was executed before {', '.join(dict.fromkeys(missing))}")
        self._happen(point, time, self._window(point))

    def observe(self, point: str, time: float) -> None:
        """Tell that a contingent point was seen.

        Raises:
            TemporalError: An unknown point, one that has happened, is ours to execute or was not activated, or a time
                in the past.
        """
        self._check(point, time)
        if point not in self._nature:
            raise TemporalError(f"{point!r} is no contingent point: it is executed, not observed")
        link = self._nature[point]
        if link.activation not in self.times:
            raise TemporalError(f"{point!r} cannot be observed before {link.activation!r}, which activates it")
        begin = self.times[link.activation]
        self._happen(point, time, TimeWindow(point, begin + link.lower, begin + link.upper))

    def _window(self, point: str) -> TimeWindow:
        earliest = max(float(self._lower[point]), float(ticks(self.now)))
        for wait in self._waits[point]:
            if wait.contingent not in self.times and wait.activation in self.times:
                earliest = max(earliest, ticks(self.times[wait.activation]) + ticks(wait.duration))
        return TimeWindow(point, earliest * TICK, self._upper[point] * TICK)

    def _is_enabled(self, point: str) -> bool:
        after = all(edge.weight >= 0 or edge.head in self.times for edge in self._leaving[point])
        return after and not any(self._is_ahead(wait) for wait in self._waits[point])

    def _is_ahead(self, wait: Wait) -> bool:
        return wait.activation not in self.times and wait.duration > 0

    def _happen(self, point: str, time: float, window: TimeWindow) -> None:
        at = ticks(time)
        if not ticks(window.earliest) - 1 <= at or (window.latest < math.inf and at > ticks(window.latest) + 1):
            bounds = f"[{shown(window.earliest)}, {shown(window.latest)}]"
            self.violations.append(f"{point} happened at {shown(float(time))}, outside of {bounds}")
        self.times[point], self.now = float(time), max(self.now, float(time))
        for edge in self._leaving[point]:
            self._upper[edge.head] = min(self._upper[edge.head], at + ticks(edge.weight))
        for edge in self._entering[point]:
            self._lower[edge.tail] = max(self._lower[edge.tail], at - ticks(edge.weight))

    def _check(self, point: str, time: float) -> None:
        if point not in self._lower:
            raise unknown_point(point, self._lower)
        if point in self.times:
            raise TemporalError(f"{point!r} has happened already, at {shown(self.times[point])}")
        if not math.isfinite(time) or ticks(time) < ticks(self.now):
            raise TemporalError(f"the time of {point!r} must not be before now, {shown(self.now)}, got {time!r}")


Chooser = Callable[[Sequence[TimeWindow], float], tuple[str, float]]
"""Takes the enabled points and the deadline, returns a point and a time within its window and no later than that."""


def earliest_first(enabled: Sequence[TimeWindow], deadline: float) -> tuple[str, float]:
    """Execute what may be first, as early as it may be."""
    return enabled[0].point, enabled[0].earliest


def run_to_the_end(
    network: DispatchableNetwork, durations: Mapping[str, float], choose: Chooser = earliest_first, start: float = 0.0
) -> RealTimeExecution:
    """Execute a network while nature takes the given durations.

    Args:
        network: The dispatchable form.
        durations: How long each contingent link takes, by its contingent point.
        choose: What is executed next, and when; decided anew whenever nature was quicker.
        start: The time at which the execution begins.

    Returns:
        The execution, done.

    Raises:
        TemporalError: A duration is missing, or nothing can happen any more.
    """
    execution = RealTimeExecution(network, start)
    for link in network.contingent_links:
        if link.contingent not in durations:
            raise TemporalError(f"the duration of {link.contingent!r} is missing")
    while not execution.done:
        active = [(execution.times[link.activation] + durations[link.contingent], link.contingent)
                  for link in network.contingent_links
                  if link.activation in execution.times and link.contingent not in execution.times]  # fmt: skip
        enabled = execution.enabled()
        due = min(active, default=(math.inf, ""))
        point, time = choose(enabled, execution.deadline()) if enabled else ("", math.inf)
        if due[0] == time == math.inf:
            raise TemporalError("nothing can happen any more: no point is enabled and none is awaited")
        if due[0] <= time:
            execution.observe(due[1], max(due[0], execution.now))
        else:
            execution.execute(point, time)
    return execution


def violated(network: STN, times: Mapping[str, float]) -> tuple[str, ...]:
    """What of a network the given times of its points violate, by more than a tick; one sentence each."""
    links = network.contingent_links if isinstance(network, STNU) else ()
    edges = list(network.edges)
    edges += [TemporalEdge(link.activation, link.contingent, link.upper) for link in links]
    edges += [TemporalEdge(link.contingent, link.activation, -link.lower) for link in links]
    late = {edge: times[edge.head] - times[edge.tail] - edge.weight for edge in edges}
    return tuple(f"{edge}: {shown(by)} too much" for edge, by in late.items() if by > 2 * TICK)
