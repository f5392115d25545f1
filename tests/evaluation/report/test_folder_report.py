"""``write_report``: of results, of a training, and of neither; learning curves where agents were compared."""

import json
import shutil
from pathlib import Path

import pytest

from lidarena.base.errors import ConfigError
from lidarena.evaluation.report.folder_report import write_report
from tests.evaluation.report.folders import results
from tests.evaluation.test_reward_curves import run


def test_an_evaluation_writes_the_same_page_as_later(tmp_path: Path) -> None:
    file, missing = write_report(results(), tmp_path / "again.html")
    assert missing == []
    assert file.read_text() == (results() / "report.html").read_text()
    assert file.stat().st_size < 3e6


def test_learning_curves_of_the_agents_that_were_compared(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(results(), tmp_path / "copy"))
    document = json.loads((folder / "results.json").read_text())
    document["config"]["policies"].append({"name": "mine", "path": str(run(tmp_path / "mine", 1.0))})
    (folder / "results.json").write_text(json.dumps(document))
    file, _ = write_report(folder)
    assert "<summary>Learning curves</summary><svg" in file.read_text()


def test_a_training(tmp_path: Path) -> None:
    folder = run(tmp_path / "mine", 1.0)
    (folder / "config.yaml").write_text("env: {id: fake/Corridor-v0}\nseed: 3\ntotal_steps: 100\n")
    file, missing = write_report(folder)
    assert file == folder / "report.html" and missing == ["there is no policy yet (policy.json)"]
    assert "return 60, explored 50.0% after 60 of 100 steps" in file.read_text()


def test_an_empty_folder(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="holds neither results"):
        write_report(tmp_path)
    assert list(tmp_path.iterdir()) == []
