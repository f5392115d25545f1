import subprocess
import sys
from pathlib import Path

import pytest
import yaml

import train as program
from lidarena import agents
from lidarena.agents import load
from tests.agents.training_cases import SMALL, press_ctrl_c

ROOT = Path(__file__).parents[1]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "small.yaml"
    path.write_text(yaml.safe_dump({**SMALL, "total_steps": 128, "out": str(tmp_path / "run")}))
    return path


def test_train_and_go_on(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "mine"
    assert program.main(["--config", str(file), "--set", "total_steps=192", "seed=3", "--out", str(out)]) == 0
    output = capsys.readouterr().out
    assert "192 steps of 4 worlds, seed 3" in output and "16 steps × 4 worlds" in output
    assert all(f"{out}/{name}" in output for name in ("policy.safetensors", "progress.csv"))
    assert program.main(["--resume", str(out), "--set", "total_steps=256"]) == 0
    assert f"run:      {out}, from step 192" in capsys.readouterr().out
    assert load(out).training["steps"] == 256
    assert program.main(["--resume", str(out)]) == 0
    assert "already has its 256 steps" in capsys.readouterr().out
    assert program.main(["--config", str(file), "--set", "total_steps=320", "seed=3", "--resume", str(out)]) == 0


def test_a_run_folder_that_is_taken(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert program.main(["--config", str(file), "--set", "total_steps=64"]) == 0
    assert program.main(["--config", str(file), "--set", "total_steps=64"]) == 0
    assert f"run:      {tmp_path}/run-2" in capsys.readouterr().out
    assert program.main(["--config", str(file), "--out", str(tmp_path / "run")]) == 2
    assert "already holds files" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--config", "nowhere.yaml"], "there is no file 'nowhere.yaml'"),
        (["--config", "FILE", "--set", "ppo.n_step=3"], "did you mean 'n_steps'?"),
        (["--config", "FILE", "--set", "ppo.batch_size=33"], "should divide"),
        (["--config", "FILE", "--set", "seed"], "key=value"),
        (["--config", "FILE", "--set", "env.id=lidarena/Nowhere-v0"], "there is no environment 'lidarena/Nowhere-v0'"),
        (["--config", "FILE", "--set", "env.keywords={rewrd: 1}"], "did you mean 'reward'?"),
        (["--resume", "nowhere"], "nowhere"),
        (["--config", "FILE", "--resume", "nowhere"], "no run folder 'nowhere'"),
    ],
)
def test_refusals_are_one_sentence_and_exit_code_2(
    file: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    assert program.main([str(file) if argument == "FILE" else argument for argument in arguments]) == 2
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1


@pytest.mark.parametrize("arguments", [[], ["--config", "a", "--confg", "b"], ["--resume", "a", "--out", "b"]])
def test_wrong_options_end_with_2(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        program.main(arguments)
    assert end.value.code == 2 and "usage:" in capsys.readouterr().err


def test_ctrl_c(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    press_ctrl_c(monkeypatch, at_step=30)
    assert program.main(["--config", str(file)]) == 130
    assert f"lidarena train --resume {tmp_path}/run" in capsys.readouterr().err


def test_ctrl_c_before_the_training_begins(
    file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(agents, "train", interrupt, raising=False)
    assert program.main(["--config", str(file)]) == 130
    assert "nothing was written" in capsys.readouterr().err


def test_trouble_with_the_disk(file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("lidarena.agents.checkpoint.write_folder", full)
    assert program.main(["--config", str(file)]) == 2
    assert "cannot be written: No space left on device" in capsys.readouterr().err


def test_the_program_itself(tmp_path: Path) -> None:
    wrong = subprocess.run(
        [sys.executable, "train.py", "--config", str(tmp_path / "nowhere.yaml")],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert wrong.returncode == 2 and wrong.stdout == "" and "Traceback" not in wrong.stderr
    asked = subprocess.run([sys.executable, "train.py", "--help"], cwd=ROOT, capture_output=True, text=True)
    assert asked.returncode == 0 and "--resume" in asked.stdout
