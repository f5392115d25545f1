"""What is read of a folder: the same rows as were written, and what is missing by name."""

import json
import shutil
from pathlib import Path

import pytest

from lidarena.base.errors import ConfigError
from lidarena.evaluation.report.sources import content_of_folder, read_results, rows_of
from lidarena.evaluation.results import RESULTS_FILE
from tests.evaluation.report.folders import results


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(results(), tmp_path / "copy"))


def test_all_that_was_written_is_found(folder: Path) -> None:
    content = content_of_folder(folder)
    assert [(row.env, row.policy, row.episodes) for row in content.rows] == [
        ("Corridor", "driver", 6), ("Corridor", "crasher", 6),
        ("Other corridor", "driver", 6), ("Other corridor", "crasher", 6),
    ]  # fmt: skip
    assert [(one.env, one.policy) for one in content.players] == [(row.env, row.policy) for row in content.rows]
    assert content.missing == [] and len(content.figures) >= 4
    assert content.rows[0].metrics["path_length"].interval.low <= content.rows[0].metrics["path_length"].interval.mean


def test_columns_of_an_environment_that_is_not_known_here_are_the_bare_names(folder: Path) -> None:
    document = read_results(folder)
    for row in document["rows"]:
        row["metrics"] = {"buoys": {"mean": 1.5, "ci_low": None, "ci_high": None, "values": [1, 2, None]}}
    (first, *_) = rows_of(document)
    assert [column.title for column in first.measured] == ["buoys"]


def test_half_of_the_results_are_shown_and_the_rest_is_named(folder: Path) -> None:
    (folder / "replays" / "Corridor" / "driver.json.gz").write_bytes(b"torn")
    shutil.rmtree(folder / "pictures")
    content = content_of_folder(folder)
    assert len(content.players) == 3
    assert content.missing == [
        "there is no episode to play of driver in Corridor",
        "there are no pictures (the folder 'pictures')",
    ]
    shutil.rmtree(folder / "replays")
    assert "there are no episodes to play (the folder 'replays')" in content_of_folder(folder).missing


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "holds neither results.json of an evaluation nor config.yaml of a training"),
        ("{", "is torn"),
        ("[]", "it has no list 'rows'"),
        (json.dumps({"rows": [{"env": "a"}]}), "a row that is torn"),
        (json.dumps({"rows": ["a"]}), "a row that is torn"),
    ],
)
def test_what_holds_no_results_is_refused(text: str | None, sentence: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / RESULTS_FILE).write_text(text)
    with pytest.raises(ConfigError, match=sentence):
        content_of_folder(tmp_path)


def test_a_folder_that_there_is_not() -> None:
    with pytest.raises(ConfigError, match="there is no folder 'nowhere'"):
        content_of_folder(Path("nowhere"))
