"""How far a long run is: a bar on a terminal, a line now and then in a log."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import Protocol

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from lidarena.base.recent_rate import RecentRate, clock

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
    columns = (TextColumn("episodes"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    text = TextColumn("elapsed, {task.fields[left]} left · {task.fields[last]}")
    with Progress(*columns, text, console=console, transient=True) as bar:
        task = bar.add_task("", total=total, left="?", last="")
        rate = _begun(total, perf_counter())

        def advance(what: str) -> None:
            bar.advance(task)
            rate.note(bar.tasks[0].completed, perf_counter())
            bar.update(task, left=clock(rate.left), last=what)

        yield advance


def _begun(total: int, now: float) -> RecentRate:
    rate = RecentRate(total)
    rate.note(0, now)
    return rate


class _Lines:
    def __init__(self, total: int, console: Console) -> None:
        self.total, self.console = total, console
        self.done, self.last = 0, perf_counter()
        self.rate = _begun(total, self.last)

    def __call__(self, what: str) -> None:
        self.done += 1
        now = perf_counter()
        self.rate.note(self.done, now)
        if self.done < self.total and now - self.last < LOG_EVERY:
            return
        self.last = now
        line = f"{self.done}/{self.total} episodes, {clock(self.rate.left)} left (last: {what})"
        self.console.print(line, highlight=False, markup=False, soft_wrap=True)
