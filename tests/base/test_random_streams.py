"""The worlds' random streams against xoshiro256++ in whole numbers, and their independence."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from lidarena.base.random_streams import next_word, normal, seed_stream, uniform

WORD = (1 << 64) - 1
STATE = st.lists(st.integers(0, WORD), min_size=4, max_size=4).filter(any)


def rotated(word: int, by: int) -> int:
    return (word << by | word >> (64 - by)) & WORD


def slow_words(state: list[int], count: int) -> list[int]:
    """xoshiro256++ as Blackman and Vigna print it."""
    s, words = list(state), []
    for _ in range(count):
        words.append((rotated((s[0] + s[3]) & WORD, 23) + s[0]) & WORD)
        shifted = (s[1] << 17) & WORD
        s[2] ^= s[0]
        s[3] ^= s[1]
        s[1] ^= s[2]
        s[0] ^= s[3]
        s[2] ^= shifted
        s[3] = rotated(s[3], 45)
    return words


@settings(max_examples=40, deadline=None)
@given(STATE)
def test_words_are_those_of_xoshiro(state: list[int]) -> None:
    stream = np.array(state, np.uint64)
    assert [int(next_word(stream)) for _ in range(20)] == slow_words(state, 20)


@settings(max_examples=40, deadline=None)
@given(STATE)
def test_uniform_numbers_are_the_upper_53_bits(state: list[int]) -> None:
    stream = np.array(state, np.uint64)
    found = [uniform(stream) for _ in range(20)]
    assert found == [(word >> 11) / 2**53 for word in slow_words(state, 20)]


def draws(seed: int, count: int) -> np.ndarray:
    stream = seed_stream(np.random.default_rng(seed))
    return np.array([normal(stream) for _ in range(count)])


@pytest.mark.parametrize("seed", range(3))
def test_normal_numbers_follow_their_distribution_into_the_tails(seed: int) -> None:
    numbers = draws(seed, 60_000)
    assert stats.kstest(numbers, "norm").pvalue > 1e-3
    for level in (1.0, 2.0, 3.0):
        expected = 60_000 * 2 * stats.norm.sf(level)
        assert abs((np.abs(numbers) > level).sum() - expected) < 5 * np.sqrt(expected)
    assert abs((numbers > 0).mean() - 0.5) < 0.01
    assert len(np.unique(numbers)) > 59_990


def test_beyond_the_base_strip_numbers_still_fall_as_a_gaussian() -> None:
    """The tail begins at 3.65, where one number in 3,900 lies."""
    edge, numbers = 3.6541528853610088, draws(7, 400_000)
    beyond = np.abs(numbers[np.abs(numbers) > edge])
    expected = 400_000 * 2 * stats.norm.sf(edge)
    assert abs(len(beyond) - expected) < 5 * np.sqrt(expected)
    assert stats.kstest(stats.norm.sf(beyond) / stats.norm.sf(edge), "uniform").pvalue > 1e-3


def test_streams_of_one_generator_are_independent() -> None:
    rng = np.random.default_rng(11)
    streams = [seed_stream(rng) for _ in range(4)]
    numbers = np.array([[normal(stream) for _ in range(20_000)] for stream in streams])
    correlation = np.corrcoef(numbers) - np.eye(4)
    assert np.abs(correlation).max() < 4 / np.sqrt(20_000)
    for row in numbers:
        assert abs(np.corrcoef(row[:-1], row[1:])[0, 1]) < 4 / np.sqrt(20_000)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(0, 2), max_size=60))
def test_what_a_world_draws_depends_on_its_own_history_alone(order: list[int]) -> None:
    """Worlds drawn from in any order get what each would have got alone."""
    together = [seed_stream(np.random.default_rng(seed)) for seed in range(3)]
    got: list[list[float]] = [[], [], []]
    for world in order:
        got[world].append(normal(together[world]))
    for world in range(3):
        alone = seed_stream(np.random.default_rng(world))
        assert got[world] == [normal(alone) for _ in got[world]]
