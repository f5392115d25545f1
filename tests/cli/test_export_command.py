"""``lidarena export``: a shipped agent by its name, checked against itself; refusals in one sentence."""

from pathlib import Path

import pytest

from lidarena.cli import main
from tests.cli.refusals import assert_refused


def test_a_shipped_agent(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("onnxruntime", reason="needs lidarena[onnx]")
    pytest.importorskip("onnxscript", reason="needs lidarena[onnx]")
    assert main(["export", "arena", "--onnx", str(tmp_path / "arena.onnx")]) == 0
    printed = capsys.readouterr().out
    assert "100 of 100 random observations give the agent's own action" in printed
    assert (tmp_path / "arena.onnx").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["arna", "--onnx", "a.onnx"], "no agent 'arna' is shipped; did you mean 'arena'?"),
        (["runs/nowhere", "--onnx", "a.onnx"], "there is no 'runs/nowhere'"),
        (["arena", "--onnx", "file.txt/a.onnx"], "cannot be written"),
    ],
)
@pytest.mark.usefixtures("folder_with_a_file")
def test_refusals(arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert_refused(["export", *arguments], sentence, capsys)
