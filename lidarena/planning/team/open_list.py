"""A binary heap of (key, item) pairs for searches in space and time, where an item may be in it more than once.

The heap of the two-dimensional searches (``base.heap``) needs an entry for every item that there could be;
here only the fraction of states that a search meets costs memory. Equal keys come out in an order that depends on
the pushes alone.
"""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf


@leaf
def push(keys: NDArray[np.int64], items: NDArray[np.int32], size: int, key: int, item: int) -> int:
    """Insert a pair into a heap of ``size`` and return the new size.

    Args:
        keys: (capacity,) keys, the smallest first.
        items: (capacity,) items.
        size: Number of pairs, below the capacity.
        key: Of the new pair.
        item: Of the new pair.
    """
    i = size
    while i > 0:
        above = (i - 1) >> 1
        if keys[above] <= key:
            break
        keys[i], items[i] = keys[above], items[above]
        i = above
    keys[i], items[i] = key, item
    return size + 1


@leaf
def pop(keys: NDArray[np.int64], items: NDArray[np.int32], size: int) -> int:
    """Take the first pair out of a heap of ``size`` > 0 and return the new size.

    Args:
        keys: (capacity,) keys, the smallest first.
        items: (capacity,) items.
        size: Number of pairs.
    """
    size -= 1
    key, item = keys[size], items[size]
    i = 0
    below = 1
    while below < size:
        if below + 1 < size and keys[below + 1] < keys[below]:
            below += 1
        if keys[below] >= key:
            break
        keys[i], items[i] = keys[below], items[below]
        i = below
        below = 2 * i + 1
    keys[i], items[i] = key, item
    return size
