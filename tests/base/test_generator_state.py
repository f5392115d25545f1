import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from lidarena.base.generator_state import generator_from_words, generator_words


@given(st.integers(0, 2**64), st.integers(0, 7))
def test_a_generator_goes_on_where_its_words_were_taken(seed: int, draws: int) -> None:
    rng = np.random.default_rng(seed)
    rng.integers(0, 2**31, draws, dtype=np.uint32)  # an odd number leaves half a word to spare
    other = generator_from_words(generator_words(rng))
    assert other.integers(0, 2**31, 5, dtype=np.uint32).tolist() == rng.integers(0, 2**31, 5, dtype=np.uint32).tolist()
    assert other.normal(size=3).tolist() == rng.normal(size=3).tolist()


def test_words_survive_a_file_of_arrays() -> None:
    words = generator_words(np.random.default_rng(1))
    assert words.shape == (6,) and words.dtype == np.uint64
