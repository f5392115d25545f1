import io
import re

import pytest

from lidarena.agents import progress
from lidarena.agents.progress import Bar, Lines, Silence, show_progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time in seconds, to be set by the test."""
    now = [0.0]
    monkeypatch.setattr(progress.time, "perf_counter", lambda: now[0])
    return now


def test_the_display_fits_the_stream() -> None:
    assert isinstance(show_progress(10, stream=io.StringIO()), Lines)
    assert isinstance(show_progress(10, enabled=False, stream=Terminal()), Silence)
    bar = show_progress(10, stream=Terminal())
    bar.close()
    assert isinstance(bar, Bar)


def test_a_line_every_five_seconds(clock: list[float]) -> None:
    stream = io.StringIO()
    lines = show_progress(100_000, stream=stream)
    for second in range(1, 23):
        clock[0] = second / 2
        lines.update(second * 500, "return 3.0" if second % 4 == 0 else "")
    assert stream.getvalue().splitlines() == [
        "5,000 of 100,000 steps (5%)  1,000 steps/s  1:35 left  return 3.0",
        "10,000 of 100,000 steps (10%)  1,000 steps/s  1:30 left  return 3.0",
    ]
    clock[0] = 100
    lines.update(102_400)
    lines.close()
    assert stream.getvalue().splitlines()[2:] == [
        "102,400 of 100,000 steps (100%)  1,024 steps/s  0:00 left  return 3.0"
    ]


def test_the_rate_of_a_resumed_training_leaves_out_what_was_done_before(clock: list[float]) -> None:
    stream = io.StringIO()
    lines = show_progress(20_000_000, start=6_000_000, stream=stream)
    clock[0] = 10
    lines.update(6_010_000)
    assert stream.getvalue() == "6,010,000 of 20,000,000 steps (30%)  1,000 steps/s  3:53:10 left\n"


def test_a_display_that_ends_before_the_first_step(clock: list[float]) -> None:
    stream = io.StringIO()
    show_progress(100, stream=stream).close()
    assert stream.getvalue() == "0 of 100 steps (0%)  0 steps/s  ? left\n"


def test_the_bar_shows_rate_time_and_summary(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "160")
    monkeypatch.setenv("TERM", "xterm")
    stream = Terminal()
    bar = show_progress(1000, stream=stream)
    for step in range(0, 1200, 100):
        bar.update(step, "completeness 42%" if step == 500 else "")
    bar.close()
    text = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", stream.getvalue())
    assert "1000/1000" in text and "completeness 42%" in text and re.search(r"[\d,]+ steps/s", text)


def test_silence_is_silent(capsys: pytest.CaptureFixture[str]) -> None:
    silence = show_progress(10, enabled=False)
    silence.update(5, "x")
    silence.close()
    assert capsys.readouterr() == ("", "")
