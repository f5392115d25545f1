"""The rate of the last minute."""

import pytest

from lidarena.base.recent_rate import RecentRate, clock


def test_the_rate_is_that_of_the_last_minute() -> None:
    rate = RecentRate(1000)
    for second in range(0, 101):
        rate.note(second, second)  # one a second
    for second in range(101, 201):
        rate.note(100 + 3 * (second - 100), second)  # three a second
    assert rate.rate == pytest.approx(3.0) and rate.left == pytest.approx(200.0)


def test_few_slow_reports_are_all_counted() -> None:
    rate = RecentRate(10)
    for number in range(5):
        rate.note(number, 100.0 * number)
    assert rate.rate == pytest.approx(0.01) and rate.left == pytest.approx(600.0)


def test_nothing_is_told_before_anything_is_known() -> None:
    rate = RecentRate(10, least=3.0)
    assert rate.rate is None and rate.left is None
    rate.note(0, 0.0)
    rate.note(1, 2.0)
    assert rate.rate is None
    rate.note(2, 4.0)
    assert rate.rate == 0.5
    standing = RecentRate(10)
    standing.note(3, 0.0)
    standing.note(3, 9.0)
    assert standing.left is None


@pytest.mark.parametrize(("seconds", "text"), [(None, "?"), (0, "0:00"), (65.2, "1:05"), (7265, "2:01:05")])
def test_clock(seconds: float | None, text: str) -> None:
    assert clock(seconds) == text
