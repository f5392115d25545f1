import math
import random

import numpy as np
import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import STN, violated


def chain() -> STN:
    network = STN(["A", "B", "C"])
    network.add_requirement("A", "B", 1, 5)
    network.add_requirement("B", "C", 2, 4)
    network.add_requirement("A", "C", upper=6)
    return network


def test_the_minimal_network_is_as_tight_as_it_can_be() -> None:
    minimal = chain().minimal_network()
    assert minimal.bounds("A", "B") == (1, 4) and minimal.bounds("B", "C") == (2, 4)
    assert minimal.bounds("A", "C") == minimal.minimal_network().bounds("A", "C") == (3, 6)


def test_the_tightest_of_several_bounds_holds() -> None:
    network = chain()
    network.add_requirement("A", "B", 0, 3)
    network.add_requirement("B", "A", -9, -2)
    assert network.bounds("A", "B") == (2, 3) and network.bounds("B", "A") == (-3, -2)


def test_the_earliest_times_meet_everything() -> None:
    assert chain().earliest_times() == {"A": 0, "B": 1, "C": 3}
    assert violated(chain(), chain().earliest_times()) == ()
    assert len(violated(chain(), {"A": 0, "B": 0, "C": 7})) == 3


@pytest.mark.parametrize("seed", range(20))
def test_distances_are_those_of_floyd_and_warshall(seed: int) -> None:
    rng = random.Random(seed)
    points = [f"P{number}" for number in range(8)]
    times = {point: rng.randint(0, 20) for point in points}
    network, matrix = STN(points), np.full((8, 8), np.inf)
    for _ in range(20):
        tail, head = rng.sample(range(8), 2)
        weight = times[points[head]] - times[points[tail]] + rng.randint(0, 6)  # met by the times, hence consistent
        network.add_requirement(points[tail], points[head], upper=weight)
        matrix[tail, head] = min(matrix[tail, head], weight)
    np.fill_diagonal(matrix, 0)
    for middle in range(8):
        matrix = np.minimum(matrix, matrix[:, middle : middle + 1] + matrix[middle : middle + 1])
    assert network.is_consistent() and np.array_equal(network.distances(), matrix)


def test_a_negative_cycle_is_named() -> None:
    network = chain()
    network.add_requirement("C", "A", upper=-7)
    cycle = network.negative_cycle()
    assert cycle is not None and set(cycle.points) == {"A", "C"} and cycle.length == -1
    with pytest.raises(TemporalError, match=r"A → C → A|C → A → C"):
        network.distances()
    assert not network.is_consistent()


def test_a_point_before_itself_is_a_cycle() -> None:
    network = chain()
    network.add_requirement("B", "B", 0, 3)
    assert network.is_consistent()
    network.add_requirement("B", "B", upper=-1)
    cycle = network.negative_cycle()
    assert cycle is not None and cycle.points == ("B",)


def test_sums_are_exact() -> None:
    network = STN(["A", "B", "C"])
    network.add_requirement("A", "B", 0.1, 0.1)
    network.add_requirement("B", "C", 0.2, 0.2)
    network.add_requirement("A", "C", 0.3, 0.3)
    assert network.is_consistent() and 0.1 + 0.2 != 0.3


@pytest.mark.parametrize(
    ("start", "end", "lower", "upper", "told"),
    [
        ("A", "b", 0, 1, "unknown point 'b'; did you mean 'B'"),
        ("A", "B", 5, 1, r"must not be above the upper, got \[5, 1\]"),
        ("A", "B", math.nan, 1, "must be a number, got nan"),
        ("A", "B", 0, "1", "must be a number, got '1'"),
        ("A", "B", math.inf, None, "lower bound"),
        ("A", "B", 0, 1e12, "within"),
    ],
)
def test_bad_requirements_are_refused(start: str, end: str, lower: float, upper: float, told: str) -> None:
    with pytest.raises(TemporalError, match=told):
        chain().add_requirement(start, end, lower, upper)


@pytest.mark.parametrize(("point", "told"), [("", "not empty"), ("A", "there already"), (3, "must be a text")])
def test_bad_points_are_refused(point: str, told: str) -> None:
    with pytest.raises(TemporalError, match=told):
        chain().add_point(point)


def test_it_tells_what_it_is() -> None:
    assert repr(chain()) == "<STN: 3 points, 5 edges>" and "A" in chain() and len(chain()) == 3
