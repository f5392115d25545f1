"""Several seeds at once on this machine: the runs of single trainings; refusals leave nothing behind."""

from pathlib import Path

import pytest

from lidarena.agents import load, train, train_seeds
from lidarena.agents.run_folder import config_of
from lidarena.base.errors import ConfigError
from lidarena.cli import main
from tests.agents.training_cases import small


def test_each_run_is_that_of_its_seed_alone(tmp_path: Path) -> None:
    config = small(tmp_path / "runs", "total_steps=64")
    told: list[str] = []
    folders = train_seeds(config, [1, 0], tell=told.append)
    alone = train(config.model_copy(update={"out": str(tmp_path / "alone")}), progress=False)
    assert folders == [tmp_path / "runs" / "seed1", tmp_path / "runs" / "seed0"]
    weights = [(folder / "policy.safetensors").read_bytes() for folder in (*folders, alone)]
    assert weights[1] == weights[2] != weights[0]
    assert sorted(told) == [f"seed {seed}: {tmp_path / 'runs' / f'seed{seed}'}" for seed in (0, 1)]
    assert config_of(folders[0]).out == str(folders[0]) and load(folders[0]).training["steps"] == 64


def test_a_taken_folder_and_odd_seeds_are_refused(tmp_path: Path) -> None:
    config = small(tmp_path / "runs")
    (tmp_path / "runs" / "seed1").mkdir(parents=True)
    (tmp_path / "runs" / "seed1" / "mine").touch()
    with pytest.raises(ConfigError, match="already holds files"):
        train_seeds(config, [1])
    for seeds in ([], [2, 2]):
        with pytest.raises(ConfigError, match="each of them once"):
            train_seeds(config, seeds)


@pytest.mark.parametrize("seeds", ["0..", "a", "1,,2", "-1"])
def test_seeds_that_are_none(seeds: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "quick", f"--seeds={seeds}", "--out", str(tmp_path / "runs")]) == 2
    assert f"--seeds {seeds} is neither a range" in capsys.readouterr().err


def test_options_that_do_not_go_together(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in (["--resume", "runs/x", "--seeds", "0..1"], ["quick", "--engine", "ray"]):
        with pytest.raises(SystemExit) as end:
            main(["train", *arguments])
        assert end.value.code == 2 and "--seeds" in capsys.readouterr().err


def test_an_interruption_says_what_is_kept(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("lidarena.agents.seeds.train_seeds", interrupted)
    assert main(["train", "quick", "--seeds", "0..1"]) == 130
    assert "the seeds named above are trained" in capsys.readouterr().err
