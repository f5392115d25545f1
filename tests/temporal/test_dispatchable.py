import random

import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import STN, STNU, check_controllability, make_dispatchable
from tests.temporal.networks import build, random_network


def test_a_wait_is_found() -> None:
    """The robot must act at most 2 after the human ends and not before: it waits for the end."""
    network = build(["start", "end", "robot"], [("end", -2, 3, "robot")], [("start", 4, 10, "end")])
    network_waits = make_dispatchable(network).waits
    assert [(wait.point, wait.activation, wait.duration, wait.contingent) for wait in network_waits] == [
        ("robot", "start", 8, "end")
    ]


def test_implied_edges_are_left_out() -> None:
    network = STN(["A", "B", "C"])
    network.add_requirement("A", "B", 1, 2)
    network.add_requirement("B", "C", 1, 2)
    network.add_requirement("A", "C", 2, 4)
    assert make_dispatchable(network).size == 4
    assert make_dispatchable(network, reduce=False).size == 6


def test_it_never_grows_by_reduction() -> None:
    rng, sizes = random.Random(3), []
    while len(sizes) < 200:
        network = random_network(rng)
        if check_controllability(network):
            sizes.append((make_dispatchable(network).size, make_dispatchable(network, reduce=False).size))
    assert all(small <= full for small, full in sizes) and sum(small for small, _ in sizes) < sum(
        full for _, full in sizes
    )


def test_what_cannot_be_dispatched_is_refused() -> None:
    network = STNU(["A", "C"])
    network.add_contingent_link("A", "C", 1, 5)
    network.add_requirement("A", "C", upper=3)
    with pytest.raises(TemporalError, match=r"no dispatchable form, it is not dynamically controllable: .*A"):
        make_dispatchable(network)
    network = STNU(["A", "C"])
    network.add_contingent_link("A", "C", -1, 5)
    assert check_controllability(network)
    with pytest.raises(TemporalError, match="must be at least 0, got -1"):
        make_dispatchable(network)
