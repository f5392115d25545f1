import numpy as np
import pytest

from lidarena.world.lattice import parse_drawing


def test_a_drawing_is_read_with_its_bottom_line_first() -> None:
    walls = parse_drawing(["+---+---+", "|       |", "+---+   +", "|   |   |", "+---+---+"])
    assert walls.horizontal.tolist() == [[True, True], [True, False], [True, True]]
    assert walls.vertical.tolist() == [[True, True, True], [True, False, True]]


def test_walls_in_line_become_one_segment() -> None:
    walls = parse_drawing(["+---+---+", "|       |", "+---+   +", "|   |   |", "+---+---+"])
    segments = walls.segments([0.0, 1.0, 3.0], [0.0, 2.0, 5.0])
    expected = [[0, 0, 3, 0], [0, 2, 1, 2], [0, 5, 3, 5], [0, 0, 0, 5], [1, 0, 1, 2], [3, 0, 3, 5]]
    assert sorted(segments.tolist()) == sorted(expected)


def test_a_gap_parts_a_wall() -> None:
    walls = parse_drawing(["+---+   +---+", "|           |", "+---+---+---+"])
    assert [0.0, 1.0, 1.0, 1.0] in walls.segments(np.arange(4), np.arange(2)).tolist()


@pytest.mark.parametrize("lines", [["+---+", "|   |"], ["+---+", "|  |", "+---+"], ["+-x-+", "|   |", "+---+"]])
def test_a_torn_drawing_is_refused(lines: list[str]) -> None:
    with pytest.raises(ValueError, match="a drawing"):
        parse_drawing(lines)
