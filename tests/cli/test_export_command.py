"""``lidarena export``: a shipped agent by its name, checked against itself; refusals in one sentence."""

from pathlib import Path

import pytest

from lidarena.cli import main


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
def test_refusals(
    arguments: list[str],
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file.txt").touch()
    assert main(["export", *arguments]) == 2
    printed = capsys.readouterr()
    assert sentence in printed.err and printed.err.count("\n") == 1
