"""Telling the user why the very first step takes its time, and what is compiled: once, then it is cached."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import event as numba_event

_PATIENCE = 2.5
"""Seconds of compiling in silence; what takes no longer needs no words."""
_told = False
_events: Any = numba_event  # its functions have no types


@contextmanager
def announced_compilation() -> Iterator[None]:
    """Print one line to standard error, once a process, if what happens inside compiles for a while.

    The line names the module whose kernel is being compiled; loading compiled kernels says nothing.
    """
    watch = _Watch()
    _events.register("numba:compile", watch)
    try:
        yield
    finally:
        _events.unregister("numba:compile", watch)
        watch.stop()


def keep_quiet() -> None:
    """Announce nothing in this process: the one that started it has done so."""
    global _told
    _told = True


class _Watch(numba_event.Listener):
    """Hears what numba compiles, outermost first."""

    def __init__(self) -> None:
        self._under_way: list[str] = []
        self._timer: threading.Timer | None = None

    def on_start(self, event: numba_event.Event) -> None:
        """A function begins to be compiled."""
        self._under_way.append(event.data["dispatcher"].py_func.__module__)
        if self._timer is None:
            self._timer = threading.Timer(_PATIENCE, self._tell)
            self._timer.daemon = True
            self._timer.start()

    def on_end(self, event: numba_event.Event) -> None:
        """It is compiled."""
        if self._under_way:
            self._under_way.pop()

    def stop(self) -> None:
        """Tell nothing any more."""
        if self._timer is not None:
            self._timer.cancel()

    def _tell(self) -> None:
        global _told
        if _told:
            return
        _told = True
        modules: Any = self._under_way or ["its kernels"]
        words = "this happens once after installation and takes a minute or two"
        print(f"lidarena: compiling {modules[0]} and what it calls; {words}", file=sys.stderr, flush=True)
