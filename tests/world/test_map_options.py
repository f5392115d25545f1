"""The seed and the options in a map's name."""

import pytest

from lidarena.base.errors import MapError
from lidarena.world.map_options import read_options, read_seed


def test_what_is_read() -> None:
    assert read_seed("maze:12", "12", "maze:7") == 12
    assert read_options("maze:1?a=1.5&b=2", "a=1.5&b=2", ["a", "b"]) == {"a": 1.5, "b": 2.0}
    assert read_options("maze:1", "", ["a"]) == {}


@pytest.mark.parametrize("text", ["", "-1", "1.5", "x", "9" * 20])
def test_a_seed_is_a_whole_number(text: str) -> None:
    with pytest.raises(MapError, match="a whole number is needed, as in 'maze:7'"):
        read_seed("maze:?", text, "maze:7")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("with=1", "no option 'with'; did you mean 'width'"),
        ("width=1&width=2", "gives 'width' twice"),
        ("width=wide", "width 'wide'; a number is needed"),
        ("width", "written as in"),
    ],
)
def test_options_that_cannot_be_read(text: str, sentence: str) -> None:
    with pytest.raises(MapError, match=sentence):
        read_options("maze:1?" + text, text, ["width", "height"])
