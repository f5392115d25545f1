import csv
import math
from pathlib import Path

import pytest

from lidarena.agents.learning_curve import COLUMNS, FILE, LearningCurve


@pytest.fixture(autouse=True)
def quiet_torch() -> None:
    pytest.importorskip("tensorboard")


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / FILE).open(newline="") as stream:
        return list(csv.DictReader(stream))


def write(folder: Path, *steps: int, after: int = 0, **values: float) -> None:
    curve = LearningCurve(folder, after)
    for step in steps:
        curve.add(step, 0.5 * step, values)
    curve.close()


def test_a_row_holds_what_is_known_and_leaves_the_rest_empty(tmp_path: Path) -> None:
    write(tmp_path, 8, **{"rollout/ep_rew_mean": 1.25, "train/value_loss": math.nan, "own/number": 3.0})
    (row,) = rows(tmp_path)
    assert list(row) == list(COLUMNS)
    assert (row["step"], float(row["seconds"]), row["episode_return"]) == ("8", 4.0, "1.25")
    assert row["value_loss"] == row["completeness"] == ""


def test_rows_that_are_trained_again_are_dropped(tmp_path: Path) -> None:
    write(tmp_path, 8, 16, 24)
    write(tmp_path, 24, after=16)
    assert [row["step"] for row in rows(tmp_path)] == ["8", "16", "24"]


def test_a_row_that_a_crash_has_torn_is_dropped(tmp_path: Path) -> None:
    write(tmp_path, 8, 16)
    file = tmp_path / FILE
    file.write_text(file.read_text() + "24,1")
    write(tmp_path, 24, after=16)
    assert [row["step"] for row in rows(tmp_path)] == ["8", "16", "24"]
