"""Running compiled kernels on disjoint ranges of worlds at once.

The kernels release the interpreter lock, so plain threads serve; unlike an OpenMP region they may be started in a
process that was forked, they compile in half the time, and a batch of one calls its kernel directly. (Asking numba for
its number of threads would start OpenMP and, with it, undo the number of threads that PyTorch was given.)

The calling thread works along: with as many helpers as cores and a caller that only waits, the threads drive each other
from core to core, and stepping took 1.6 times as long.
"""

import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from itertools import pairwise
from typing import Any, cast

from numba import config

from lidarena.world.refusals import ConfigError

_CHUNKS_PER_THREAD = 8
"""Worlds differ in cost; smaller ranges keep the threads busy to the end."""
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


def for_ranges(count: int, work: Callable[[int, int], None]) -> None:
    """Call ``work(first, last)`` for ranges that together cover 0 … count - 1, on ``set_num_threads``'s threads."""
    threads = min(_threads, count)
    if threads <= 1:
        work(0, count)
        return
    chunks = min(threads * _CHUNKS_PER_THREAD, count)
    borders = [count * k // chunks for k in range(chunks + 1)]
    waiting = deque(pairwise(borders))
    executor = _executor(os.getpid(), threads - 1)
    helpers = [executor.submit(_work_off, waiting, work) for _ in range(threads - 1)]
    try:
        _work_off(waiting, work)
    finally:
        waiting.clear()  # after an error nobody begins anything more
        for helper in helpers:
            helper.result()


def _work_off(waiting: deque[tuple[int, int]], work: Callable[[int, int], None]) -> None:
    """Take ranges and work on them until there are none left."""
    while True:
        try:
            first, last = waiting.popleft()
        except IndexError:
            return
        work(first, last)


@lru_cache(maxsize=4)
def _executor(process: int, helpers: int) -> ThreadPoolExecutor:
    """One pool a process: threads do not survive a fork."""
    return ThreadPoolExecutor(helpers, thread_name_prefix=f"lidarena-{process}")
