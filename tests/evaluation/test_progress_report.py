"""A bar on a terminal, a few lines elsewhere."""

import io

import pytest
from rich.console import Console

from lidarena.evaluation import progress_report
from lidarena.evaluation.progress_report import report_progress


def test_lines_where_there_is_no_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter(range(0, 1000, 4))  # four seconds an episode
    monkeypatch.setattr(progress_report, "perf_counter", lambda: next(clock))
    stream = io.StringIO()
    with report_progress(8, Console(file=stream, width=40)) as advance:
        for number in range(8):
            advance(f"episode [{number}]")
    lines = stream.getvalue().splitlines()
    assert lines == [
        "3/8 episodes, 0:20 left (last: episode [2])",
        "6/8 episodes, 0:08 left (last: episode [5])",
        "8/8 episodes, 0:00 left (last: episode [7])",
    ]


def test_a_bar_on_a_terminal() -> None:
    stream = io.StringIO()
    console = Console(file=stream, force_terminal=True, width=140)
    with report_progress(2, console) as advance:
        advance("first")
        advance("second")
    assert "2/2" in stream.getvalue() and "second" in stream.getvalue()


def test_a_quiet_console_stays_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    with report_progress(1, Console(quiet=True)) as advance:
        advance("only")
    assert capsys.readouterr() == ("", "")
