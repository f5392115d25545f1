"""The command ``lidarena``: its commands, refusals in one sentence with exit code 2, and what it does not load."""

import subprocess
import sys

import pytest

import lidarena
from lidarena.cli import main


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0 and capsys.readouterr().out == f"lidarena {lidarena.__version__}\n"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["trian", "quick"], "lidarena has no command 'trian'; did you mean 'train'?"),
        (["train", "qick"], "'qick' is neither a file nor a shipped training; did you mean 'quick'?"),
        (["evaluate", "explrers"], "'explrers' is neither a file nor a shipped comparison; did you mean 'explorers'?"),
        (["evaluate", "configs/compare/nowhere.yaml"], "there is no file 'configs/compare/nowhere.yaml'"),
        (["plan", "ofice"], "map 'ofice' is not known; did you mean 'office'?"),
    ],
)
def test_refusals(arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    printed = capsys.readouterr()
    assert sentence in printed.err and printed.err.count("\n") == 1 and printed.out == ""


@pytest.mark.parametrize("arguments", [["train"], ["evaluate"], ["train", "quick", "--config", "a.yaml"], []])
def test_too_little_or_too_much_is_told_with_the_usage(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2 and "usage: lidarena" in capsys.readouterr().err


LIGHT = ["slam", "slam.graph", "slam.rbpf", "slam.logs.mapping", "planning", "temporal", "cli"]


def test_what_needs_no_network_loads_neither_torch_nor_matplotlib() -> None:
    modules = ", ".join(f"lidarena.{name}" for name in LIGHT)
    code = f"import sys, {modules}; print(sorted({{'torch', 'stable_baselines3', 'matplotlib'}} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
