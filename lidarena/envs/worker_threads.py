"""Running compiled kernels on all cores at once.

The kernels release the interpreter lock, so plain threads serve; unlike an OpenMP region they may be started in a
process that was forked, they compile in half the time, and a batch of one calls its kernel directly. (Asking numba for
its number of threads would start OpenMP and, with it, undo the number of threads that PyTorch was given.)

Each thread calls the kernel once, and the kernel itself takes world after world from a counter that all share
(``kernels.take_next``): handing out ranges in Python costs more in waiting for the interpreter lock than it gains.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any, cast

from numba import config

from lidarena.base.errors import ConfigError

_threads = int(cast(Any, config).NUMBA_NUM_THREADS)  # numba sets its attributes at run time


def set_num_threads(count: int) -> None:
    """Set how many threads step a batch's worlds: at first all cores, or ``NUMBA_NUM_THREADS``; results stay the same.

    Raises:
        ConfigError: ``count`` is not a whole number of at least 1.
    """
    global _threads
    if not isinstance(count, int) or count < 1:
        raise ConfigError(f"num_threads = {count!r} must be a whole number of at least 1")
    _threads = count


def on_threads(most: int, work: Callable[[int], None]) -> None:
    """Call ``work(0)``, ``work(1)`` … at once, on ``set_num_threads``'s threads but at most ``most``."""
    threads = min(_threads, most)
    if threads <= 1:
        work(0)
        return
    executor = _executor(os.getpid(), threads - 1)  # the calling thread works along
    helpers = [executor.submit(work, k) for k in range(1, threads)]
    try:
        work(0)
    finally:
        for helper in helpers:
            helper.result()


@lru_cache(maxsize=4)
def _executor(process: int, helpers: int) -> ThreadPoolExecutor:
    """One pool a process: threads do not survive a fork."""
    return ThreadPoolExecutor(helpers, thread_name_prefix=f"lidarena-{process}")
