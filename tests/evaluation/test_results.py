"""Rows, the schema of results.json, who may be compared with whom, and a folder that is whole or not there."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison_config import ComparisonConfig
from lidarena.evaluation.results import (
    RESULTS_FILE,
    best,
    check_folder,
    contenders,
    difference,
    results_document,
    write_results,
    write_results_folder,
)
from lidarena.evaluation.statistics import bootstrap, share_interval
from tests.evaluation.rows import BY_NAME, row_of

CONFIG = check_config({"envs": ["lidarena/Env1-v0"], "policies": ["random", "frontier"]}, ComparisonConfig)
N = 12
NOISE = np.random.default_rng(0).standard_normal(N)


def test_a_row_has_means_intervals_and_values_in_the_order_of_the_seeds() -> None:
    lengths, crashes = list(20 + NOISE), [1.0] * 3 + [0.0] * 9
    row = row_of("random", path_length=lengths, collision=crashes, entropy_gmapping=[math.nan] * N)
    assert row.metrics["path_length"].values == tuple(lengths)
    assert row.metrics["path_length"].interval == bootstrap(lengths)
    assert row.metrics["collision"].interval == share_interval(crashes)
    assert "entropy_gmapping" not in row.metrics and "time" not in row.metrics


def test_results_json_has_the_schema(tmp_path: Path) -> None:
    rows = [row_of("random", path_length=[1.0, math.nan, 3.0]), row_of("frontier", completeness=[0.5])]
    write_results(tmp_path / RESULTS_FILE, CONFIG, rows)
    document = json.loads((tmp_path / RESULTS_FILE).read_text())
    assert set(document) == {"config", "versions", "rows"}
    assert ComparisonConfig.model_validate(document["config"]) == CONFIG
    assert {"python", "lidarena", "numpy", "torch"} <= set(document["versions"])
    for row in document["rows"]:
        assert set(row) == {"env", "policy", "episodes", "metrics"}
        for metric in row["metrics"].values():
            assert set(metric) == {"mean", "ci_low", "ci_high", "values"}
            assert len(metric["values"]) == row["episodes"]
    random, frontier = document["rows"]
    assert random["metrics"]["path_length"]["values"] == [1.0, None, 3.0]
    assert random["metrics"]["path_length"]["mean"] == 2.0
    assert frontier["metrics"] == {"completeness": {"mean": 0.5, "ci_low": None, "ci_high": None, "values": [0.5]}}


def test_the_document_is_the_same_every_time() -> None:
    first, second = (results_document(CONFIG, [row_of("random", time=list(NOISE))]) for _ in range(2))
    assert first == second


def test_a_short_path_is_no_merit_for_who_explored_less() -> None:
    diligent = row_of("diligent", completeness=list(0.95 + 0.01 * NOISE), path_length=list(30 + NOISE))
    crasher = row_of("crasher", completeness=list(0.2 + 0.01 * NOISE), path_length=list(1 + 0.1 * NOISE))
    rows = [crasher, diligent]
    assert contenders(rows, BY_NAME["path_length"]) == [diligent]
    assert contenders(rows, BY_NAME["completeness"]) == rows
    assert best(rows, BY_NAME["path_length"]) == {"diligent"}
    assert best(rows, BY_NAME["completeness"]) == {"diligent"}


def test_what_cannot_be_told_from_the_best_is_as_good() -> None:
    again = np.random.default_rng(1).standard_normal(N)
    rows = [
        row_of("a", completeness=list(0.9 + 0.01 * NOISE)),
        row_of("b", completeness=list(0.9 + 0.01 * again)),
        row_of("c", completeness=list(0.7 + 0.01 * NOISE)),
    ]
    assert best(rows, BY_NAME["completeness"]) == {"a", "b"}
    assert best(rows[:2], BY_NAME["completeness"]) == set()  # all level: bold would say nothing
    assert best(rows[:1], BY_NAME["completeness"]) == set()


def test_pairs_tell_apart_what_intervals_cannot() -> None:
    hard = 10 * NOISE  # the difficulty of the seeds
    rows = [row_of("a", trajectory_error=list(50 + hard)), row_of("b", trajectory_error=list(51 + hard + 0.01 * hard))]
    measure = BY_NAME["trajectory_error"]
    assert rows[0].metrics[measure.name].interval.high > rows[1].metrics[measure.name].interval.low
    assert best(rows, measure) == {"a"}
    assert difference(rows[1], rows[0], measure).low > 0.8


def test_no_best_without_a_direction_or_a_measurement() -> None:
    rows = [row_of("a", steps=list(NOISE)), row_of("b", steps=list(NOISE + 5))]
    assert best(rows, BY_NAME["steps"]) == set()
    assert best(rows, BY_NAME["time"]) == set()


def fill_with(text: str):  # type: ignore[no-untyped-def]
    def fill(folder: Path) -> None:
        (folder / RESULTS_FILE).write_text(text)
        (folder / "pictures").mkdir()

    return fill


def test_a_folder_appears_whole(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "results"

    def fill(folder: Path) -> None:
        assert not out.exists() and folder.is_dir() and not any(folder.iterdir())
        fill_with("new")(folder)

    assert write_results_folder(out, fill) is None
    assert (out / RESULTS_FILE).read_text() == "new"
    assert [path.name for path in out.parent.iterdir()] == ["results"]  # nothing temporary is left


def test_earlier_results_are_kept(tmp_path: Path) -> None:
    out = tmp_path / "results"
    asides = [write_results_folder(out, fill_with(text)) for text in ("first", "second", "third")]
    assert asides == [None, tmp_path / "results.1", tmp_path / "results.2"]
    texts = [(folder / RESULTS_FILE).read_text() for folder in (asides[1], asides[2], out)]  # type: ignore[operator]
    assert texts == ["first", "second", "third"]


def test_a_failure_leaves_earlier_results_alone(tmp_path: Path) -> None:
    out = tmp_path / "results"
    write_results_folder(out, fill_with("precious"))

    def fail(folder: Path) -> None:
        (folder / RESULTS_FILE).write_text("torn")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_results_folder(out, fail)
    assert [path.name for path in tmp_path.iterdir()] == ["results"]
    assert (out / RESULTS_FILE).read_text() == "precious"


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    out = tmp_path / "results"
    out.mkdir()
    assert write_results_folder(out, fill_with("new")) is None
    assert [path.name for path in tmp_path.iterdir()] == ["results"]


def test_a_folder_of_other_things_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(ConfigError, match=r"is a folder without results.json; choose another place"):
        write_results_folder(tmp_path, fill_with("new"))
    with pytest.raises(ConfigError, match="is a file"):
        check_folder(tmp_path / "thesis.tex")
    assert (tmp_path / "thesis.tex").read_text() == "years of work"
