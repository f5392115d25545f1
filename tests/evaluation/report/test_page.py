"""The page: one file that loads nothing, opens with the answer, and holds every episode."""

import base64
import json
import re
import zlib

import pytest

from lidarena.evaluation.report.page import page
from lidarena.evaluation.report.sources import Figure, ReportContent, content_of_folder
from tests.evaluation.report.folders import results
from tests.evaluation.rows import row_of


def test_it_loads_nothing_from_anywhere() -> None:
    text = page(content_of_folder(results()))
    assert not re.findall(r"""(?:src|href|url)\s*[=(]\s*["']?(?!data:)[^"')\s>]""", text.split("<script")[0])
    assert "http://" not in text.split('id="replays"')[1] and "@import" not in text and "fetch(" not in text


def test_the_answer_comes_first() -> None:
    text = page(content_of_folder(results()))
    assert (
        text.index("class='answer'") < text.index("<table") < text.index('id="player"') < text.index("data:image/png")
    )
    assert "driver is best in all 2 environments." in text


def test_the_episodes_are_in_it() -> None:
    text = page(content_of_folder(results()))
    found = re.search(r'id="replays">([^<]*)<', text)
    assert found is not None
    episodes = json.loads(zlib.decompress(base64.b64decode(found.group(1))))
    assert {(one["env"], one["policy"]) for one in episodes} == {
        (env, policy) for env in ("Corridor", "Other corridor") for policy in ("driver", "crasher")
    }


def test_names_cannot_break_the_page() -> None:
    content = ReportContent("</title><script>alert(1)</script>", [row_of("<b>", "<i>", path_length=[1.0] * 5)])
    text = page(content)
    assert "<script>alert" not in text and "<td><b>" not in text and "&lt;i&gt;" in text


@pytest.mark.parametrize("facts", [(), ("Nothing was recorded.",)])
def test_a_page_without_rows_players_or_pictures(facts: tuple[str, ...]) -> None:
    text = page(ReportContent("bare", facts=facts, missing=["there is no policy"]))
    assert "there is no policy" in text and 'id="player"' not in text and "lidarenaPlayer" not in text
    assert all(fact in text for fact in facts)


def test_curves_are_drawn_in_the_page() -> None:
    svg = Figure("curves", b"<svg xmlns='http://www.w3.org/2000/svg'></svg>", "svg")
    assert "<summary>curves</summary><svg" in page(ReportContent("curves", figures=[svg]))
