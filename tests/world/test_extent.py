"""How large a map may be, and how a refusal suggests the right word."""

import math

import pytest

from lidarena.base.errors import MapError, suggest
from lidarena.world.extent import MAX_CELLS, check_extent, check_resolution


@pytest.mark.parametrize("resolution", [0.005, 0.05, 2.0])
def test_believable_cells_are_returned_as_they_are(resolution: float) -> None:
    assert check_resolution("map 'a'", resolution) == resolution


@pytest.mark.parametrize("resolution", [0.0049, 2.01, 0.0, -0.05, math.nan, math.inf])
def test_absurd_cells_are_refused_with_their_size(resolution: float) -> None:
    with pytest.raises(MapError, match=f"map 'a' has cells of {resolution:g} m; 0.005 to 2 m a cell are allowed"):
        check_resolution("map 'a'", resolution)


@pytest.mark.parametrize(
    ("rows", "columns", "resolution", "says"),
    [
        (0, 5, 0.05, "at least one cell"),
        (5, 0, 0.05, "at least one cell"),
        (MAX_CELLS // 1000 + 1, 1000, 0.005, "at most 20 million cells"),
        (1, 1001, 1.0, "sides of at most 1000 m"),
        (20_001, 1, 0.05, "sides of at most 1000 m"),
    ],
)
def test_maps_that_are_none_for_a_robot_are_refused(rows: int, columns: int, resolution: float, says: str) -> None:
    with pytest.raises(MapError, match=says):
        check_extent("map 'a'", rows, columns, resolution)


def test_the_largest_maps_are_allowed() -> None:
    check_extent("map 'a'", MAX_CELLS // 1000, 1000, 0.05)
    check_extent("map 'a'", 1, 1000, 1.0)


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("rewrad", "; did you mean 'reward'? Allowed: action, map, reward"),
        ("maps", "; did you mean 'map'? Allowed: action, map, reward"),
        ("zzz", "; Allowed: action, map, reward"),
        ("", "; Allowed: action, map, reward"),
    ],
)
def test_a_misspelt_word_is_told_its_nearest(word: str, says: str) -> None:
    assert suggest(word, ["reward", "map", "action"]) == says
