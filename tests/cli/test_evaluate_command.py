"""``lidarena evaluate`` and ``evaluate.py`` do the same, from a shipped configuration too."""

import json
from pathlib import Path

import pytest

import evaluate
from lidarena.cli import evaluate_command, main


def test_evaluate_py_is_the_command() -> None:
    assert evaluate.main is evaluate_command.main


def test_a_shipped_comparison_by_its_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    small = ["episodes=1", "keywords.max_episode_steps=20", "workers=1", "pictures=false", "policies=[frontier]"]
    assert main(["evaluate", "quick", "--set", *small, "--out", str(tmp_path / "out")]) == 0
    rows = json.loads((tmp_path / "out" / "results.json").read_text())["rows"]
    assert [row["env"] for row in rows] == ["Env-2", "Willow lobby"]
    assert f"{tmp_path / 'out'}/table.md" in capsys.readouterr().out


def test_ctrl_c(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("lidarena.evaluation.comparison.compare", interrupted)
    assert main(["evaluate", "quick"]) == 130
    assert capsys.readouterr().err == "interrupted; no results were written\n"
