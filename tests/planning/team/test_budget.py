import math

import pytest

from lidarena.planning.team import budget as budget_module
from lidarena.planning.team.budget import Budget


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time, to be set."""
    now = [100.0]
    monkeypatch.setattr(budget_module.time, "perf_counter", lambda: now[0])
    return now


def test_iterations_are_used_up_one_by_one() -> None:
    budget = Budget(math.inf, 3)
    assert [budget.take() for _ in range(5)] == [True, True, True, False, False]
    assert not budget.spent() and budget.left() == math.inf


def test_without_a_number_only_time_ends_a_search(clock: list[float]) -> None:
    budget = Budget(2.0)
    assert all(budget.take() for _ in range(1000))
    clock[0] += 2.0
    assert not budget.take()


def test_what_is_left_falls_to_zero_and_no_further(clock: list[float]) -> None:
    budget = Budget(2.0)
    left = []
    for _ in range(5):
        left.append(budget.left())
        assert budget.spent() == (left[-1] == 0.0)
        clock[0] += 0.75
    assert left == [2.0, 1.25, 0.5, 0.0, 0.0]


def test_a_refusal_for_want_of_time_uses_no_iteration(clock: list[float]) -> None:
    budget = Budget(1.0, 1)
    clock[0] += 5.0
    assert not budget.take() and not budget.take()
    clock[0] -= 5.0
    assert budget.take() and not budget.take()


def test_nothing_is_allowed_by_nothing() -> None:
    assert not Budget(math.inf, 0).take()
    assert Budget(0.0).spent() and not Budget(0.0).take()


def test_a_part_takes_its_iterations_from_the_whole_and_has_limits_of_its_own() -> None:
    whole = Budget(float("inf"), 3)
    part = whole.part(0.5, 2)
    assert [part.take() for _ in range(3)] == [True, True, False]
    assert whole.take() and not whole.take()
    assert not whole.part(0.5).take()
    assert Budget(10.0).part(0.1).left() <= 1.0
