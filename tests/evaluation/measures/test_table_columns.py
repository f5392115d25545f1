import pytest

from lidarena.base.errors import ConfigError
from lidarena.evaluation.measures.table_columns import EFFORT, OUTCOME, SUCCESS, Measure, merged, whole_table

PATH = Measure("path_length", "Path", "m", better="low", needs="success")


def test_a_family_s_columns_stand_between_outcome_and_effort() -> None:
    assert whole_table([PATH]) == (*OUTCOME, PATH, *EFFORT)


def test_a_family_may_place_what_every_environment_has_itself() -> None:
    table = whole_table([PATH, SUCCESS])
    assert [column.name for column in table][:3] == ["collision", "path_length", "success"]
    assert len(table) == len(OUTCOME) + 1 + len(EFFORT)


@pytest.mark.parametrize(
    ("columns", "says"),
    [
        ([PATH, Measure("path_length", "Way")], "two columns are named 'path_length'"),
        ([Measure("time", "Time", needs="sucess")], "did you mean 'success'"),
    ],
)
def test_columns_that_contradict_are_refused(columns: list[Measure], says: str) -> None:
    with pytest.raises(ConfigError, match=says):
        whole_table(columns)


def test_headings_tell_unit_and_direction() -> None:
    assert PATH.label == "Path (m)" and PATH.heading == "Path (m) ↓"
    assert SUCCESS.heading == "Success (%) ↑" and Measure("steps", "Steps").heading == "Steps"


def test_tables_merge_in_the_order_of_each() -> None:
    a, b, c, d = (Measure(name, name) for name in "abcd")
    assert merged([(a, c), (a, b, c), (d,)]) == [d, a, b, c]
    assert merged([]) == []
