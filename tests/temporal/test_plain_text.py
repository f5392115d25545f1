from pathlib import Path

import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import STN, read_plain_stnu, write_plain_stnu
from lidarena.temporal.plain_text import format_plain_stnu, parse_plain_stnu
from tests.temporal.networks import DATA, build, needs_data

TEXT = """# KIND OF NETWORK
STNU
# Num Time-Points
3
# Time-Point Names
Z A C
# Ordinary Edges
A -1.5 Z
# Contingent Links
A 2 4 C
"""


def test_a_network_comes_back_as_it_was(tmp_path: Path) -> None:
    network = build(["A", "B", "C"], [("A", 0.1, 7.25, "B")], [("A", 1, 2.5, "C")])
    found = read_plain_stnu(write_plain_stnu(tmp_path / "one.plainStnu", network))
    assert found.points == network.points and found.edges == network.edges and found.name == "one"
    assert found.contingent_links == network.contingent_links


def test_no_point_comes_before_the_origin() -> None:
    network = parse_plain_stnu(TEXT)
    assert network.bounds("Z", "A")[0] == 1.5 and network.bounds("Z", "C")[0] == 0
    assert len(parse_plain_stnu(TEXT, origin=None).edges) == 1


@needs_data
def test_the_generators_files_come_back_as_they_were() -> None:
    for file in sorted((DATA / "cstnu_generator_lanes").glob("*050nodes*")):
        network = read_plain_stnu(file)
        again = parse_plain_stnu(format_plain_stnu(network))
        assert again.edges == network.edges and again.contingent_links == network.contingent_links


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("3\n", "4\n", "torn: it tells 4 Time-Points and holds 3"),
        ("A 2 4 C", "A 2 4", "line 10 of the text must be 'A lower upper C', got 'A 2 4'"),
        ("A 2 4 C", "A two 4 C", "needs a number, got 'two'"),
        ("A 2 4 C", "A 2 4 D", "unknown point 'D'"),
        ("A 2 4 C", "A 5 4 C", "must not be above"),
        ("A -1.5 Z", "A nan Z", "must be a number, got nan"),
        ("# Ordinary Edges\nA -1.5 Z\n", "", "torn or no plainStnu text"),
        ("# KIND OF NETWORK\n", "", "before any heading"),
    ],
)
def test_torn_text_is_refused(before: str, after: str, told: str) -> None:
    with pytest.raises(TemporalError, match=told):
        parse_plain_stnu(TEXT.replace(before, after))


def test_a_missing_file_and_names_with_spaces_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TemporalError, match="cannot be read as plainStnu text"):
        read_plain_stnu(tmp_path / "none")
    with pytest.raises(TemporalError, match="cannot hold the name 'a b'"):
        format_plain_stnu(STN(["a b"]))
