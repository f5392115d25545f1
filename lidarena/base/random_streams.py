"""Random numbers inside kernels: one xoshiro256++ stream a world, seeded from that world's own ``np_random``.

A compiled loop over worlds cannot call ``numpy.random.Generator``; each world therefore owns a row of four words of
state, drawn from its generator at reset. What a world draws depends on nothing but its own seed and history.
"""

import math

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

_LAYERS = 256
_TAIL = 3.6541528853610088
"""Where the ziggurat's base strip ends (Marsaglia & Tsang 2000, 256 layers)."""
_STRIP = 0.00492867323399
"""Area of each of its strips."""


def seed_stream(rng: np.random.Generator) -> NDArray[np.uint64]:
    """Draw the state (4,) of a new stream from a world's generator."""
    words: NDArray[np.uint64] = rng.bit_generator.random_raw(4)  # what integers() gives, without its checks of a range
    return words


def _ziggurat_layers() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Right ends of the strips (257,) and the density at them (257,)."""
    x = np.zeros(_LAYERS + 1)
    x[0], x[1] = _STRIP * math.exp(0.5 * _TAIL * _TAIL), _TAIL
    for i in range(2, _LAYERS):
        x[i] = math.sqrt(-2.0 * math.log(_STRIP / x[i - 1] + math.exp(-0.5 * x[i - 1] ** 2)))
    return x, np.exp(-0.5 * x**2)


_EDGE, _DENSITY = _ziggurat_layers()


@inlined
def next_word(state: NDArray[np.uint64]) -> np.uint64:
    """Next 64 random bits of xoshiro256++ (Blackman & Vigna); ``state`` (4,) moves on."""
    total = uint64(state[0] + state[3])
    word: np.uint64 = uint64(((total << uint64(23)) | (total >> uint64(41))) + state[0])
    shifted = uint64(state[1] << uint64(17))
    state[2] ^= state[0]
    state[3] ^= state[1]
    state[1] ^= state[2]
    state[0] ^= state[3]
    state[2] ^= shifted
    state[3] = (state[3] << uint64(45)) | (state[3] >> uint64(19))
    return word


@inlined
def uniform(state: NDArray[np.uint64]) -> float:
    """Uniform in [0, 1) with 53 random bits."""
    share: float = np.int64(next_word(state) >> uint64(11)) * (1.0 / 9007199254740992.0)
    return share


@inlined
def normal(state: NDArray[np.uint64]) -> float:
    """Standard normal by the ziggurat method (Marsaglia & Tsang 2000)."""
    word = next_word(state)
    layer = np.int64(word & uint64(255))
    x: float = (np.int64(word) >> np.int64(11)) * (1.0 / 4503599627370496.0) * _EDGE[layer]
    if abs(x) < _EDGE[layer + 1]:  # 99 in 100; kept apart so that it is inlined
        return x
    return _rim(state, x, layer)


@leaf
def _rim(state: NDArray[np.uint64], x: float, layer: np.int64) -> float:
    """A normal whose first draw ``x`` fell into the rim of its layer."""
    while True:
        if layer == 0:
            return _tail(state, x < 0.0)
        y = _DENSITY[layer] + uniform(state) * (_DENSITY[layer + 1] - _DENSITY[layer])
        if y < math.exp(-0.5 * x * x):
            return x
        layer = np.int64(next_word(state) & uint64(255))
        x = (2.0 * uniform(state) - 1.0) * _EDGE[layer]
        if abs(x) < _EDGE[layer + 1]:
            return x


@leaf
def _tail(state: NDArray[np.uint64], negative: bool) -> float:
    """A normal beyond the base strip (Marsaglia 1964)."""
    while True:
        x = -math.log(1.0 - uniform(state)) / _TAIL
        y = -math.log(1.0 - uniform(state))
        if y + y > x * x:
            return -(_TAIL + x) if negative else _TAIL + x
