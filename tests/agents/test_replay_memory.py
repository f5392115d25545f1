from pathlib import Path

import pytest

from lidarena.agents import load, train
from lidarena.base.errors import ConfigError
from tests.agents.learner_cases import small


def test_a_memory_that_is_too_large_is_left_out_and_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("lidarena.agents.replay_memory.LARGEST", 100)
    folder = train(small(tmp_path / "run", "SAC"), progress=False)
    assert not list(folder.rglob("memory.npz"))
    train(small(folder, "SAC", "total_steps=320"), resume=folder)
    assert "lost:     the memory of transitions" in capsys.readouterr().out
    assert load(folder).training["steps"] == 320


def test_a_memory_that_went_missing_is_refused(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", "SAC"), progress=False)
    next(folder.rglob("memory.npz")).unlink()
    with pytest.raises(ConfigError, match=r"lacks memory\.npz"):
        train(small(folder, "SAC", "total_steps=320"), resume=folder, progress=False)
