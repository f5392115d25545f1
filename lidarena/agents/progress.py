"""How far the training is: a bar in a terminal, a line every few seconds elsewhere."""

import sys
import time
from typing import Protocol, TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TextColumn, TimeRemainingColumn
from rich.text import Text

LINE_EVERY = 5.0
"""Seconds between two lines where there is no terminal."""


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
    """A plain line every `LINE_EVERY` seconds, for log files."""

    def __init__(self, total: int, start: int, stream: TextIO) -> None:
        self._total, self._start, self._stream = total, start, stream
        self._began = self._last = time.perf_counter()
        self._step = start
        self._shown: int | None = None
        self._summary = ""

    def update(self, step: int, summary: str = "") -> None:
        """Print a line if the last one is old enough."""
        self._step, self._summary = step, summary or self._summary
        if time.perf_counter() - self._last >= LINE_EVERY:
            self._print()

    def close(self) -> None:
        """Print the last line."""
        if self._shown != self._step:
            self._print()

    def _print(self) -> None:
        self._last = time.perf_counter()
        self._shown = self._step
        rate = (self._step - self._start) / max(self._last - self._began, 1e-9)
        left = _clock(max(self._total - self._step, 0) / rate) if rate > 0 else "?"
        share = f"{min(self._step / self._total, 1):.0%}"
        parts = [f"{self._step:,} of {self._total:,} steps ({share})", f"{rate:,.0f} steps/s", f"{left} left"]
        print("  ".join([*parts, self._summary]).rstrip(), file=self._stream, flush=True)


class Bar:
    """A bar with rate and remaining time."""

    def __init__(self, total: int, start: int, stream: TextIO) -> None:
        self._progress = Progress(
            TextColumn("training"),
            BarColumn(),
            MofNCompleteColumn(),
            _Rate(),
            TimeRemainingColumn(),
            TextColumn("{task.fields[summary]}"),
            console=Console(file=stream),
        )
        self._progress.start()
        self._total = total
        self._task = self._progress.add_task("training", total=total, completed=start, summary="")

    def update(self, step: int, summary: str = "") -> None:
        """Move the bar."""
        if summary:
            self._progress.update(self._task, summary=summary)
        self._progress.update(self._task, completed=min(step, self._total))

    def close(self) -> None:
        """Stop drawing; the last state stays on the screen."""
        self._progress.stop()


class _Rate(ProgressColumn):
    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text(f"{speed:,.0f} steps/s" if speed else "", style="progress.data.speed")


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
