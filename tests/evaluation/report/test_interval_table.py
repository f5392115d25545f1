"""The table: values to sort by, intervals drawn to scale, names escaped."""

import math
import re

from lidarena.evaluation.report.interval_table import interval_table
from tests.evaluation.rows import row_of

PATHS = {"short": [10.0, 11.0, 12.0, 13.0, 14.0], "long": [20.0, 22.0, 24.0, 26.0, 28.0]}


def rows(**more: list[float]):
    return [row_of(name, completeness=[0.9] * 5, path_length=values) for name, values in PATHS.items()]


def test_every_cell_has_its_mean_to_sort_by() -> None:
    table = interval_table(rows())
    assert "data-value='12.0'" in table and "data-value='24.0'" in table
    assert table.count("<tr>") == 3 and "<b>12.0</b>" in table  # the best is bold
    assert "lower is better" in table and "data-better='low'" in table


def test_intervals_are_drawn_to_the_scale_of_their_column() -> None:
    table = interval_table(rows())
    cells = re.findall(
        r"<td data-value='(1|2)[\d.]+'>.*?left:([\d.]+)%;width:([\d.]+)%.*?'mean' style='left:([\d.]+)%", table
    )
    (_, left, width, mean), (_, left_2, width_2, mean_2) = cells
    assert 0 == float(left) < float(mean) < float(left) + float(width) < float(left_2) < float(mean_2)
    assert math.isclose(float(left_2) + float(width_2), 100, abs_tol=0.2)


def test_what_was_not_measured_is_a_dash() -> None:
    table = interval_table([*rows(), row_of("lost", completeness=[0.9] * 5)])
    assert "<td class='absent' data-value=''>–</td>" in table


def test_names_cannot_break_the_page() -> None:
    assert "<script>" not in interval_table([row_of("<script>", path_length=[1.0] * 5)])


def test_all_measures_are_more_than_the_main_ones() -> None:
    row = [row_of("a", completeness=[0.9] * 5, path_length=[1.0] * 5, steps=[3.0] * 5)]
    assert "Steps" in interval_table(row, main=False) and "Steps" not in interval_table(row)
