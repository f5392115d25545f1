"""How far the training is: a bar in a terminal, a line every few seconds elsewhere."""

import sys
import time
from typing import Protocol, TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from lidarena.base.recent_rate import RecentRate, clock

LINE_EVERY = 5.0
"""Seconds between two lines where there is no terminal."""
_KNOWN_AFTER = 3.0
"""Seconds after the first step, which compiles, before a rate is told."""


class ProgressDisplay(Protocol):
    """What the training tells about itself while it runs."""

    def update(self, step: int, summary: str = "") -> None:
        """Show the step; ``summary`` (kept until the next one) says how good the agent is by now."""

    def close(self) -> None:
        """Leave the display as it is and give the terminal back."""


def show_progress(total: int, start: int = 0, enabled: bool = True, stream: TextIO | None = None) -> ProgressDisplay:
    """Choose the display.

    Args:
        total: Steps of the whole training.
        start: Steps done before this start of the program.
        enabled: Nothing is shown if false.
        stream: Where to; standard output if left out.
    """
    stream = stream or sys.stdout
    if not enabled:
        return Silence()
    return Bar(total, start, stream) if stream.isatty() else Lines(total, start, stream)


class Silence:
    """No display."""

    def update(self, step: int, summary: str = "") -> None:
        """Show nothing."""

    def close(self) -> None:
        """Do nothing."""


class Lines:
    """A plain line every `LINE_EVERY` seconds, for log files.

    Args:
        total: Steps of the whole training.
        start: Steps that it has already.
        stream: Where to.
    """

    def __init__(self, total: int, start: int, stream: TextIO) -> None:
        self._total, self._stream = total, stream
        self._rate = RecentRate(total, _KNOWN_AFTER)
        self._last = time.perf_counter()
        self._step = start
        self._shown: int | None = None
        self._summary = ""

    def update(self, step: int, summary: str = "") -> None:
        """Print a line if the last one is old enough."""
        self._step, self._summary = step, summary or self._summary
        now = time.perf_counter()
        self._rate.note(step, now)
        if now - self._last >= LINE_EVERY:
            self._last = now
            self._print()

    def close(self) -> None:
        """Print the last line."""
        if self._shown != self._step:
            self._print()

    def _print(self) -> None:
        self._shown = self._step
        share = f"{min(self._step / self._total, 1):.0%}"
        parts = [f"{self._step:,} of {self._total:,} steps ({share})", *_speed(self._rate), self._summary]
        print("  ".join(part for part in parts if part), file=self._stream, flush=True)


class Bar:
    """A bar with rate and remaining time; its arguments ``total``, ``start`` and ``stream`` are those of `Lines`."""

    def __init__(self, total: int, start: int, stream: TextIO) -> None:
        columns = (TextColumn("{task.fields[speed]}"), TextColumn("{task.fields[summary]}"))
        self._progress = Progress(
            TextColumn("training"), BarColumn(), MofNCompleteColumn(), *columns, console=Console(file=stream)
        )
        self._progress.start()
        self._total, self._rate = total, RecentRate(total, _KNOWN_AFTER)
        self._task = self._progress.add_task("training", total=total, completed=start, summary="", speed="")

    def update(self, step: int, summary: str = "") -> None:
        """Move the bar."""
        self._rate.note(step, time.perf_counter())
        if summary:
            self._progress.update(self._task, summary=summary)
        speed = "  ".join(_speed(self._rate))
        self._progress.update(self._task, completed=min(step, self._total), speed=speed)

    def close(self) -> None:
        """Stop drawing; the last state stays on the screen."""
        self._progress.stop()


def _speed(rate: RecentRate) -> list[str]:
    """Recent rate and remaining time; nothing while they are not known."""
    return [] if rate.rate is None else [f"{rate.rate:,.0f} steps/s", f"{clock(rate.left)} left"]
