from pathlib import Path

import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import STN, STNU, read_graphml, write_graphml
from lidarena.temporal.graphml import format_graphml, parse_graphml
from tests.temporal.networks import DATA, build, needs_data


def network() -> STNU:
    return build(["A & B", "B", "C<D>"], [("A & B", 0.1, 7.25, "B")], [("A & B", 0, 2.5, "C<D>")])


def test_a_network_comes_back_as_it_was(tmp_path: Path) -> None:
    found = read_graphml(write_graphml(tmp_path / "one.stnu", network()))
    assert isinstance(found, STNU) and found.points == network().points and found.edges == network().edges
    assert found.contingent_links == network().contingent_links


def test_a_plain_network_stays_one() -> None:
    plain = STN(["A", "B"], name="two")
    plain.add_requirement("A", "B", 1, 2)
    found = parse_graphml(format_graphml(plain).encode())
    assert not isinstance(found, STNU) and found.name == "two" and found.bounds("A", "B") == (1, 2)


@needs_data
def test_links_are_read_in_both_ways_of_writing() -> None:
    labelled = read_graphml(DATA / "cstnu_tool_LGPL" / "testGraphML.stnu")
    plain = read_graphml(DATA / "cstnu_tool_LGPL" / "fig7FD_STNU.stnu")
    assert isinstance(labelled, STNU) and labelled.contingent_links == (("X", 2, 5, "Y"),)
    assert isinstance(plain, STNU) and plain.contingent_links == (("A", 1, 10, "C"),)
    assert plain.bounds("Z", "C") == (7, float("inf")) and plain.bounds("Z", "A")[0] == 0


def test_entities_are_refused_without_expansion() -> None:
    bomb = '<!DOCTYPE graphml [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]>'
    text = format_graphml(network()).replace("<graphml", f"{bomb}<graphml", 1)
    for data in (text.encode(), text.replace("UTF-8", "UTF-16").encode("utf-16")):
        with pytest.raises(TemporalError, match=r"declares the document type 'graphml'.* none is allowed"):
            parse_graphml(data)
    with pytest.raises(TemporalError, match="undefined entity"):
        parse_graphml(format_graphml(network()).replace("0.1", "&x;").encode())


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_a_torn_file_is_refused_in_one_sentence(share: float) -> None:
    text = format_graphml(network()).encode()
    with pytest.raises(TemporalError, match=r"the GraphML is torn or no XML: [^\n]*$"):
        parse_graphml(text[: int(share * len(text))])


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        (">STNU<", ">CSTN<", "of the type 'CSTN'; did you mean 'STN'"),
        (">STNU<", ">STN<", "contingent edges, which only an STNU has"),
        ("UC(C&lt;D&gt;):-2.5", "UC(C&lt;D&gt;):", "needs a number as its Value"),
        (">7.25<", ">much<", "needs a number as its Value, got 'much'"),
        ('target="B"', 'target="E"', "unknown point 'E'"),
        (">4<", ">9<", "torn: it tells nEdges 9 and holds 4"),
        ("<graph ", "<grap ", "torn or no XML"),
        ('"contingent"', '"contingent"', "lacks one of its two edges"),
    ],
)
def test_bad_files_are_refused(before: str, after: str, told: str) -> None:
    text = format_graphml(network())
    assert before in text or "lacks" in told
    text = text.replace(before, after)
    if "lacks" in told:
        text = text.replace("LC(", "UC(").replace(">4<", "><")
    with pytest.raises(TemporalError, match=told):
        parse_graphml(text.encode())


def test_a_missing_file_and_other_xml_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TemporalError, match="cannot be read as GraphML"):
        read_graphml(tmp_path / "none.stnu")
    with pytest.raises(TemporalError, match="no element 'graph'"):
        parse_graphml(b"<html/>")
