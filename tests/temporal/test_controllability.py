import random
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import (
    STN,
    STNU,
    NegativeCycle,
    check_controllability,
    read_graphml,
    read_plain_stnu,
    require_controllable,
)
from tests.temporal import fixpoint
from tests.temporal.networks import DATA, Labelled, build, classic, fuzz, heatlab, needs_data, random_network


def is_closed(cycle: NegativeCycle) -> bool:
    following = (*cycle.edges[1:], cycle.edges[0])
    return all(one.head == other.tail for one, other in zip(cycle.edges, following, strict=True))


@needs_data
@pytest.mark.parametrize(("read", "count"), [(classic, 68), (fuzz, 2000), (heatlab, 562)])
def test_every_labelled_network_is_answered_right(read: Callable[[], Iterator[Labelled]], count: int) -> None:
    found = list(read())
    assert len(found) == count
    assert not [one.name for one in found if bool(check_controllability(one.network)) != one.controllable]
    told = [one for one in found if one.consistent is not None]
    assert not [one.name for one in told if one.network.is_consistent() != one.consistent]


@needs_data
def test_the_generators_lanes_are_answered_right() -> None:
    files = sorted((DATA / "cstnu_generator_lanes").glob("*.plainStnu"))
    assert len(files) == 32
    answers = {file.name: bool(check_controllability(read_plain_stnu(file))) for file in files}
    assert not [name for name, answer in answers.items() if answer != name.startswith("dc")]


@needs_data
@pytest.mark.parametrize(
    ("file", "controllable"),
    [
        ("1000_004OK.stnu", True),
        ("20220109stnu4newRules.stnu", False),
        ("fig1RUL2022.stnu", False),
        ("fig7FD_STNU.stnu", True),
        ("testGraphML.stnu", True),
        ("testSTNwithNegativeCycle.stn", False),
    ],
)
def test_the_cstnu_tools_samples_are_answered_right(file: str, controllable: bool) -> None:
    assert bool(check_controllability(read_graphml(DATA / "cstnu_tool_LGPL" / file))) == controllable


def test_chained_links_add_up() -> None:
    """The case that other programs accept: two links in a row take up to 17, and 10 are allowed."""
    network = build(["A", "C1", "C2"], [("A", None, 10, "C2")], [("A", 4, 7, "C1"), ("C1", 5, 10, "C2")])
    answer = check_controllability(network)
    assert not answer and answer.cycle is not None and set(answer.cycle.points) == {"A", "C1", "C2"}
    assert network.is_consistent()
    assert check_controllability(
        build(["A", "C1", "C2"], [("A", None, 17, "C2")], [("A", 4, 7, "C1"), ("C1", 5, 10, "C2")])
    )


def test_random_networks_are_answered_like_the_rules_answer_them() -> None:
    rng, answers = random.Random(19), []
    for _ in range(2000):
        network = random_network(rng)
        answer = check_controllability(network)
        assert bool(answer) == fixpoint.is_controllable(network), (network.edges, network.contingent_links)
        if answer.cycle is not None:
            assert is_closed(answer.cycle) and answer.cycle.length < 0
            assert set(answer.cycle.points) <= set(network.points)
        answers.append(bool(answer))
    assert 600 < sum(answers) < 1400


def test_the_reason_names_points_and_durations() -> None:
    network = build(
        ["start", "end", "robot"], [("end", -3, None, "robot"), ("robot", 2, None, "end")], [("start", 3, 8, "end")]
    )
    with pytest.raises(TemporalError, match=r"not dynamically controllable: .*robot") as refused:
        require_controllable(network)
    assert "4 too much" in str(refused.value)
    require_controllable(STN(["A"]))


def test_knowing_the_duration_beforehand_is_not_asked_for() -> None:
    """The robot must act 2 before the human ends: fine if the duration is fixed, not if it is only observed."""
    for lower, answer in ((8, True), (3, False)):
        rows = [("robot", 2, 2, "end")]
        assert (
            bool(check_controllability(build(["start", "end", "robot"], rows, [("start", lower, 8, "end")]))) == answer
        )


def test_an_empty_network_and_one_point_are_controllable() -> None:
    assert check_controllability(STNU()) and check_controllability(STNU(["A"]))
    assert str(check_controllability(STNU())) == "dynamically controllable"


def test_a_point_before_itself_is_the_reason() -> None:
    network = STNU(["A"])
    network.add_requirement("A", "A", upper=-2)
    answer = check_controllability(network)
    assert answer.cycle is not None and answer.cycle.points == ("A",) and answer.cycle.length == -2


def test_the_library_needs_neither_torch_nor_matplotlib_nor_gymnasium() -> None:
    """The package itself registers environments; its library alone, under a bare package, does not ask for them."""
    code = (
        "import sys, types, importlib.util as find\n"
        "bare = types.ModuleType('lidarena')\n"
        "bare.__path__ = find.find_spec('lidarena').submodule_search_locations\n"
        "sys.modules['lidarena'] = bare\n"
        "import lidarena.temporal\n"
        "print(sorted({'torch', 'matplotlib', 'gymnasium', 'pymunk', 'networkx', 'cv2'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
