"""A NumPy generator's state as plain words, so that it can be saved without pickle."""

import numpy as np
from numpy.typing import NDArray

_WORD = 1 << 64


def generator_words(rng: np.random.Generator) -> NDArray[np.uint64]:
    """State of a PCG64 generator as six words (6,): state and increment (high, low), and its spare half word."""
    state = rng.bit_generator.state
    value, increment = state["state"]["state"], state["state"]["inc"]
    words = [
        value // _WORD,
        value % _WORD,
        increment // _WORD,
        increment % _WORD,
        state["has_uint32"],
        state["uinteger"],
    ]
    return np.array(words, dtype=np.uint64)


def generator_from_words(words: NDArray[np.uint64]) -> np.random.Generator:
    """The generator whose state ``generator_words`` wrote down."""
    numbers = [int(word) for word in words]
    bits = np.random.PCG64()
    bits.state = {
        "bit_generator": "PCG64",
        "state": {"state": numbers[0] * _WORD + numbers[1], "inc": numbers[2] * _WORD + numbers[3]},
        "has_uint32": numbers[4],
        "uinteger": numbers[5],
    }
    return np.random.Generator(bits)
