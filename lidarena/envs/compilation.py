"""Telling the user why the very first step takes its time: the kernels are compiled once, then cached."""

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_PATIENCE = 2.5
"""Seconds of silence; loading compiled kernels from the cache takes less."""


@contextmanager
def announced_compilation() -> Iterator[None]:
    """Print one line to standard error if what happens inside takes longer than loading compiled kernels would."""
    timer = threading.Timer(_PATIENCE, _announce)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _announce() -> None:
    print("lidarena: compiling kernels; this happens once after installation and takes up to a minute", file=sys.stderr)
