"""What a terminal cannot print is printed as something like it."""

import io
import os
import subprocess
import sys

import pytest

from lidarena.base.errors import ConfigError
from lidarena.base.terminal import exit_status, make_output_printable


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("3 × 4 − 1…", "3 x 4 - 1..."),
        ("Zürich 10⁻³ ↓", "Zurich 10^-3 v"),
        ("✓", "?"),
        ("\udcff", "?"),
        ("plain", "plain"),
    ],
)
def test_ascii_gets_something_like_it(text: str, printed: str, monkeypatch: pytest.MonkeyPatch) -> None:
    bytes_ = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(bytes_, encoding="ascii", errors="strict"))
    make_output_printable()
    print(text, end="", flush=True)
    assert bytes_.getvalue().decode("ascii") == printed


def test_what_utf_8_can_print_it_prints(monkeypatch: pytest.MonkeyPatch) -> None:
    bytes_ = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(bytes_, encoding="utf-8"))
    make_output_printable()
    print("3 × 4 ↑ \udcff", end="", flush=True)
    assert bytes_.getvalue().decode() == "3 × 4 ↑ ?"


def test_output_that_is_no_text_stream_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    make_output_printable()


def test_a_table_of_rich_is_printed_in_ascii() -> None:
    code = """
from rich.console import Console
from rich.table import Table
from lidarena.base.terminal import make_output_printable
make_output_printable()
table = Table("a × b ↑", title="−1")
table.add_row("ü")
Console().print(table)
"""
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert "a x b ^" in done.stdout and "-1" in done.stdout and done.stdout.isascii()


@pytest.mark.parametrize(
    ("stopped_by", "status", "told"),
    [
        (None, 0, ""),
        (ConfigError("seed is 'abc'"), 2, "seed is 'abc'\n"),
        (KeyboardInterrupt(), 130, "interrupted; nothing was written\n"),
    ],
)
def test_a_program_returns_what_stopped_it(
    stopped_by: BaseException | None, status: int, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def work() -> None:
        if stopped_by is not None:
            raise stopped_by

    assert exit_status(work) == status
    assert capsys.readouterr().err == told


def test_a_fault_of_the_program_itself_is_not_hidden() -> None:
    with pytest.raises(ZeroDivisionError):
        exit_status(lambda: 1 // 0)
