import threading
from typing import NamedTuple

import numpy as np
import pytest

from lidarena.base.jit import entry_point, inlined, kernel, leaf, merged, take_next


@kernel
def allocate(n: int) -> np.ndarray:
    return np.arange(n) * 2.0


@inlined
def double(x: float) -> float:
    return 2.0 * x


@merged
def add(x: float, y: float) -> float:
    return x + y


@leaf
def sum_of_doubles(values: np.ndarray) -> float:
    total = 0.0
    for k in range(len(values)):
        total = add(total, double(values[k]))
    return total


@leaf
def divide(x: float, y: float) -> float:
    return x / y


@leaf
def take_all(counter: np.ndarray, last: int, taken: np.ndarray) -> None:
    k = take_next(counter)
    while k < last:
        taken[k] += 1
        k = take_next(counter)


def test_every_way_of_compiling_computes_what_python_computes() -> None:
    assert allocate(4).tolist() == [0.0, 2.0, 4.0, 6.0]
    assert sum_of_doubles(np.array([1.0, 2.5])) == 7.0


def test_dividing_by_zero_is_infinite_as_in_numpy() -> None:
    assert divide(1.0, 0.0) == np.inf


def test_kernels_are_cached_on_disk() -> None:
    for one in (allocate, sum_of_doubles):
        assert one.stats.cache_path  # type: ignore[attr-defined]


@pytest.mark.parametrize("threads", [1, 4])
def test_threads_that_share_a_counter_take_every_number_once(threads: int) -> None:
    counter, taken = np.zeros(1, np.int64), np.zeros(100_000, np.int64)
    workers = [threading.Thread(target=take_all, args=(counter, len(taken), taken)) for _ in range(threads)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert (taken == 1).all()


class Pair(NamedTuple):
    first: np.ndarray
    second: np.ndarray


@leaf
def dot(factor: float, pair: Pair) -> float:
    total = 0.0
    for k in range(len(pair.first)):
        total += factor * pair.first[k] * pair.second[k]
    return total


def test_an_entry_point_calls_the_kernel_with_other_arguments_of_the_same_types() -> None:
    call = entry_point(dot, 1.0, Pair(np.zeros(1), np.zeros(1)))
    for n in (0, 1, 7):
        pair = Pair(np.arange(n, dtype=float), np.linspace(1.0, 2.0, n))
        assert call(0.5, pair) == dot(0.5, pair)
