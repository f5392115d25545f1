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
        "102,400 of 100,000 steps (100%)  1,026 steps/s  0:00 left  return 3.0"
    ]


def test_the_rate_of_a_resumed_training_leaves_out_what_was_done_before(clock: list[float]) -> None:
    stream = io.StringIO()
    lines = show_progress(20_000_000, start=6_000_000, stream=stream)
    lines.update(6_000_500)
    clock[0] = 10
    lines.update(6_010_500)
    assert stream.getvalue() == "6,010,500 of 20,000,000 steps (30%)  1,000 steps/s  3:53:10 left\n"


def test_compiling_and_a_slow_beginning_are_forgotten(clock: list[float]) -> None:
    stream = io.StringIO()
    lines = show_progress(1_000_000, stream=stream)
    clock[0] = 40.0  # the first step, which compiles
    lines.update(64)
    assert stream.getvalue() == "64 of 1,000,000 steps (0%)\n"
    for second in range(41, 141):
        clock[0] = float(second)
        lines.update((second - 40) * 100 if second <= 60 else 2_000 + (second - 60) * 5_000)
    assert stream.getvalue().splitlines()[-1] == "402,000 of 1,000,000 steps (40%)  5,000 steps/s  2:00 left"


def test_a_display_that_ends_before_the_first_step(clock: list[float]) -> None:
    stream = io.StringIO()
    show_progress(100, stream=stream).close()
    assert stream.getvalue() == "0 of 100 steps (0%)\n"


def test_the_bar_shows_rate_time_and_summary(monkeypatch: pytest.MonkeyPatch, clock: list[float]) -> None:
    monkeypatch.setenv("COLUMNS", "160")
    monkeypatch.setenv("TERM", "xterm")
    stream = Terminal()
    bar = show_progress(1000, stream=stream)
    for step in range(0, 1200, 100):
        clock[0] = step / 100
        bar.update(step, "completeness 42%" if step == 500 else "")
    bar.close()
    text = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", stream.getvalue())
    assert "1000/1000" in text and "completeness 42%" in text and "100 steps/s  0:00 left" in text


def test_silence_is_silent(capsys: pytest.CaptureFixture[str]) -> None:
    silence = show_progress(10, enabled=False)
    silence.update(5, "x")
    silence.close()
    assert capsys.readouterr() == ("", "")
