from lidarena.evaluation.palette import LINES, line_of


def test_many_lines_look_different() -> None:
    lines = [line_of(place) for place in range(24)]
    assert len(set(lines)) == 24 and tuple(lines[: len(LINES)]) == LINES
