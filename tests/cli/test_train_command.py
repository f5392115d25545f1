"""``lidarena train`` and ``train.py`` do the same; a shipped configuration is trained by its name."""

from pathlib import Path

import pytest

import train as program
from lidarena.agents import load
from lidarena.cli import main, train_command

SMALL = ["--set", "total_steps=32", "num_envs=2", "ppo.n_steps=8", "ppo.batch_size=16", "ppo.n_epochs=1"]


def test_train_py_is_the_command() -> None:
    assert program.main is train_command.main


def test_a_shipped_configuration_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["train", "quick", *SMALL, "checkpoint_every=32"]) == 0
    assert "lidarena train --resume runs/quick" in capsys.readouterr().out
    assert load(tmp_path / "runs" / "quick").training["steps"] == 32
