"""How far a long run is: a bar on a terminal, a line now and then in a log."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

LOG_EVERY = 10.0
"""Seconds between two lines where there is no terminal."""


class Advance(Protocol):
    """Called once for each finished episode."""

    def __call__(self, what: str) -> None:
        """Count one; ``what`` says which episode it was."""


@contextmanager
def report_progress(total: int, console: Console) -> Iterator[Advance]:
    """Report the progress of ``total`` episodes on a console.

    Args:
        total: Number of episodes.
        console: Where to; only a terminal gets a bar.

    Yields:
        A function to call after each episode.
    """
    if not console.is_terminal:
        yield _Lines(total, console)
        return
    columns = (TextColumn("episodes"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"))
    times = (
        TimeElapsedColumn(),
        TextColumn("elapsed,"),
        TimeRemainingColumn(),
        TextColumn("left · {task.fields[last]}"),
    )
    with Progress(*columns, *times, console=console, transient=True) as bar:
        task = bar.add_task("", total=total, rate="", last="")
        begin = perf_counter()

        def advance(what: str) -> None:
            bar.advance(task)
            rate = bar.tasks[0].completed / max(perf_counter() - begin, 1e-9)
            bar.update(task, rate=f"{rate:.2f}/s", last=what)

        yield advance


class _Lines:
    def __init__(self, total: int, console: Console) -> None:
        self.total, self.console = total, console
        self.done, self.begin = 0, perf_counter()
        self.last = self.begin

    def __call__(self, what: str) -> None:
        self.done += 1
        now = perf_counter()
        if self.done < self.total and now - self.last < LOG_EVERY:
            return
        self.last = now
        rate = self.done / max(now - self.begin, 1e-9)
        left = (self.total - self.done) / rate
        line = f"{self.done}/{self.total} episodes, {rate:.2f}/s, {left:.0f} s left (last: {what})"
        self.console.print(line, highlight=False, markup=False, soft_wrap=True)
