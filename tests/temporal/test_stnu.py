import math

import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import STNU


def human() -> STNU:
    network = STNU(["start", "end", "next"])
    network.add_contingent_link("start", "end", 2, 4)
    return network


@pytest.mark.parametrize(
    ("activation", "contingent", "lower", "upper", "told"),
    [
        ("start", "nxt", 1, 2, "unknown point 'nxt'; did you mean 'next'"),
        ("begin", "next", 1, 2, "unknown point 'begin'"),
        ("start", "next", 3, 2, r"must not be above the upper, got \[3, 2\]"),
        ("start", "next", 1, math.inf, "must be finite"),
        ("start", "next", math.nan, 2, "must be a number, got nan"),
        ("start", "start", 1, 2, "between two points"),
        ("next", "end", 1, 2, "from 'start' already"),
    ],
)
def test_bad_links_are_refused(activation: str, contingent: str, lower: float, upper: float, told: str) -> None:
    with pytest.raises(TemporalError, match=told):
        human().add_contingent_link(activation, contingent, lower, upper)


def test_as_an_stn_its_links_are_requirements() -> None:
    network = human()
    network.add_requirement("start", "next", 0, 3)
    network.add_requirement("end", "next", 0, 0)
    assert network.minimal_network().bounds("start", "end") == (2, 3)
    assert network.is_consistent()
    network.add_requirement("start", "next", upper=1)
    assert not network.is_consistent()


def test_it_tells_its_links() -> None:
    assert human().contingent_points == ("end",) and human().contingent_links[0].upper == 4
    assert repr(human()) == "<STNU: 3 points, 0 edges, 1 contingent links>"


def test_in_normal_form_every_link_has_a_point_of_its_own() -> None:
    network = human()
    network.add_contingent_link("end", "next", 3, 3)
    form = network.normal_form()
    assert form.points == 3 and list(form.slack) == [2_000_000, 0]
    assert {(int(a), int(b)) for a, b in zip(form.tail, form.head, strict=True)} == {
        (0, 3), (3, 0), (1, 4), (4, 1), (1, 2), (2, 1)
    }  # fmt: skip


def test_links_that_wait_for_each_other_are_refused() -> None:
    network = STNU(["a", "b", "c"])
    network.add_contingent_link("a", "b", 1, 2)
    network.add_contingent_link("b", "c", 0, 0)
    with pytest.raises(TemporalError, match="in a circle: a → b → c → a"):
        network.add_contingent_link("c", "a", 0, 0)
    assert len(network.contingent_links) == 2
