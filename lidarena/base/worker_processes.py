"""Processes that work for this one and end when it does."""

import multiprocessing
import multiprocessing.connection
import os
import shutil
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from lidarena.base.files import unfinished_folders


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on macOS and Windows
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def worker_pool(count: int, prepare: Callable[[], None] | None = None) -> ProcessPoolExecutor:
    """Return a pool of processes that end as soon as this one is gone, even if it was killed.

    If it was, they also remove the folders that it was filling. They are spawned, not forked: torch and numba keep
    threads that a fork would copy in a broken state.

    Args:
        count: Number of processes.
        prepare: Called once in each of them; a function of a module.
    """
    context = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(count, mp_context=context, initializer=_begin, initargs=(prepare, unfinished_folders()))


def _begin(prepare: Callable[[], None] | None, unfinished: tuple[Path, ...]) -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent.sentinel, unfinished), daemon=True).start()
    if prepare is not None:
        prepare()


def _end_with(sentinel: int, unfinished: tuple[Path, ...]) -> None:
    multiprocessing.connection.wait([sentinel])
    for folder in unfinished:
        shutil.rmtree(folder, ignore_errors=True)
    os._exit(1)  # no clean-up: there is nobody to report to, and whatever still runs may hold any lock
