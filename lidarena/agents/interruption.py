"""Stopping a training from the keyboard without losing it."""

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class TrainingStopped(KeyboardInterrupt):
    """The training was stopped; what it says tells where it stands and how to go on.

    Args:
        folder: Run folder.
        step: At which the training was stopped.
        resumable_from: Step of the last checkpoint; None if there is none.

    Attributes:
        folder: Run folder.
        step: At which the training was stopped.
    """

    def __init__(self, folder: Path, step: int, resumable_from: int | None) -> None:
        self.folder, self.step = folder, step
        if resumable_from is None:
            rest = "it had no checkpoint yet"
        else:
            rest = f"to go on from step {resumable_from:,}: lidarena train --resume {folder}"
        super().__init__(f"stopped at step {step:,}; what was trained is in {folder}; {rest}")


class StopRequest:
    """Whether somebody has asked the training to stop.

    Attributes:
        requested: Set by the first signal; the training looks at it between two updates.
    """

    def __init__(self) -> None:
        self.requested = False


@contextmanager
def stop_on_signal() -> Iterator[StopRequest]:
    """Turn the first Ctrl-C (or SIGTERM) into a request, and the second one into a ``KeyboardInterrupt``.

    That holds whatever they did before: a shell starts programs in the background with Ctrl-C ignored. A third one acts
    as usual. Outside the main thread, where Python delivers no signals, nothing is changed.
    """
    request = StopRequest()
    if threading.current_thread() is not threading.main_thread():
        yield request
        return
    before = {number: signal.getsignal(number) for number in _SIGNALS}

    def restore() -> None:
        for number, handler in before.items():
            signal.signal(number, handler)

    def ask(number: int, frame: FrameType | None) -> None:
        if request.requested:
            restore()
            raise KeyboardInterrupt
        request.requested = True
        print("\nStopping after this update; once more to stop at once.", file=sys.stderr, flush=True)

    for number in _SIGNALS:
        signal.signal(number, ask)
    try:
        yield request
    finally:
        restore()
