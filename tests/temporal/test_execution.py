import random
from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import TemporalError
from lidarena.temporal import (
    STNU,
    RealTimeExecution,
    TimeWindow,
    check_controllability,
    make_dispatchable,
    run_to_the_end,
    violated,
)
from lidarena.temporal.execution import Chooser, earliest_first
from tests.temporal.networks import build, random_network


def at_random(rng: random.Random) -> Chooser:
    """Any enabled point, anywhere in its window, its ends included."""

    def choose(enabled: Sequence[TimeWindow], deadline: float) -> tuple[str, float]:
        first = enabled[0].earliest
        last = max(first, min(deadline, first + 20))
        time = rng.choice([first, last, rng.uniform(first, last)])
        return rng.choice([window for window in enabled if window.earliest <= time]).point, time

    return choose


@settings(max_examples=400, deadline=None)
@given(
    seed=st.integers(0, 2**32),
    shares=st.lists(st.one_of(st.just(0.0), st.just(1.0), st.floats(0, 1)), min_size=3, max_size=3),
    early=st.booleans(),
)
def test_whatever_nature_does_nothing_is_violated(seed: int, shares: list[float], early: bool) -> None:
    rng = random.Random(seed)
    network = random_network(rng)
    while not check_controllability(network):
        network = random_network(rng)
    links = network.contingent_links
    durations = {
        link.contingent: link.lower + share * (link.upper - link.lower)
        for link, share in zip(links, shares[: len(links)], strict=True)
    }
    done = run_to_the_end(make_dispatchable(network), durations, earliest_first if early else at_random(rng))
    assert done.violations == [] and violated(network, done.times) == ()


def waiting() -> STNU:
    return build(["start", "end", "robot"], [("end", -2, 3, "robot")], [("start", 4, 10, "end")])


def test_it_waits_until_the_point_is_seen() -> None:
    execution = RealTimeExecution(make_dispatchable(waiting()))
    assert [window.point for window in execution.enabled()] == ["start"]
    execution.execute("start", 1)
    window = execution.next()
    assert window is not None and (window.point, window.earliest) == ("robot", 9)
    assert execution.awaited() == (TimeWindow("end", 5, 11),)
    execution.observe("end", 5)
    assert execution.next() == TimeWindow("robot", 5, 8) and execution.deadline() == 8
    execution.execute("robot", 5)
    assert execution.done and execution.next() is None and execution.violations == []


def test_what_is_violated_is_told_and_it_goes_on() -> None:
    execution = RealTimeExecution(make_dispatchable(waiting()))
    execution.execute("robot", 0)
    execution.execute("start", 1)
    execution.observe("end", 20)
    assert execution.done and len(execution.violations) >= 2
    assert execution.violations[0] == "robot was executed before start"
    assert execution.violations[-1].startswith("end happened at 20, outside of [5, 11]")


def test_bad_calls_are_refused() -> None:
    execution = RealTimeExecution(make_dispatchable(waiting()), start=2)
    for call, point, time, told in (
        (execution.execute, "strat", 3, "did you mean 'start'"),
        (execution.execute, "end", 3, "nature's to execute"),
        (execution.execute, "start", 1, "before now, 2"),
        (execution.execute, "start", float("nan"), "got nan"),
        (execution.observe, "robot", 3, "no contingent point"),
        (execution.observe, "end", 3, "before 'start', which activates it"),
    ):
        with pytest.raises(TemporalError, match=told):
            call(point, time)
    execution.execute("start", 3)
    with pytest.raises(TemporalError, match="has happened already, at 3"):
        execution.execute("start", 4)


def test_a_missing_duration_is_refused() -> None:
    with pytest.raises(TemporalError, match="duration of 'end' is missing"):
        run_to_the_end(make_dispatchable(waiting()), {})
