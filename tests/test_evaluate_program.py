"""The command line: from a file to a folder, and refusals with exit code 2."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

import evaluate
from lidarena.evaluation.results import RESULTS_FILE

ROOT = Path(__file__).parents[1]
HERE = "tests.evaluation.fake_world"
CONTENT = {
    "envs": [{"id": f"{HERE}:fake/Corridor-v0", "name": "Corridor"}],
    "policies": [{"name": f"{HERE}:Driver", "label": "driver"}, {"name": f"{HERE}:Crasher", "label": "crasher"}],
    "episodes": 2,
    "workers": 1,
}


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "comparison.yaml"
    path.write_text(yaml.safe_dump({**CONTENT, "out": str(tmp_path / "results")}))
    return str(path)


def test_a_comparison_from_start_to_end(file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "elsewhere"
    assert evaluate.main(["--config", file, "--out", str(out), "--set", "episodes=3", "videos=gif"]) == 0
    printed = capsys.readouterr()
    assert "Corridor · 3 episodes each" in printed.out and "Explored" in printed.out
    assert f"pictures: {out}/pictures/plane.png and 4 more there" in printed.out
    assert f"videos:   {out}/videos/Corridor/crasher.gif and 1 more there" in printed.out
    assert f"report:   {out}/report.html" in printed.out
    assert "6/6 episodes" in printed.err
    assert {path.name for path in out.iterdir()} == {
        RESULTS_FILE,
        "front.json",
        "table.csv",
        "table.md",
        "table.tex",
        "pictures",
        "replays",
        "report.html",
        "videos",
    }
    document = json.loads((out / RESULTS_FILE).read_text())
    assert [(row["policy"], row["episodes"]) for row in document["rows"]] == [("driver", 3), ("crasher", 3)]
    assert document["config"]["episodes"] == 3 and document["config"]["out"] == str(out)
    assert not (tmp_path / "results").exists()


def test_a_second_comparison_keeps_the_first(file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--config", file, "--set", "pictures=false", "episodes=1"]
    assert evaluate.main(arguments) == evaluate.main(arguments) == 0
    assert f"the results that stood there are now in {tmp_path / 'results.1'}" in capsys.readouterr().out
    first, second = (json.loads((tmp_path / name / RESULTS_FILE).read_text()) for name in ("results.1", "results"))
    assert first["config"] == second["config"]
    for row in (*first["rows"], *second["rows"]):
        del row["metrics"]["decision_time"]  # the clock is the one thing that no seed fixes
    assert first == second


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--set", "episodes=0"], "'episodes' is 0"),
        (["--set", "policis=[]"], "did you mean 'policies'"),
        (["--set", "policies=[randon]"], "there is no policy 'randon'; did you mean 'random'"),
        (["--set", "policies=[{name: mine, path: runs/gone}]"], "there is no 'runs/gone'"),
        (["--set", f"envs=['{HERE}:fake/Coridor-v0']"], "did you mean 'fake/Corridor-v0'"),
        (["--set", "envs.0.keywords={slipp: 1}"], "did you mean 'slip'"),
        (["--out", str(ROOT)], "is a folder without results.json"),
        (["--out", "evaluate.py/deeper/results"], "'evaluate.py/deeper/results' cannot be written: "),
    ],
)
def test_refusals(file: str, arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert evaluate.main(["--config", file, *arguments]) == 2
    printed = capsys.readouterr()
    assert sentence in printed.err and "Traceback" not in printed.err
    assert printed.out == ""


def test_a_missing_file_is_refused_by_the_program_itself() -> None:
    command = [sys.executable, "evaluate.py", "--config", "configs/compare/qick.yaml"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1 and "did you mean 'quick.yaml'" in done.stderr


def test_a_failure_names_the_episode_and_writes_nothing(
    file: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    policies = f"policies=[{{name: '{HERE}:Driver', label: lost, options: {{fail_at: 33}}}}]"
    assert evaluate.main(["--config", file, "--set", policies]) == 1
    printed = capsys.readouterr().err
    assert "environment 'Corridor', policy 'lost', seed 0: ZeroDivisionError: the driver lost its way\n" in printed
    assert [path.name for path in tmp_path.iterdir()] == ["comparison.yaml"]


def test_ctrl_c_ends_quietly(file: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("lidarena.evaluation.comparison.compare", interrupted)
    assert evaluate.main(["--config", file]) == 130
    assert capsys.readouterr().err == "interrupted; no results were written\n"


def test_a_full_disk_is_told_in_one_sentence(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("lidarena.evaluation.comparison.write_results", full)
    assert evaluate.main(["--config", file, "--set", "pictures=false", "episodes=1"]) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert last == f"'{tmp_path / 'results'}' cannot be written: No space left on device"
    assert [path.name for path in tmp_path.iterdir()] == ["comparison.yaml"]


def test_a_terminal_that_knows_ascii_only_gets_the_table(file: str, tmp_path: Path) -> None:
    command = [sys.executable, "-W", "error", "evaluate.py", "--config", file, "--set", "episodes=1", "pictures=false"]
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.isascii() and "Corridor - 1 episode each" in done.stdout and "D-optimality" in done.stdout
    assert "tables:" in done.stdout and (tmp_path / "results" / RESULTS_FILE).is_file()
