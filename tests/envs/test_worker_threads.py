import threading

import pytest

from lidarena.envs import worker_threads
from lidarena.envs.worker_threads import on_threads, set_num_threads


@pytest.mark.parametrize(("threads", "most", "expected"), [(1, 8, 1), (3, 8, 3), (4, 2, 2), (4, 1, 1)])
def test_work_is_called_once_by_each_thread_and_never_more_than_asked(
    monkeypatch: pytest.MonkeyPatch, threads: int, most: int, expected: int
) -> None:
    monkeypatch.setattr(worker_threads, "_threads", worker_threads._threads)  # put back afterwards
    set_num_threads(threads)
    numbers: list[int] = []
    names: set[int] = set()
    together = threading.Barrier(expected, timeout=60)

    def work(number: int) -> None:
        together.wait()  # all at once, or nobody gets on
        numbers.append(number)
        names.add(threading.get_ident())

    on_threads(most, work)
    assert sorted(numbers) == list(range(expected)) and len(names) == expected
    assert threading.get_ident() in names  # the caller works along


@pytest.mark.parametrize("failing", [0, 1])
def test_what_fails_in_a_thread_fails_in_the_caller(monkeypatch: pytest.MonkeyPatch, failing: int) -> None:
    monkeypatch.setattr(worker_threads, "_threads", 2)

    def work(number: int) -> None:
        if number == failing:
            raise ValueError(f"thread {number}")

    with pytest.raises(ValueError, match=f"thread {failing}"):
        on_threads(2, work)
