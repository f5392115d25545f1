"""Time stamps of a log: which of them cannot be right, and what to put in their place."""

from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.recorded_log import LogError

CLOCK_SLACK = 1.0
"""How far back the clock may jump from one reading to the next [s]. Clocks of real logs stutter (Intel's goes back by
up to 0.9 s, 629 times); more than this is a wrong stamp."""
_MOST_WRONG = 0.1
"""With a larger share of wrong stamps it is not known which are the right ones."""
_LONG_PAUSE = 3600.0
"""A few readings farther than this from all others, at the beginning or the end, have wrong stamps [s]."""
READING_PERIOD = 0.1
"""Seconds between two readings whose stamps are ignored."""


def mended_times(times: NDArray[np.float64], name: str) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Put stamps that cannot be right between those of their neighbours.

    A stamp that is not after 0 was never set. Of the others the longest run that goes forward is believed, and
    whatever is within ``CLOCK_SLACK`` of it.

    Args:
        times: (R,) as they were stored, in the order of the log [s]; NaN where one could not be read.
        name: What messages call the log.

    Returns:
        The stamps (R,), those that were right as they were, and sentences on what was mended.

    Raises:
        LogError: Too many are wrong.
    """
    stamped = np.isfinite(times) & (times > 0.0)
    if not stamped.any():
        if np.all(np.diff(times) >= 0.0) and np.any(times < 0.0):
            return times, ()
        return numbered_times(len(times)), ("no reading has a usable time stamp; they are numbered instead",)
    right = stamped.copy()
    right[stamped] = _forward(times[stamped])
    right[right] = _of_one_day(times[right])
    wrong, unset = int(np.sum(stamped & ~right)), int(np.sum(~stamped))
    if wrong > max(_MOST_WRONG * np.sum(stamped), 1):
        first = int(np.flatnonzero(stamped & ~right)[0])
        raise LogError(
            f"{name} has {wrong:,} of {len(times):,} time stamps that do not run forwards, the first of them "
            f"{times[first]:.3f} s at reading {first + 1}; mend the log, or go by its order alone (--ignore-times)"
        )
    mended = _between_right_ones(times, right)
    notes = []
    if unset:
        notes.append(f"{unset:,} readings have no time stamp; they got times between their neighbours'")
    if wrong:
        first = int(np.flatnonzero(stamped & ~right)[0])
        notes.append(
            f"{wrong:,} wrong time stamps were set aside, the first of them {times[first]:.3f} s at reading {first + 1}"
        )
    return mended, tuple(notes)


def _between_right_ones(times: NDArray[np.float64], right: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The stamps (R,), those that are not ``right`` evenly between those around them or on from the outermost."""
    every = np.arange(len(times))
    first, last = every[right][[0, -1]]
    step = float(times[last] - times[first]) / max(last - first, 1)
    beyond = step * (np.minimum(every - first, 0) + np.maximum(every - last, 0))
    mended: NDArray[np.float64] = np.where(right, times, np.interp(every, every[right], times[right]) + beyond)
    return mended


def _of_one_day(times: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which stamps (n,) of a run belong to most of the others: a clock may have been set right after it began."""
    kept = np.ones(len(times), np.bool_)
    if len(times) < 3:
        return kept
    gaps = np.diff(times)
    after = int(np.argmax(gaps)) + 1
    lasted = float(times[-1] - times[0] - gaps[after - 1])
    few = min(after, len(times) - after) <= max(_MOST_WRONG * len(times), 1)
    if few and gaps[after - 1] > max(_LONG_PAUSE, 10.0 * lasted):
        kept[slice(0, after) if after <= len(times) - after else slice(after, None)] = False
    return kept


def numbered_times(count: int) -> NDArray[np.float64]:
    """Stamps (count,) ``READING_PERIOD`` apart, for a log whose own are of no use [s]."""
    return np.asarray(READING_PERIOD * np.arange(count), np.float64)


def _forward(times: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which stamps (n,) fit the longest run of stamps that does not go back."""
    run = _longest_run(times)
    kept = np.zeros(len(times), np.bool_)
    kept[run] = True
    so_far = np.maximum.accumulate(np.where(kept, times, -np.inf))
    to_come = np.minimum.accumulate(np.where(kept, times, np.inf)[::-1])[::-1]
    fits = (times >= so_far - CLOCK_SLACK) & (times <= to_come + CLOCK_SLACK)
    return np.asarray(kept | fits, np.bool_)


def _longest_run(times: NDArray[np.float64]) -> list[int]:
    """Places of the longest subsequence that does not go back (by patience sorting)."""
    tails: list[float] = []
    ends: list[int] = []
    before = [-1] * len(times)
    for k, time in enumerate(times.tolist()):
        pile = bisect_right(tails, time)
        before[k] = ends[pile - 1] if pile else -1
        if pile == len(tails):
            tails.append(time)
            ends.append(k)
        else:
            tails[pile], ends[pile] = time, k
    run, k = [], ends[-1]
    while k >= 0:
        run.append(k)
        k = before[k]
    return run[::-1]
