"""``lidarena report`` of an evaluation, of a trained agent whose episode can be played, and of nothing."""

from pathlib import Path

import pytest

from lidarena.cli import main
from tests.evaluation.report.folders import results


def test_of_an_evaluation(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", str(results()), "--out", str(tmp_path / "a.html")]) == 0
    assert capsys.readouterr().out == f"report:   {tmp_path / 'a.html'}\n"
    assert "driver is best" in (tmp_path / "a.html").read_text()


def test_of_a_training_with_an_episode_of_its_agent(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "arena.yaml"
    file.write_text(
        "env: {id: lidarena/Arena-v0, keywords: {action: discrete}}\nseed: 0\ntotal_steps: 64\nnum_envs: 2\n"
        f"checkpoint_every: 64\nppo: {{n_steps: 16, batch_size: 32, n_epochs: 1}}\nout: {tmp_path / 'run'}\n"
    )
    assert main(["train", str(file)]) == 0
    capsys.readouterr()
    assert main(["report", str(tmp_path / "run")]) == 0
    assert capsys.readouterr().out == f"report:   {tmp_path / 'run'}/report.html\n"
    text = (tmp_path / "run" / "report.html").read_text()
    assert "PPO in lidarena/Arena-v0" in text and 'id="player"' in text and "<svg" in text


@pytest.mark.parametrize("folder", ["nowhere", "."])
def test_of_nothing(
    folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["report", folder]) == 2
    assert capsys.readouterr().err.count("\n") == 1
