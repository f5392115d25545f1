"""Wrong time stamps are set aside, stutters are believed, and a log whose clock means nothing is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.slam.logs.clocks import mended_times, numbered_times
from lidarena.slam.logs.recorded_log import LogError

TIMES = 1e9 + 0.2 * np.arange(755)


@given(st.integers(2, 752), st.sampled_from([1.0, 5e8, 9.99e8, 1e9 - 7.0, 1.3e9, 1e12]))
def test_one_wrong_stamp_is_set_aside(place: int, stamp: float) -> None:
    times = TIMES.copy()
    times[place] = stamp
    mended, notes = mended_times(times, "log 'a'")
    np.testing.assert_allclose(mended, TIMES, atol=1e-6)
    assert notes == (f"1 wrong time stamps were set aside, the first of them {stamp:.3f} s at reading {place + 1}",)


def test_stamps_that_were_never_set_get_times_between() -> None:
    times = TIMES.copy()
    times[::2] = 0.0
    mended, notes = mended_times(times, "log 'a'")
    np.testing.assert_allclose(mended[1:-1], TIMES[1:-1], atol=1e-6)
    assert notes[0].startswith("378 readings have no time stamp")


def test_a_clock_that_stutters_or_stands_is_believed() -> None:
    times = TIMES.copy()
    times[5::7] -= 0.9
    times[300:320] = times[300]
    times[320:] = np.maximum(times[320:], times[300])
    mended, notes = mended_times(times, "log 'a'")
    np.testing.assert_array_equal(mended, times)
    assert not notes


def test_a_log_without_any_stamp_is_numbered() -> None:
    mended, notes = mended_times(np.zeros(4), "log 'a'")
    np.testing.assert_array_equal(mended, numbered_times(4))
    assert len(notes) == 1


def test_a_clock_that_means_nothing_is_refused() -> None:
    with pytest.raises(LogError, match=r"time stamps that do not run forwards.*\(--ignore-times\)"):
        mended_times(np.random.default_rng(0).permutation(TIMES), "log 'a'")


@pytest.mark.parametrize(("wrong", "by"), [(slice(0, 1), -1e6), (slice(0, 3), -1.1e9), (slice(58, 60), 1e7)])
def test_a_clock_that_was_set_right_on_the_way_is_noticed(wrong: slice, by: float) -> None:
    true = 1.2e9 + 0.2 * np.arange(60)
    times = true.copy()
    times[wrong] += by
    mended, notes = mended_times(times, "log")
    np.testing.assert_allclose(mended, true, atol=1e-5)
    assert "wrong time stamps were set aside" in notes[0]


def test_a_pause_for_lunch_is_none() -> None:
    times = 1.2e9 + 0.2 * np.arange(60)
    times[30:] += 5000.0
    mended, notes = mended_times(times, "log")
    np.testing.assert_array_equal(mended, times)
    assert notes == ()


def test_stamps_before_the_epoch_that_run_backwards_are_of_no_use() -> None:
    mended, notes = mended_times(-1.2e9 - 0.2 * np.arange(60), "log")
    assert (np.diff(mended) > 0.0).all() and "numbered" in notes[0]
    times = -50.0 + 0.2 * np.arange(60)
    np.testing.assert_array_equal(mended_times(times, "log")[0], times)
